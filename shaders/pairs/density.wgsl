// Many-body dissipative particle dynamics: the local density around particles and the repulsion that grows with it, Warren,
// doi:10.1103/PhysRevE.68.066702. A pass over pairs leaves the sums n = sum of (1 - r/rd)^2 in integers, so that they depend on no
// order; the passes after it take them from there.
const DENSITY_UNITS: f32 = 1048576.0;   // of a particle in the same place
const DENSITY_LIMIT: u32 = 1073741824u; // 1024 of those; two such sums fit a word

override DENSITY_STRETCH: f32; // the cutoff over rd
override DENSITY_IMPULSE: f32;       // impulse of half a step at contact per unit of the densities of both particles

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

// The ids of the pair whose separation was taken last: see pairs/separation/noted.
var<private> pair_ids: vec2<u32>;

// The densities of both particles of that pair together: integers, so that both ends have the same.
fn density_of_pair() -> f32 { return f32(densities[pair_ids.x] + densities[pair_ids.y]); }

// The law: V = sum over particles of k n^2 with k = B C rd/4, of which a pair has k (n_i + n_j) v^2 with v = 1 - r/rd; its
// force is B C (n_i + n_j) v. B C is in DENSITY_IMPULSE.
fn many_body_impulse(w: f32) -> f32 { return DENSITY_IMPULSE * density_of_pair() * density_closeness(w); }

// Adds it to another repulsion. The Laplacian of V by the position of i is the sum over its pairs of
// B C ((n_i + n_j)(1/rd - (d - 1) v/r) + 2 v^2/rd), and 2 B C/rd times the square of the sum of v e, which is no sum over
// pairs: see pairs/pass/observe_densities.
fn with_many_body(other: Repulsion, contact: Contact) -> Repulsion {
    let v = density_closeness(contact.w);
    let density = density_of_pair();
    let impulse = DENSITY_IMPULSE * density * v;
    let slope = v / max(contact.distance, 1e-6 * CUTOFF);
    let inverse_range = DENSITY_STRETCH / CUTOFF;
    let laplacian = DENSITY_IMPULSE * (density * (inverse_range - f32(DIMENSION - 1u) * slope)
        + 2.0 * DENSITY_UNITS * inverse_range * v * v);
    let acts = contact.distance > 0.0 && v > 0.0;
    return Repulsion(other.impulse + impulse, other.energy + impulse * v * (0.5 / DENSITY_STRETCH),
        other.laplacian + select(0.0, laplacian, acts));
}
