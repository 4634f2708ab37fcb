// The first pass of a split step: the closing half kick of the conservative force, and the rate at which friction
// acts on each particle. Both are stored with the sorted particle, where the second pass finds them.
struct Sums { kick: Steps, rate: u32 }

fn pass_begin(me: Particle) -> Sums { return Sums(Steps(0), 0u); }
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let contact = contact_of(separation(me.position, position_at(other_index)));
    // Of the other particle's words only the species is read here, and that never changes, though the word is written.
    let c = coefficients_of(species_of(me), other_species(other_index));
    let root = root_weight(contact.w);
    let kick = Steps(round(repulsion_impulse(c, contact.w) * contact.direction));
    (*sums).kick += select(Steps(0), kick, contact.inside);
    (*sums).rate += select(0u, rate_units(friction_rate(c, root) * rate_scale_of(species_of(me))), contact.inside);
}
const QUEUED_SUMS: u32 = DIMENSION + 1u;
fn queue_sums(lane: u32, sums: Sums) {
    queue_steps(lane, 0u, sums.kick);
    queue_word(lane, DIMENSION, sums.rate);
}
fn queued_sums(lane: u32) -> Sums { return Sums(queued_steps(lane, 0u), queued_word(lane, DIMENSION)); }
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    let own = advance_own(me);
    let kick = sums.kick + gathered_kick(index) + external_kick(me) + own.both + own.closing;
    leave_opening(index, me, own);
    let momentum = held_momentum(me, steps_of(me.momentum) + clock_closing() * kick);
    let word = momentum_word(momentum, species_of(me) | (min(i32(sums.rate), RATE_LIMIT) << 8u));
    keep_momentum_of_all(row, index, me, word);
}
fn pass_finish(group: u32, lane: u32) { finish_own(); }
