// No pressure acts in this part of the step.
fn twist_of(face: u32, facet: Facet) -> Vector { return Vector(0.0); }
fn transferred_mass(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> f32 { return 0.0; }
fn pressing(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector { return Vector(0.0); }
fn carried_energy(facet: Facet, twist: Vector, mass: f32, mine: Side, theirs: Side) -> f32 { return 0.0; }
