// Many-body dissipative particle dynamics: the local density around particles and the repulsion that grows with it, Warren,
// doi:10.1103/PhysRevE.68.066702. A pass over pairs leaves the sums n = sum of (1 - r/rd)^2 in integers, so that they depend on no
// order; the passes after it take them from there.
const DENSITY_UNITS: f32 = 1048576.0;   // of a particle in the same place
const DENSITY_LIMIT: u32 = 1073741824u; // 1024 of those; two such sums fit a word

override DENSITY_STRETCH: f32; // the cutoff over rd

// 1 - r/rd from 1 - r/rc, zero beyond.
fn density_closeness(w: f32) -> f32 {
    let own = 1.0 - (1.0 - w) * DENSITY_STRETCH;
    return select(own, 0.0, own <= 0.0);
}
fn density_units(w: f32) -> u32 {
    let own = density_closeness(w);
    return u32(round(own * own * DENSITY_UNITS));
}
// What a particle has with one more pair. A sum at the limit stays there, in whatever order it was made.
fn density_with(sum: u32, contact: Contact) -> u32 {
    return min(sum + select(0u, density_units(contact.w), contact.inside), DENSITY_LIMIT);
}
fn store_density(id: u32, sum: u32) {
    densities[id] = sum;
    failures_of_particles |= select(0u, FAILURE_IMPULSE, sum >= DENSITY_LIMIT);
}
