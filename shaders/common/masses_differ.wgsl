// Species of different masses: friction is one of velocities.
override DRIFT: f32;   // displacement in a step per unit of momentum at unit mass
override KINETIC: f32; // energy per square of a unit of momentum at unit mass

fn inverse_mass_of(species: i32) -> f32 { return coefficient_entry(u32(species)).w; }
fn drift_of(species: i32) -> f32 { return DRIFT * inverse_mass_of(species); }
fn kinetic_of(species: i32) -> f32 { return KINETIC * inverse_mass_of(species); }

// Whether a particle is the first of its pair, the one with the smaller id. What depends on the masses is computed in this
// order, so that both ends round alike even where products and sums are contracted.
fn ordered(me: Particle, other: Particle) -> bool { return me.position.w < other.position.w; }
// Rate of a pair among others, of its particles in their order.
// Rates are kept per mass of their particle, so that they mean the same in every unit of mass.
fn rate_scale_of(species: i32) -> f32 { return inverse_mass_of(species); }
fn pair_rate(first: i32, second: i32, own: f32, of_first: f32, of_second: f32) -> f32 {
    let a = inverse_mass_of(first);
    let b = inverse_mass_of(second);
    return own * (a + b) + (of_first * a + of_second * b) / (a + b) * (1.0 / f32(DIMENSION));
}
// The difference of two velocities, odd under exchange to the last bit.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    let in_order = ordered(me, other);
    let first = Vector(select(theirs, mine, in_order));
    let second = Vector(select(mine, theirs, in_order));
    let mine_inverse = inverse_mass_of(species_of(me));
    let theirs_inverse = inverse_mass_of(species_of(other));
    let difference = first * select(theirs_inverse, mine_inverse, in_order)
        - second * select(mine_inverse, theirs_inverse, in_order);
    return select(-difference, difference, in_order);
}
