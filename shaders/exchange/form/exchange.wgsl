// Cells exchange mass as their faces turn: Flekkøy, Coveney and De Fabritiis (33), doi:10.1103/PhysRevE.62.2140.
var<private> uncut: f32; // part of the mass that the geometry asks for

fn turning(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 {
    return STEP * TURNING * facet.length * dot(twist, mine.velocity - theirs.velocity);
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
