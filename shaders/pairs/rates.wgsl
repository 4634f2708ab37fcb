// The rates at which friction relaxes the velocities of pairs that share particles, for split steps.
//
// Alone, a pair's relative velocity relaxes at the rate g/mu with g = gamma omega dt. All pairs act at once and from the
// same velocities, so each is relaxed at the rate s that its two particles feel from all their pairs, those other than
// this one counted with the mean projection 1/d of one direction on another. The first pass adds up the rates of each particle,
// `pair_rate` makes s of them, and `relaxation_impulse` the impulse.
override RATE_UNIT: f32;            // integer units of the rate, a power of two, so that its sum does not depend on the order
const RATE_LIMIT: i32 = 8388607;   // what fits into the word of the species
const RATE_OF_PAIR: f32 = 6553600.0; // the most units of a pair

// The rate of a pair on its own: even under exchange.
fn friction_rate(c: Coefficients, root: f32) -> f32 { return 2.0 * c.friction * root * root; }
fn rate_units(rate: f32) -> u32 { return u32(round(min(rate * RATE_UNIT, RATE_OF_PAIR))); }
// What a particle feels from its pairs other than this one. There is nothing to contract, see `relaxation_impulse`: one product
// is exact, because the unit is a power of two, and the other is inside `min`.
fn rate_of_others(particle: Particle, rate: f32) -> f32 {
    let own = min(rate * rate_scale_of(species_of(particle)), RATE_OF_PAIR / RATE_UNIT);
    return max(f32(particle.momentum.w >> 8u) * (1.0 / RATE_UNIT) - own, 0.0);
}
