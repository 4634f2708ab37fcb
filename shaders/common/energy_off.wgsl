// Nobody keeps account of energies.
fn energy_through(facet: Facet, twist: Vector, impulse: Vector, mass: f32, mine: Side, theirs: Side) -> f32 { return 0.0; }
