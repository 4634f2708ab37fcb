// The first stage of a relaxation in two. Other particles still read the momenta before it, so those after it go to a place of
// their own, where the second stage finds them.
struct Sums { impulse: Steps, strain: f32 }

fn pass_begin(me: Particle) -> Sums {
    prepare_pair_noise();
    return Sums(Steps(0), 0.0);
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    let c = coefficients_of(species_of(me), species_of(other));
    let root = root_weight(contact.w);
    let pull = select(0.0, relaxation_impulse(c, contact, root, me, other), contact.inside);
    (*sums).impulse += Steps(round(pull * contact.direction));
    (*sums).strain += abs(pull);
}
const QUEUED_SUMS: u32 = DIMENSION + 1u;
fn queue_sums(lane: u32, sums: Sums) {
    queue_steps(lane, 0u, sums.impulse);
    queue_strain(lane, DIMENSION, sums.strain);
}
fn queued_sums(lane: u32) -> Sums { return Sums(queued_steps(lane, 0u), queued_strain(lane, DIMENSION)); }
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    failures_of_particles |= select(FAILURE_IMPULSE, 0u, is_within(sums.strain, STRAIN_LIMIT));
    let momentum = held_momentum(me, steps_of(me.momentum) + clock_closing() * sums.impulse);
    let after = Particle(me.position, momentum_word(momentum, me.momentum.w));
    stage(index, after);
    let copy = copy_in_frame(row, index, me);
    if (copy != index) { stage(copy, after); }
}
fn pass_finish(group: u32, lane: u32) { raise(failures_of_particles); }
