// Faces turn as they do.
fn limited_twist(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector { return twist; }
