// The repulsion of many-body dissipative particle dynamics, from the densities that pairs/density has found.
override MANY_BODY: u32;       // 1 where there is one
override DENSITY_IMPULSE: f32; // impulse of half a step at contact per unit of the densities of both particles

// The densities of both particles of that pair together: integers, so that both ends have the same.
fn density_of_pair() -> f32 { return f32(densities[pair_ids.x] + densities[pair_ids.y]); }

// The law: V = sum over particles of k n^2 with k = B C rd/4, of which a pair has k (n_i + n_j) v^2 with v = 1 - r/rd;
// its force is B C (n_i + n_j) v. B C is in DENSITY_IMPULSE.
fn with_many_body_impulse(impulse: f32, w: f32) -> f32 {
    if (MANY_BODY == 0u) { return impulse; }
    return impulse + DENSITY_IMPULSE * density_of_pair() * density_closeness(w);
}

// Adds it to another repulsion. The Laplacian of V by the position of i is the sum over its pairs of B C ((n_i +
// n_j)(1/rd - (d - 1) v/r) + 2 v^2/rd), and 2 B C/rd times the square of the sum of v e, which is no sum over pairs:
// see pairs/pass/observe_densities.
fn with_many_body(other: Repulsion, contact: Contact) -> Repulsion {
    if (MANY_BODY == 0u) { return other; }
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
