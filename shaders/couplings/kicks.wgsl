// Impulses that couplings add to particles: those of all forces, and for a report those of the conservative ones.
//
// Slot couplings/kicks: `add_kick` adds the impulse of half a step to the particle in a slot, in integer momentum units, in any
// order. Variants plane, volume; the plan follows the box.
// Default: off, for the report of couplings whose impulses have been added already.
fn add_kick(slot: u32, kick: Steps) {}

// Slot couplings/gathered: the impulses of half a step that couplings have added to a sorted particle, for the passes over
// pairs; `take_gathered_kick` also clears them for the next step.
// Default: off, no coupling but pairs. The plan of pairs chooses `kept` if the scene has bonds, angles or tethers,
// or if a split step visits its pairs once.
fn gathered_kick(slot: u32) -> Steps { return Steps(0); }
fn take_gathered_kick(slot: u32) -> Steps { return Steps(0); }

// Slot external/profile: the impulse of half a step that body forces give a particle, in integer momentum units. Variants uniform,
// opposed, sinusoidal, with external/body_force; the plan follows the scene.
// Default: off, no body force.
fn external_kick(me: Particle) -> Steps { return Steps(0); }

// Two particles of a pair or a bond, and their slots.
struct Ends { slot: u32, other_slot: u32, me: Particle, other: Particle }

// Slot couplings/places: the particle in a slot, for couplings that name particles.
// Default: as it is stored. The plan of pairs, which sorts particles in every step, chooses `sorted`.
fn particle_in(slot: u32) -> Particle { return stored_particle(slot); }

// Sums the squares of the conservative forces, once all couplings have added theirs. One invocation a stored particle; reads and
// clears `forces`.
@compute @workgroup_size(WORKGROUP)
fn square_forces(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) {
        let force = Vector(steps_of(forces[slot]));
        forces[slot] = vec4<i32>(0);
        total_add(SUM_SQUARED_FORCE, sum64_of_f32(dot(force, force) * GRADIENT));
    }
    total_reduce(group, lane);
}

// Slot couplings/forces: adds the conservative impulse of half a step for a report. Variants plane, volume; the plan follows
// the box.
// Default: off, no force of this scene is conservative.
fn add_force(slot: u32, force: Steps) {}
