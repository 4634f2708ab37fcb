// Friction by relaxation of pair velocities in two stages with the same noise: slot pairs/pass, variants find, relax_first,
// relax, observe_first_stage, observe_motion.
//
// With H the matrix of the frictions c of all pairs and N their noise, of covariance 2kT H, the stages multiply to
//     p' = (1 - H + b H^2) p + (1 - (1 + 2b)/4 H) N,   b = .095.
// Slow modes relax by the friction itself, so that a pair has c = g, as long as the rate s of pairs/rates at which it relaxes among the
// others does not exceed the limit up to which that is stable with something to spare; beyond, c = g limit/s.
override STAGE_FRICTION: f32; // part of the friction that this stage has
override STAGE_NOISE: f32;    // amplitude of the noise of this stage, over sqrt(kT c / 2)
const STAGE_LIMIT: f32 = 1.3; // of the rate

// c / g
fn staged_share(s: f32) -> f32 { return STAGE_LIMIT / max(s, STAGE_LIMIT); }

// As `relaxation_impulse` of the variant relaxation, of one stage.
fn relaxation_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let rate = friction_rate(c, root);
    let s = pair_rate(me, other, rate, rate_of_others(me, rate), rate_of_others(other, rate));
    let share = staged_share(s);
    let motion = relative_motion(me, other, steps_of(me.momentum), steps_of(other.momentum));
    let noise = random_impulse(c, root, me, other) * sqrt(share) * STAGE_NOISE;
    return noise - STAGE_FRICTION * rate * share * dot(contact.direction, motion);
}
