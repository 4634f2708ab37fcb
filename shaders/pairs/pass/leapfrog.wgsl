// A leapfrog step in one pass: closing and opening half kicks by the same pair impulses, then the drift
// (Groot and Warren, doi:10.1063/1.474784; Cotter and Reich, doi:10.1209/epl/i2003-00621-8).
struct Sums { kick: Steps, strain: f32 }

fn pass_begin(me: Particle) -> Sums {
    prepare_pair_noise();
    return Sums(Steps(0), 0.0);
}
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let other = particle_at(other_index);
    let contact = contact_of(separation(me.position, other.position));
    let c = coefficients_of(species_of(me), species_of(other));
    let root = root_weight(contact.w);
    let impulse = impulse_without_memory(repulsion_impulse(c, contact.w), c, contact, root, me, other);
    let magnitude = select(0.0, impulse, contact.inside);
    (*sums).kick += Steps(round(magnitude * contact.direction));
    (*sums).strain += abs(magnitude);
}
const QUEUED_SUMS: u32 = DIMENSION + 1u;
fn queue_sums(lane: u32, sums: Sums) {
    queue_steps(lane, 0u, sums.kick);
    queue_strain(lane, DIMENSION, sums.strain);
}
fn queued_sums(lane: u32) -> Sums { return Sums(queued_steps(lane, 0u), queued_strain(lane, DIMENSION)); }
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    let own = advance_own(me);
    let kick = sums.kick + take_gathered_kick(index) + external_kick(me) + own.both;
    let opening = kick + own.opening;
    let full_step = steps_of(me.momentum) + clock_closing() * (kick + own.closing);
    store_advanced(row, index, me, full_step + opening, opening, sums.strain);
}
fn pass_finish(group: u32, lane: u32) {
    raise(failures_of_particles);
    end_step(lane);
}
