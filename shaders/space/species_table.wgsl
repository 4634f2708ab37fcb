// What species have of their own, where there are several: the position baths after the pairs in the table of species, the body forces
// at its end.
override SPECIES: u32;

// Slot space/coefficients: the coefficients of a pair, `coefficients_of`, and what species have of their own. The plan
// of particles chooses `single` or `table`. Default: species have it from the table.

// The species of a sorted particle, without the rest of it.
fn other_species(index: u32) -> i32 { return species_in(momentum_at(index)); }

fn position_entry(species: i32) -> vec4<f32> { return coefficient_entry(SPECIES * SPECIES + u32(species)); }
fn position_response(species: i32) -> f32 { return position_entry(species).x; }
fn position_deviation(species: i32) -> f32 { return position_entry(species).y; }
fn position_energy(species: i32) -> f32 { return position_entry(species).z; }

// Of body forces an entry an axis: halves of the whole units of an impulse of half a step, then of the 2^-32 of a unit.
override BODY_ENTRIES: u32 = 0u; // entries before them

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
