// The bound on the push alone limits how far a face turns.
fn limited_twist(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector {
    let part = bounded_part(facet, twist, mine, theirs);
    cuts += select(0u, 1u, part < 1.0);
    return part * twist;
}
