// No heat is conducted in this part of the step.
fn conducted_heat(facet: Facet, mine: Side, theirs: Side) -> f32 { return 0.0; }
