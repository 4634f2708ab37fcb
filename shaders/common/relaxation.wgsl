// Exponential relaxation of pair velocities in the mean field of all pairs that share a particle.
//
// Alone, a pair's relative velocity relaxes at the rate g/mu with g = gamma omega dt. All pairs act at once and from the
// same velocities, so each is relaxed at the rate s that its two particles feel from all their pairs, those other than
// this one counted with the mean projection 1/d of one direction on another; the noise is that which leaves kT where the
// friction finds it.
const RATE_UNIT: f32 = 65536.0;    // integer units of the rate, so that its sum does not depend on the order
const RATE_LIMIT: i32 = 8388607;   // what fits beside the species

fn friction_rate(c: Coefficients, root: f32) -> f32 { return 2.0 * c.friction * root * root; }
fn rate_units(rate: f32) -> u32 { return u32(round(min(rate, 100.0) * RATE_UNIT)); }
fn rate_of(particle: Particle) -> f32 { return f32(particle.momentum.w >> 8u) / RATE_UNIT; }

// (1 - exp(-s)) / s
fn relaxed_share(s: f32) -> f32 {
    return select((1.0 - exp(-s)) / s, 1.0 - s * (0.5 - s * (1.0 / 6.0)), s < 0.01);
}

// Impulse along the line of centres that relaxes the pair and makes its noise.
fn relaxation_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let rate = friction_rate(c, root);
    let mine = max(rate_of(me) - rate * rate_scale_of(species_of(me)), 0.0);
    let theirs = max(rate_of(other) - rate * rate_scale_of(species_of(other)), 0.0);
    let s = pair_rate(me, other, rate, mine, theirs);
    let share = relaxed_share(s);
    let motion = relative_motion(me, other, steps_of(me.momentum), steps_of(other.momentum));
    let noise = random_impulse(c, root, me, other) * sqrt(2.0 * share * (2.0 - s * share));
    return noise - rate * share * dot(contact.direction, motion);
}
