// All particles have the same mass: friction is one of momenta, which are exact.
override INVERSE_MASS: f32;
override DRIFT: f32;   // displacement in a step per unit of momentum

fn inverse_mass_of(species: i32) -> f32 { return INVERSE_MASS; }
fn yielding_of(species: i32) -> f32 { return INVERSE_MASS; }
fn drift_of(species: i32) -> f32 { return DRIFT; }
fn kinetic_of(species: i32) -> f32 { return KINETIC; }

// Whether what belongs to this particle is computed before what belongs to the other one. Always: without masses there is nothing
// that would round differently at the two ends.
fn mine_first(me: Particle, other: Particle) -> bool { return true; }
// Rates are per mass, which is 1.
fn rate_scale_of(species: i32) -> f32 { return 1.0; }
// The rate at which a pair relaxes among others, from the rates of its particles without it: even under exchange.
fn pair_rate(me: Particle, other: Particle, own: f32, mine: f32, theirs: f32) -> f32 {
    return 2.0 * own + (mine + theirs) * (0.5 / f32(DIMENSION));
}
