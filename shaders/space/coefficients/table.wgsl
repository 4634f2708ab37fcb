// Several species: a table of pairs of species (row: this particle's), in integer momentum units. Each entry also holds the
// inverse mass of the column's species.
struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients {
    let entry = coefficient_entry(u32(a) * SPECIES + u32(b));
    return Coefficients(entry.x, entry.y, entry.z);
}
