// The law of a pair: impulses along the line of centres, in integer momentum units, positive where they push the particles apart.
// All are even under exchange to the last bit, so that both ends round the same number. Defaults: off.
//
// Slot pairs/weight: the root of the weight omega(w), w = 1 - r/rc, and the coupling function phi with phi' = root of omega.
// Variants standard (omega = w^2), general; the plan follows the exponent of the scene. No default.

// Slot pairs/repulsion: the conservative impulse at w. The plan chooses `soft` if any repulsion is above zero.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return 0.0; }

// Slot pairs/friction: the frictional impulse, `root` being the root of the weight. Variants velocity, discrete_gradient: the
// plan follows the integrator. The variant relaxation provides `friction_rate` and `relaxation_impulse` for split steps
// instead.
fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }

// Slot pairs/random: the random impulse. The plan chooses `thermal` if there are friction and a temperature.
fn random_impulse(c: Coefficients, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }
