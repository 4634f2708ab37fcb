// Voronoi cells receive what came through their faces: slot exchange/change, see voronoi/cell.
const UNITS_LIMIT: i32 = 1073741824; // 2^30

// Slot voronoi/motion: the position after the exchange, from the velocity before it or after it.
// Default: off, cells stay where they are in this part of the step. The plan chooses `before` (explicit) or `after` (split
// steps).
fn moved_place(cell: Particle, before: Vector) -> vec4<u32> { return cell.position; }

// Slot exchange/energy_check: raises a failure if the internal energy is negative.
// Default: off, cells at the temperature of the scene have no energy of their own. The plan chooses `kept` if they do.
fn check_energy(cell: Particle) {}

// Every cell receives what came through its faces. One invocation a cell; reads and clears `exchanges` or `pushes`, updates the
// particle.
@compute @workgroup_size(WORKGROUP)
fn apply_exchange(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    var me = stored_particle(slot);
    let before = velocity_of(me);
    let change = take_change(slot);
    me.momentum += vec4<i32>(change.xyw, 0);
    let mass = bitcast<i32>(me.position.z) + change.z;
    me.position.z = bitcast<u32>(mass);
    raise_at(select(FAILURE_MASS, 0u, mass > 0 && mass <= UNITS_LIMIT), me.position.w);
    raise(select(0u, FAILURE_MOMENTUM, any_beyond(steps_of(me.momentum), UNITS_LIMIT)));
    check_energy(me);
    me.position = moved_place(me, before);
    store_particle(slot, me);
}
