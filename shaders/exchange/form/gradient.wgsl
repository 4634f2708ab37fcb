// Cells of constant mass: impulses by pressures follow from the gradient of the cells' free energies.
fn transferred_mass(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 { return 0.0; }
fn pressing(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector {
    return STEP * facet.length * (0.5 * (mine.pressure + theirs.pressure) * facet.direction
        + (mine.pressure - theirs.pressure) * twist);
}
// Energy into this cell in addition to what the impulse brings at the mean velocity of both: each loses -p dV.
fn carried_energy(facet: Facet, twist: Vector, mass: f32, mine: Side, theirs: Side) -> f32 {
    let velocity = mine.mean - theirs.mean;
    return 0.5 * STEP * facet.length * (0.5 * (theirs.pressure - mine.pressure) * dot(facet.direction, velocity)
        - (mine.pressure + theirs.pressure) * dot(twist, velocity));
}
