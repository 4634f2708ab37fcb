// Friction by relaxation of pair velocities in two stages with the same noise: slot pairs/pass, variants find, relax_first,
// relax, observe_first_stage, observe_motion.
//
// With H the matrix of the frictions c of all pairs and N their noise, of covariance 2kT H, the stages multiply to
//     p' = (1 - H + b H^2) p + (1 - (1 - 1/sqrt(2)) H) N,   b = (sqrt(2) - 1)^2 / 2,
// after which a mode of eigenvalue h of H has the temperature kT (1 + b^2 h^4 / (1 - (1 - h + b h^2)^2)). A mode that relaxes at the
// rate s of pairs/rates gets the h for which 1 - h + b h^2 = exp(-s), at most 1.1, and each pair c = g h/s.
override STAGE_FRICTION: f32; // part of the friction that this stage has
override STAGE_NOISE: f32;    // amplitude of the noise of this stage, over sqrt(kT c / 2)
const STAGE_CURVATURE: f32 = 0.34314575; // 4 b

// h(s) / s
fn staged_share(s: f32) -> f32 {
    let share = relaxed_share(s);
    return 2.0 * share / (1.0 + sqrt(1.0 - STAGE_CURVATURE * s * share));
}

// As `relaxation_impulse` of the variant relaxation, of one stage.
fn relaxation_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let rate = friction_rate(c, root);
    let s = pair_rate(me, other, rate, rate_of_others(me, rate), rate_of_others(other, rate));
    let share = staged_share(s);
    let motion = relative_motion(me, other, steps_of(me.momentum), steps_of(other.momentum));
    let noise = random_impulse(c, root, me, other) * sqrt(share) * STAGE_NOISE;
    return noise - STAGE_FRICTION * rate * share * dot(contact.direction, motion);
}
