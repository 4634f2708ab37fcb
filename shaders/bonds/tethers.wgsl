// Tethers: a spring from every particle to where it started, V = K d^2 / 2.
override TETHER: f32;           // K: impulse of half a step per length
override TETHER_ENERGY: f32;    // K/2: energy per square of a length, over its quantum
override TETHER_LAPLACIAN: f32; // K in every dimension, over its quantum

fn impulse_of_tether(length: Vector) -> Vector { return -TETHER * length; }
fn energy_of_tether(length: Vector) -> f32 { return dot(length, length) * TETHER_ENERGY; }

// Slot bonds/tether_report: `note_tether` gets each particle with its displacement, `finish_tethers` ends the workgroup.
// Default: off, a step without a report. The plan chooses `observed` for reports.
fn note_tether(slot: u32, me: Particle, length: Vector) {}
fn finish_tethers(group: u32, lane: u32) {}

// Adds the impulse of every tether. One invocation a stored particle; reads its position and `tethers`, adds the impulse of
// half a step to its `kicks`.
@compute @workgroup_size(WORKGROUP)
fn pull_tethers(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) {
        let me = stored_particle(slot);
        let length = separation(me.position, tethers[me.position.w]);
        let impulse = impulse_of_tether(length);
        add_kick(slot, Steps(round(impulse)));
        raise(select(FAILURE_IMPULSE, 0u, all_within(impulse, IMPULSE_LIMIT)));
        note_tether(slot, me, length);
    }
    finish_tethers(group, lane);
}
