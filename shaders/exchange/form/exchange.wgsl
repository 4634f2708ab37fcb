// Cells exchange mass as their faces turn: Flekkøy, Coveney and De Fabritiis (33), doi:10.1103/PhysRevE.62.2140.
var<private> uncut: f32; // part of the mass that the geometry asks for

fn turning(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 {
    return STEP * turning_rate() * facet.length * dot(twist, mine.velocity - theirs.velocity);
}
fn transferred_mass(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 {
    let wanted = turning(facet, twist, mine, theirs) * density_between(mine.density, theirs.density);
    let limited_mass = limited_amount(wanted, mine.mass, theirs.mass);
    uncut = select(1.0, limited_mass / wanted, limited_mass != wanted);
    let part = part_within_energy(internal_energy_swept(facet, twist, mine, theirs), mine, theirs);
    cuts += select(0u, 1u, part < 1.0 && uncut == 1.0);
    uncut *= part;
    return part * limited_mass;
}
fn internal_energy_swept(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 {
    return uncut * turning(facet, twist, mine, theirs) * 0.5 * (mine.energy_density + theirs.energy_density);
}
fn pressing(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector {
    return STEP * facet.length * 0.5 * (mine.pressure + theirs.pressure) * facet.direction;
}
// Energy into this cell in addition to what the impulse brings at the mean velocity of both.
fn carried_energy(facet: Facet, twist: Vector, mass: f32, mine: Side, theirs: Side) -> f32 {
    let difference = mine.velocity - theirs.velocity;
    let kinetic = dot(mine.velocity, 2.0 * mine.mean - mine.velocity)
        + dot(theirs.velocity, 2.0 * theirs.mean - theirs.velocity);
    return internal_energy_swept(facet, twist, mine, theirs) + mass * (0.125 * dot(difference, difference) - 0.25 * kinetic);
}

// The form as printed has faces turn at half the rate, and mass the arithmetic mean of the densities.
override AS_PRINTED: u32;

// The rate at which faces turn, over the rate that follows from the geometry.
fn turning_rate() -> f32 { return select(1.0, 0.5, AS_PRINTED == 1u); }

// The logarithmic mean of the densities.
fn density_between(mine: f32, theirs: f32) -> f32 {
    let mean = 0.5 * (mine + theirs);
    if (AS_PRINTED == 1u) { return mean; }
    // (a - b) / ln(a/b) = (a + b)/2 x / artanh(x), by its series where the quotient loses digits.
    let x = 0.5 * (mine - theirs) / mean;
    let square = x * x;
    let series = 1.0 + square * (0.33333334 + square * (0.2 + square * (0.14285715 + square * (0.11111111
        + square * 0.09090909))));
    let direct = 0.5 * log(mine / theirs) / select(x, 1.0, x == 0.0);
    return mean / select(direct, series, square < 0.09);
}
