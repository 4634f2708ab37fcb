// Several species whose pairs differ in their cutoff or in the exponent of their weight: the table of pairs of species, the position
// baths of the species, and then what each pair has of its own.
struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

// Of the pair whose coefficients were looked up last: the largest cutoff over its cutoff, and half the exponent of its weight.
// Symmetric, so that both ends of a pair have the same.
var<private> pair_range: vec4<f32>;

fn coefficients_of(a: i32, b: i32) -> Coefficients {
    let pair = u32(a) * SPECIES + u32(b);
    let entry = coefficient_entry(pair);
    pair_range = coefficient_entry(SPECIES * (SPECIES + 1u) + pair);
    return Coefficients(entry.x, entry.y, entry.z);
}
// 1 - r/rc for the cutoff of that pair, from the same for the largest cutoff; zero beyond.
fn own_closeness(w: f32) -> f32 {
    let own = 1.0 - (1.0 - w) * pair_range.x;
    return select(own, 0.0, own <= 0.0);
}
