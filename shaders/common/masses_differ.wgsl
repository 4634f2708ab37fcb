// Species of different masses: friction is one of velocities.
override DRIFT: f32;   // displacement in a step per unit of momentum at unit mass
override KINETIC: f32; // energy per square of a unit of momentum at unit mass

fn inverse_mass_of(species: i32) -> f32 { return coefficient_entry(u32(species)).w; }
fn drift_of(species: i32) -> f32 { return DRIFT * inverse_mass_of(species); }
fn kinetic_of(species: i32) -> f32 { return KINETIC * inverse_mass_of(species); }

// Rate of a pair among others; the same from either end to the last bit.
// Rates are kept per mass of their particle, so that they mean the same in every unit of mass.
fn rate_scale_of(species: i32) -> f32 { return inverse_mass_of(species); }
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    let a = inverse_mass_of(species_of(me));
    let b = inverse_mass_of(species_of(other));
    // In the order of the ids, so that both ends round alike even where products and sums are contracted.
    let in_order = me.position.w < other.position.w;
    let first = select(vec2<f32>(theirs, b), vec2<f32>(mine, a), in_order);
    let second = select(vec2<f32>(mine, a), vec2<f32>(theirs, b), in_order);
    let among = first.x * first.y + second.x * second.y;
    return own * (a + b) + among / (a + b) * (1.0 / f32(DIMENSION));
}
// The difference of two velocities. Both ends evaluate it in the order of their ids, so that it is odd under exchange
// to the last bit even where the compiler contracts products and sums.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    let in_order = me.position.w < other.position.w;
    let first = Vector(select(theirs, mine, in_order));
    let second = Vector(select(mine, theirs, in_order));
    let mine_inverse = inverse_mass_of(species_of(me));
    let theirs_inverse = inverse_mass_of(species_of(other));
    let difference = first * select(theirs_inverse, mine_inverse, in_order)
        - second * select(mine_inverse, theirs_inverse, in_order);
    return select(-difference, difference, in_order);
}
