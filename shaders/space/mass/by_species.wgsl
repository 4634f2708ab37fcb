// Species have different masses, or some particles are held: friction is one of velocities.
override DRIFT: f32;   // displacement in a step per unit of momentum at unit mass
override HELD: u32;    // 1 where some particles are held: no impulse moves them

// Frozen particles have a velocity, and their entries hold the negative of the inverse mass that goes with their
// momentum; entries of fixed particles are zero.
fn inverse_mass_of(species: i32) -> f32 {
    let entry = coefficient_entry(u32(species)).w;
    return select(entry, abs(entry), HELD == 1u);
}
// The velocity that an impulse of a unit gives a particle: none of what is held.
fn yielding_of(species: i32) -> f32 {
    let entry = coefficient_entry(u32(species)).w;
    return select(entry, max(entry, 0.0), HELD == 1u);
}
fn drift_of(species: i32) -> f32 { return DRIFT * inverse_mass_of(species); }
fn kinetic_of(species: i32) -> f32 { return KINETIC * yielding_of(species); }

// Whether what belongs to this particle is computed before what belongs to the other one: both ends begin with the smaller id, so
// that both round alike even where products and sums are contracted.
fn mine_first(me: Particle, other: Particle) -> bool { return me.position.w < other.position.w; }
// Rates are kept per mass of their particle, so that they mean the same in every unit of mass.
fn rate_scale_of(species: i32) -> f32 { return yielding_of(species); }
// The rate at which a pair relaxes among others, from the rates of its particles without it: even under exchange. A
// pair with a held particle relaxes at the rate of the other one against an infinite mass. Two that are held have no
// friction.
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    let in_order = mine_first(me, other);
    let my_inverse = yielding_of(species_of(me));
    let their_inverse = yielding_of(species_of(other));
    let both = my_inverse + their_inverse;
    let weighed = select(theirs, mine, in_order) * select(their_inverse, my_inverse, in_order)
        + select(mine, theirs, in_order) * select(my_inverse, their_inverse, in_order);
    let mean = select(weighed / both, 0.0, HELD == 1u && both == 0.0);
    return own * both + mean * (1.0 / f32(DIMENSION));
}
