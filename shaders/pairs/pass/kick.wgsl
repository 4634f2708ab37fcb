// The only visit of pairs in a split step whose pairs have no friction: the closing half kick. With that of other
// couplings it stays in `kicks` for the opening one, which the last pass finds there without a visit.
struct Sums { kick: Steps, strain: f32 }

fn pass_begin(me: Particle) -> Sums { return Sums(Steps(0), 0.0); }
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let contact = contact_of(separation(me.position, position_at(other_index)));
    // Of the other particle's words only the species is read here, and that never changes, though the word is written.
    let c = coefficients_of(species_of(me), other_species(other_index));
    let push = select(0.0, repulsion_impulse(c, contact.w), contact.inside);
    (*sums).kick += Steps(round(push * contact.direction));
    (*sums).strain += abs(push);
}
const QUEUED_SUMS: u32 = DIMENSION + 1u;
fn queue_sums(lane: u32, sums: Sums) {
    queue_steps(lane, 0u, sums.kick);
    queue_strain(lane, DIMENSION, sums.strain);
}
fn queued_sums(lane: u32) -> Sums { return Sums(queued_steps(lane, 0u), queued_strain(lane, DIMENSION)); }
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    failures_of_particles |= select(FAILURE_IMPULSE, 0u, is_within(sums.strain, STRAIN_LIMIT));
    let kick = sums.kick + gathered_kick(index);
    kicks[index] = momentum_word(kick, 0);
    let own = advance_own(me);
    leave_opening(index, me, own);
    let momentum = steps_of(me.momentum) + clock_closing() * (kick + external_kick(me) + own.both + own.closing);
    replace_momentum(index, me, held_momentum(me, momentum));
}
fn pass_finish(group: u32, lane: u32) { raise(failures_of_particles); }
