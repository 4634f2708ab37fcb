// Species have different masses: friction is one of velocities.
override DRIFT: f32;   // displacement in a step per unit of momentum at unit mass

fn inverse_mass_of(species: i32) -> f32 { return coefficient_entry(u32(species)).w; }
fn yielding_of(species: i32) -> f32 { return inverse_mass_of(species); }
fn drift_of(species: i32) -> f32 { return DRIFT * inverse_mass_of(species); }
fn kinetic_of(species: i32) -> f32 { return KINETIC * inverse_mass_of(species); }

// Whether what belongs to this particle is computed before what belongs to the other one: both ends begin with the smaller id, so
// that both round alike even where products and sums are contracted.
fn mine_first(me: Particle, other: Particle) -> bool { return me.position.w < other.position.w; }
// Rates are kept per mass of their particle, so that they mean the same in every unit of mass.
fn rate_scale_of(species: i32) -> f32 { return inverse_mass_of(species); }
// The rate at which a pair relaxes among others, from the rates of its particles without it: even under exchange.
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    let in_order = mine_first(me, other);
    let my_inverse = inverse_mass_of(species_of(me));
    let their_inverse = inverse_mass_of(species_of(other));
    let both = my_inverse + their_inverse;
    let weighed = select(theirs, mine, in_order) * select(their_inverse, my_inverse, in_order)
        + select(mine, theirs, in_order) * select(my_inverse, their_inverse, in_order);
    return own * both + weighed / both * (1.0 / f32(DIMENSION));
}
