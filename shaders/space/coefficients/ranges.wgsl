// Several species whose pairs differ in their cutoff or in the exponent of their weight: the table of pairs of species, the position
// baths of the species, and then what each pair has of its own.
override SPECIES: u32;

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

// The species of a sorted particle, without the rest of it.
fn other_species(index: u32) -> i32 { return species_in(momentum_at(index)); }

fn position_entry(species: i32) -> vec4<f32> { return coefficient_entry(SPECIES * SPECIES + u32(species)); }
fn position_response(species: i32) -> f32 { return position_entry(species).x; }
fn position_deviation(species: i32) -> f32 { return position_entry(species).y; }
fn position_energy(species: i32) -> f32 { return position_entry(species).z; }

// The body forces on the species come last, as in `table`.
override BODY_ENTRIES: u32; // entries before them

fn external_impulse_of(species: i32) -> Impulse {
    let first = BODY_ENTRIES + 3u * u32(species);
    let x = vec4<i32>(coefficient_entry(first));
    let y = vec4<i32>(coefficient_entry(first + 1u));
    let z = vec4<i32>(coefficient_entry(first + 2u));
    let high = vec4<i32>(x.x, y.x, z.x, 0);
    let low = vec4<i32>(x.y, y.y, z.y, 0);
    let rest = vec4<u32>(vec4<i32>(x.z, y.z, z.z, 0)) * 65536u + vec4<u32>(vec4<i32>(x.w, y.w, z.w, 0));
    return Impulse(steps_of(high * 65536 + low), fraction_of(rest));
}
