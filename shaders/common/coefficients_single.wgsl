// One species: every coefficient is a constant of the pipeline, in integer momentum units.
override REPULSION: f32; // impulse at contact
override FRICTION: f32;  // impulse per difference of momentum
override NOISE: f32;     // impulse per unit noise
override DRIFT: f32;     // displacement in a step per unit of momentum
override KINETIC: f32;   // energy per square of a unit of momentum

struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients { return Coefficients(REPULSION, FRICTION, NOISE); }
override INVERSE_MASS: f32;

fn inverse_mass_of(species: i32) -> f32 { return INVERSE_MASS; }
fn drift_of(species: i32) -> f32 { return DRIFT; }
fn kinetic_of(species: i32) -> f32 { return KINETIC; }

// Rate of a pair among others; rates are per mass.
fn rate_scale_of(species: i32) -> f32 { return 1.0; } // the friction is one of momenta already
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    return 2.0 * own + (mine + theirs) * (0.5 / f32(DIMENSION));
}
// The difference of two momenta, exact in integers: odd under exchange to the last bit.
fn relative_motion(me: Particle, other: Particle, mine: Steps, theirs: Steps) -> Vector {
    return Vector(mine - theirs);
}
