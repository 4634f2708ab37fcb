// The second pass of a split step: pair velocities relax, then come the opening half kick and the drift.
struct Sums { kick: Steps, impulse: Steps, strain: f32 }

fn pass_begin(me: Particle) -> Sums {
    prepare_pair_noise();
    return Sums(Steps(0), Steps(0), 0.0);
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    let c = coefficients_of(species_of(me), species_of(other));
    let root = root_weight(contact.w);
    let push = select(0.0, repulsion_impulse(c, contact.w), contact.inside);
    let pull = select(0.0, relaxation_impulse(c, contact, root, me, other), contact.inside);
    (*sums).kick += Steps(round(push * contact.direction));
    (*sums).impulse += Steps(round(pull * contact.direction));
    (*sums).strain += abs(push) + abs(pull);
}
const QUEUED_SUMS: u32 = 2u * DIMENSION + 1u;
fn queue_sums(lane: u32, sums: Sums) {
    queue_steps(lane, 0u, sums.kick);
    queue_steps(lane, DIMENSION, sums.impulse);
    queue_strain(lane, 2u * DIMENSION, sums.strain);
}
fn queued_sums(lane: u32) -> Sums {
    return Sums(queued_steps(lane, 0u), queued_steps(lane, DIMENSION), queued_strain(lane, 2u * DIMENSION));
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    let relaxed = steps_of(me.momentum) + clock_closing() * sums.impulse;
    let kick = sums.kick + take_gathered_kick(index) + external_kick(me);
    store_advanced(row, index, me, relaxed + kick, kick, sums.strain);
}
fn pass_finish(group: u32, lane: u32) {
    raise(failures_of_particles);
    end_step(lane);
}
