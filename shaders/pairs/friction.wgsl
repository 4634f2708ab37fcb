// Friction along the line of centres, `root` being the root of the weight: impulses of half a step, and of a whole one
// in split steps.
override FRICTION_LAW: u32; // of the integrator: 3 is relaxation in split steps; 0 where there is no friction
const FRICTION_OF_VELOCITY: u32 = 1u;
const FRICTION_OF_GRADIENT: u32 = 2u;
const FRICTION_IN_STAGES: u32 = 4u; // relaxation in two

fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    if (FRICTION_LAW == FRICTION_OF_VELOCITY) { return friction_of_velocity(c, contact, root, me, other); }
    if (FRICTION_LAW == FRICTION_OF_GRADIENT) { return friction_of_gradient(c, contact, root, me, other); }
    return 0.0;
}

// From the relative velocity along the line of centres, Groot and Warren, doi:10.1063/1.474784.
fn friction_of_velocity(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let motion = relative_motion(me, other, friction_momentum(me), friction_momentum(other));
    return -c.friction * root * root * dot(contact.direction, motion);
}

override FRICTION_PER_LENGTH: f32; // momentum units per length of drift: converts a change of phi to a momentum

// From the change of the coupling function since the last step, Cotter and Reich (18)-(21),
// doi:10.1209/epl/i2003-00621-8. Last positions follow from the last drifts, which are recomputed to the bit.
fn friction_of_gradient(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    let in_order = mine_first(me, other);
    let first = drift_steps(select(other.momentum, me.momentum, in_order));
    let second = drift_steps(select(me.momentum, other.momentum, in_order));
    let drifted = select(second - first, first - second, in_order);
    let way = drifted - copy_drift(me.position, other.position);
    let d = Vector(way_between(me.position, other.position) - way) * unit_lengths();
    let before = coupling(max(1.0 - length(d) * (1.0 / CUTOFF), 0.0));
    return -c.friction * FRICTION_PER_LENGTH * root * (coupling(contact.w) - before);
}

// In split steps: the impulse that relaxes the pair at the rate s of pairs/rates and adds its noise, even under
// exchange to the last bit. Passes over pairs: slot pairs/pass, variants find, relax_first, relax, observe_first_stage,
// observe_motion.
//
// Both ends compute it, and must find the same bits. A compiler may contract a product and a sum at one place and not
// at another, so whatever belongs to one particle has no product in a sum, or is sorted by the ids before it has, or
// stays in integers: CONTRIBUTING.md, "Exact on any compiler". `tests/determinism/any_compiler.rs` simulates such
// compilers.
fn relaxation_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    if (FRICTION_LAW == 0u) { return 0.0; }
    let rate = friction_rate(c, root);
    let s = pair_rate(me, other, rate, rate_of_others(me, rate), rate_of_others(other, rate));
    let motion = relative_motion(me, other, steps_of(me.momentum), steps_of(other.momentum));
    let random = random_impulse(c, root, me, other);
    if (FRICTION_LAW == FRICTION_IN_STAGES) {
        let share = staged_share(s);
        let noise = random * sqrt(share) * STAGE_NOISE;
        return noise - STAGE_FRICTION * rate * share * dot(contact.direction, motion);
    }
    let share = relaxed_share(s);
    let noise = random * sqrt(2.0 * share * (2.0 - s * share));
    return noise - rate * share * dot(contact.direction, motion);
}

// Exponential relaxation in the mean field of all pairs that share a particle, with the noise that leaves kT where the
// friction finds it: (1 - exp(-s)) / s.
fn relaxed_share(s: f32) -> f32 {
    return select((1.0 - exp(-s)) / s, 1.0 - s * (0.5 - s * (1.0 / 6.0)), s < 0.01);
}

// Relaxation in two stages with the same noise: with H the matrix of the frictions c of all pairs and N their noise, of
// covariance 2kT H, they multiply to
//     p' = (1 - H + b H^2) p + (1 - (1 + 2b)/4 H) N,   b = .095.
// Slow modes relax by the friction itself, so that a pair has c = g, as long as the rate s at which it relaxes among the
// others does not exceed the limit up to which that is stable with something to spare; beyond, c = g limit/s.
override STAGE_FRICTION: f32 = 0.0; // part of the friction that this stage has
override STAGE_NOISE: f32 = 0.0;    // amplitude of the noise of this stage, over sqrt(kT c / 2)
const STAGE_LIMIT: f32 = 1.3;       // of the rate

// c / g
fn staged_share(s: f32) -> f32 { return STAGE_LIMIT / max(s, STAGE_LIMIT); }
