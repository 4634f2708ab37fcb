// Between cells close to each other a face turns fast: it must not sweep over more than a part of the cell that it takes
// from, or a step could take more internal energy than there is.
fn limited_twist(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector {
    let swept = STEP * facet.length * dot(twist, mine.velocity - theirs.velocity);
    let within = limited(swept, mine.mass / mine.density, theirs.mass / theirs.density);
    return twist * select(1.0, within / swept, within != swept);
}
