// The local density around each particle at a report, and with it the part of the curvature that is no sum over pairs: 2 B C/rd times
// the square of the sum of v e over the pairs of a particle, v = 1 - r/rd.
struct Sums { density: u32, slope: Steps }

override DENSITY_CURVATURE: f32; // 2 B C/rd, in units of the curvature, over the square of DENSITY_UNITS

fn pass_begin(me: Particle) -> Sums { return Sums(0u, Steps(0)); }
fn pass_pair(sums: ptr<function, Sums>, me: Particle, other_index: u32) {
    let contact = contact_of(separation(me.position, position_at(other_index)));
    let slope = Steps(round(density_closeness(contact.w) * DENSITY_UNITS * contact.direction));
    (*sums).density = density_with((*sums).density, contact);
    (*sums).slope += select(Steps(0), slope, contact.inside);
}
fn pass_end(row: u32, index: u32, me: Particle, sums: Sums) {
    store_density(me.position.w, sums.density);
    if (!is_own(me.position)) { return; }
    let slope = Vector(sums.slope);
    total_add(SUM_CURVATURE, sum64_of_f32(mobile_part(me) * dot(slope, slope) * DENSITY_CURVATURE));
}
fn pass_finish(group: u32, lane: u32) {
    raise(failures_of_particles);
    reduce_totals(group, lane, SUM_CURVATURE, SUM_CURVATURE);
}
