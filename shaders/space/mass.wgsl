// Masses, and what depends on them in a pair: `inverse_mass_of` belongs to the velocity of a particle, `yielding_of` to
// the impulses on it. Where all particles have the same mass friction is one of momenta, which are exact, else one of
// velocities.
override ONE_MASS: u32;     // 1 where all particles have the same, and none is held
override INVERSE_MASS: f32; // of all
override DRIFT: f32;        // displacement in a step per unit of momentum, at unit mass where masses differ
override HELD: u32;         // 1 where some particles are held: no impulse moves them

// Frozen particles have a velocity, and their entries hold the negative of the inverse mass that goes with their
// momentum; entries of fixed particles are zero.
fn inverse_mass_of(species: i32) -> f32 {
    if (ONE_MASS == 1u) { return INVERSE_MASS; }
    let entry = coefficient_entry(u32(species)).w;
    return select(entry, abs(entry), HELD == 1u);
}
// The velocity that an impulse of a unit gives a particle: none of what is held.
fn yielding_of(species: i32) -> f32 {
    if (ONE_MASS == 1u) { return INVERSE_MASS; }
    let entry = coefficient_entry(u32(species)).w;
    return select(entry, max(entry, 0.0), HELD == 1u);
}
fn drift_of(species: i32) -> f32 {
    if (ONE_MASS == 1u) { return DRIFT; }
    return DRIFT * inverse_mass_of(species);
}
fn kinetic_of(species: i32) -> f32 {
    if (ONE_MASS == 1u) { return KINETIC; }
    return KINETIC * yielding_of(species);
}

// True if what belongs to this particle is computed before what belongs to the other one: both ends begin with the
// smaller id, so that both round alike even where products and sums are contracted. Without masses there is nothing that
// would round differently at the two ends.
fn mine_first(me: Particle, other: Particle) -> bool {
    if (ONE_MASS == 1u) { return true; }
    return me.position.w < other.position.w;
}
// Rates are kept per mass of their particle, so that they mean the same in every unit of mass; a common one is 1.
fn rate_scale_of(species: i32) -> f32 {
    if (ONE_MASS == 1u) { return 1.0; }
    return yielding_of(species);
}
// The rate at which a pair relaxes among others, from the rates of its particles without it: even under exchange to the
// last bit. A pair with a held particle relaxes at the rate of the other one against an infinite mass. Two that are held
// have no friction.
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    if (ONE_MASS == 1u) { return 2.0 * own + (mine + theirs) * (0.5 / f32(DIMENSION)); }
    let in_order = mine_first(me, other);
    let my_inverse = yielding_of(species_of(me));
    let their_inverse = yielding_of(species_of(other));
    let both = my_inverse + their_inverse;
    let weighed = select(theirs, mine, in_order) * select(their_inverse, my_inverse, in_order)
        + select(mine, theirs, in_order) * select(my_inverse, their_inverse, in_order);
    let mean = select(weighed / both, 0.0, HELD == 1u && both == 0.0);
    return own * both + mean * (1.0 / f32(DIMENSION));
}
