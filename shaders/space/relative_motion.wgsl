// The relative motion of a pair that friction sees: the difference of two velocities, and of two momenta where all
// particles have the same mass, which is exact in integers. Odd under exchange to the last bit.

// Slot space/relative_motion: the plan chooses `sheared` if the scene has shear. Default: masses may differ by twelve
// orders of magnitude, so that products of sums and differences of both would lose the digits of the lighter.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    if (ONE_MASS == 1u) { return Vector(mine - theirs); }
    let in_order = mine_first(me, other);
    let first = Vector(select(theirs, mine, in_order));
    let second = Vector(select(mine, theirs, in_order));
    let mine_inverse = inverse_mass_of(species_of(me));
    let theirs_inverse = inverse_mass_of(species_of(other));
    let difference = first * select(theirs_inverse, mine_inverse, in_order)
        - second * select(mine_inverse, theirs_inverse, in_order);
    return select(-difference, difference, in_order);
}
