// In addition to the bound on the push, a face must not sweep over more than a part of the cell that it takes from. Between cells
// close to each other it turns fast, and a step could take more internal energy than there is.
fn limited_twist(facet: Facet, twist: Vector, mine: Side, theirs: Side) -> Vector {
    let bounded = bounded_part(facet, twist, mine, theirs);
    let swept = bounded * STEP * facet.length * dot(twist, mine.velocity - theirs.velocity);
    let donor = select(mine.mass / mine.density, theirs.mass / theirs.density, swept > 0.0);
    let most = EXCHANGE_LIMIT * donor;
    let part = select(bounded, bounded * most / abs(swept), abs(swept) > most);
    cuts += select(0u, 1u, part < 1.0);
    return part * twist;
}
