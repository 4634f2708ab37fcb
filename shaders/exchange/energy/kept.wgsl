// Cells keep their energy: through a face comes what the impulse brings at the mean velocity of both, so that its work is
// shared by their internal energies, what mass carries, and heat.
fn energy_through(facet: Facet, twist: Vector, impulse: Vector, mass: f32, mine: Side, theirs: Side) -> f32 {
    return 0.5 * dot(impulse, mine.mean + theirs.mean) + carried_energy(facet, twist, mass, mine, theirs)
        + conducted_heat(facet, mine, theirs);
}
