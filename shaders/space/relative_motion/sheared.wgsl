// The copy of the second in the order of ids has, across a boundary that shears, a momentum of its own.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    let up = boxes_up(fraction_of(me.position), fraction_of(other.position));
    if (ONE_MASS == 1u) {
        var exact = mine - theirs;
        exact.x -= up * jump_of(species_of(me));
        return Vector(exact);
    }
    let in_order = mine_first(me, other);
    let species = vec2<i32>(species_of(me), species_of(other));
    let ordered = select(species.yx, species, in_order);
    var copy = select(mine, theirs, in_order);
    copy.x += select(-up, up, in_order) * jump_of(ordered.y);
    let difference = Vector(select(theirs, mine, in_order)) * inverse_mass_of(ordered.x)
        - Vector(copy) * inverse_mass_of(ordered.y);
    return select(-difference, difference, in_order);
}
