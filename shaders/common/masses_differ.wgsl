// Species of different masses: friction is one of velocities.
override DRIFT: f32;   // displacement in a step per unit of momentum at unit mass
override KINETIC: f32; // energy per square of a unit of momentum at unit mass

fn inverse_mass_of(species: i32) -> f32 { return coefficient_entry(u32(species)).w; }
fn drift_of(species: i32) -> f32 { return DRIFT * inverse_mass_of(species); }
fn kinetic_of(species: i32) -> f32 { return KINETIC * inverse_mass_of(species); }

// Whether what belongs to this particle is computed before what belongs to the other one: at both ends that of the smaller id is
// the first, so that both round alike.
fn mine_first(me: Particle, other: Particle) -> bool { return me.position.w < other.position.w; }

// Below, terms are odd or even under exchange of the particles, where those of one particle each would be contracted at one end
// and not at the other: a x + b y = ½ (a + b) (x + y) + ½ (a - b) (x - y).

// Rate of a pair among others, from what its particles feel from these.
// Rates are kept per mass of their particle, so that they mean the same in every unit of mass.
fn rate_scale_of(species: i32) -> f32 { return inverse_mass_of(species); }
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    let a = inverse_mass_of(species_of(me));
    let b = inverse_mass_of(species_of(other));
    // Of what is even only: a quotient may err to one side.
    let reciprocal = 1.0 / (a + b);
    return own * (a + b) + ((mine + theirs) + (a - b) * reciprocal * (mine - theirs)) * (0.5 / f32(DIMENSION));
}
// The difference of two velocities.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    let a = 0.5 * inverse_mass_of(species_of(me));
    let b = 0.5 * inverse_mass_of(species_of(other));
    return (a + b) * Vector(mine - theirs) + (a - b) * Vector(mine + theirs);
}
