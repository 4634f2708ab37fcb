// Before the passes of a step: the local density around each particle, by id.
struct Sums { density: u32 }

fn pass_begin(me: Particle) -> Sums { return Sums(0u); }
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let contact = contact_of(separation(me.position, position_at(other_index)));
    (*sums).density = density_with((*sums).density, contact);
}
const QUEUED_SUMS: u32 = 2u;
fn queue_sums(lane: u32, sums: Sums) {
    queue_word(lane, 0u, sums.density & 0xffffu);
    queue_word(lane, 1u, sums.density >> 16u);
}
// A sum at the limit stays there.
fn queued_sums(lane: u32) -> Sums {
    let low = queued_word(lane, 0u);
    let high = queued_word(lane, 1u) + (low >> 16u);
    return Sums(select((high << 16u) | (low & 0xffffu), DENSITY_LIMIT, high >= DENSITY_LIMIT >> 16u));
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) { store_density(me.position.w, sums.density); }
fn pass_finish(group: u32, lane: u32) { raise(failures_of_particles); }
