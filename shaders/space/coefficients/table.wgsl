// Several species: a table of pairs of species (row: this particle's), in integer momentum units. Each entry also holds the
// inverse mass of the column's species.
override SPECIES: u32;

struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients {
    let entry = coefficient_entry(u32(a) * SPECIES + u32(b));
    return Coefficients(entry.x, entry.y, entry.z);
}

// The species of a sorted particle, without the rest of it.
fn other_species(index: u32) -> i32 { return species_in(momentum_at(index)); }

// The position baths of the species follow the pairs in the table.
fn position_entry(species: i32) -> vec4<f32> { return coefficient_entry(SPECIES * SPECIES + u32(species)); }
fn position_response(species: i32) -> f32 { return position_entry(species).x; }
fn position_deviation(species: i32) -> f32 { return position_entry(species).y; }
fn position_energy(species: i32) -> f32 { return position_entry(species).z; }

// The body forces on the species come last, an entry an axis: halves of the whole units of an impulse of half a step, then of the 2^-32
// of a unit.
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
