// The drift of a particle in a step, and the limits of vectors.
//
// Slots of space, none of which has a default:
// - space/dimension: the types `Fraction` (position, 2^-32 of the box), `Steps` (integer momentum or displacement) and `Vector`
//   (real numbers), and conversions between them and stored words. Variants one, two, three; plans follow the box of the scene.
// - space/mass: masses, and what depends on them in a pair: `inverse_mass_of` belongs to the velocity of a particle, `yielding_of` to
//   the impulses on it; `pair_rate` is even under exchange to the last bit. Variants one, by_species; chosen by
//   src/families/particles/plan/species.rs.
// - space/mass_of_particle: the inverse mass for analyses. Variants of_species; own (Voronoi cells).
// - space/coefficients: repulsion, friction and noise of a pair, even under exchange, the position bath of a species and the body
//   force on it, all in integer momentum units. Variants single, table; chosen by the same.

// What the sums of impulses hold.
const IMPULSE_LIMIT: f32 = 134217728.0; // 2^27 units: several of them still fit

// Whether every component is a number smaller than a limit, whatever its sign: see `is_within`.
fn all_within(v: Vector, limit: f32) -> bool {
    return all((bitcast<Fraction>(v) & Fraction(0x7fffffffu)) < Fraction(bitcast<u32>(limit)));
}

// Slot space/drift: displacement in 2^-32 of the box, rounded once.
// Default: that of a whole step. Plans of pairs choose `halves` for split steps, whose reports come between two halves.
fn drift_steps(momentum: vec4<i32>) -> Steps {
    return Steps(round(Vector(steps_of(momentum)) * (drift_of(species_in(momentum)) / unit_lengths())));
}
// The equal parts of which a drift is made, and one of them.
fn drift_parts() -> i32 { return 1; }
fn part_of_drift(momentum: vec4<i32>) -> Steps { return drift_steps(momentum); }
