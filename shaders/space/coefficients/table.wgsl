// Several species: a table of pairs of species (row: this particle's), in integer momentum units. Each entry also holds
// the inverse mass of the column's species. After the position baths of the species come the ranges of pairs, where
// they differ.
struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

// The row in tables of pairs of species of the pair that was looked up last.
var<private> pair_row: u32;

fn coefficients_of(a: i32, b: i32) -> Coefficients {
    let pair = u32(a) * SPECIES + u32(b);
    let entry = coefficient_entry(pair);
    if (RANGED == 1u) {
        pair_row = pair;
        pair_range = coefficient_entry(SPECIES * (SPECIES + 1u) + pair);
    }
    return Coefficients(entry.x, entry.y, entry.z);
}
// Further repulsions of that pair: the impulse at contact, and the largest cutoff over its own. A pair whose first
// repulsion is none, or excluded, has none of them.
fn further_row(c: Coefficients, number: u32) -> vec4<f32> {
    let row = coefficient_entry(SPECIES * (SPECIES + 1u) + number * SPECIES * SPECIES + pair_row);
    return vec4<f32>(select(row.x, 0.0, c.repulsion == 0.0), row.yzw);
}
