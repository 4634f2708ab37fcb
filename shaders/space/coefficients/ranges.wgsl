// Pairs of species that differ in their cutoffs or in the exponent of their weight, or have several repulsions: the
// table of pairs of species, the position baths of the species, and then what each pair has of its own.
struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

// The ranges of the pair whose coefficients were looked up last: the largest cutoff over that of its friction, half the
// exponent of its weight, and the largest cutoff over that of its repulsion. Symmetric, so that both ends of a pair
// have the same.
var<private> pair_range: vec4<f32>;
// Its row in tables of pairs of species.
var<private> pair_row: u32;

fn coefficients_of(a: i32, b: i32) -> Coefficients {
    let pair = u32(a) * SPECIES + u32(b);
    let entry = coefficient_entry(pair);
    pair_range = coefficient_entry(SPECIES * (SPECIES + 1u) + pair);
    pair_row = pair;
    return Coefficients(entry.x, entry.y, entry.z);
}
// 1 - r/rc for a cutoff, from that for the largest cutoff, which is `stretch` times as long; zero beyond.
fn closeness_within(w: f32, stretch: f32) -> f32 {
    let own = 1.0 - (1.0 - w) * stretch;
    return select(own, 0.0, own <= 0.0);
}
// That of the friction of the pair.
fn own_closeness(w: f32) -> f32 { return closeness_within(w, pair_range.x); }
