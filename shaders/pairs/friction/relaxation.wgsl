// Friction by exponential relaxation of pair velocities in the mean field of all pairs that share a particle: at the rate s of
// pairs/rates, with the noise that leaves kT where the friction finds it. For split steps: slot pairs/pass, variants find,
// relax, observe_motion.

// The impulse along the line of centres that relaxes the pair and adds its noise: even under exchange to the last bit.
//
// Both ends compute it, and must find the same bits. A compiler may contract a product and a sum at one place and not at
// another, so whatever belongs to one particle has no product in a sum, or is put in the order of the ids before it has, or
// stays in integers: CONTRIBUTING.md, "Exact on any compiler". `tests/determinism/any_compiler.rs` simulates such compilers.
fn relaxation_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let rate = friction_rate(c, root);
    let s = pair_rate(me, other, rate, rate_of_others(me, rate), rate_of_others(other, rate));
    let share = relaxed_share(s);
    let motion = relative_motion(me, other, steps_of(me.momentum), steps_of(other.momentum));
    let noise = random_impulse(c, root, me, other) * sqrt(2.0 * share * (2.0 - s * share));
    return noise - rate * share * dot(contact.direction, motion);
}
