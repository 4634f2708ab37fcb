// No friction acts in this part of the step.
fn rubbing_impulse(facet: Facet, mine: Side, theirs: Side) -> Vector { return Vector(0.0); }
