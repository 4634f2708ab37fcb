// The drift of a particle in a step, and the limits of vectors.
//
// Slots of space, none of which has a default:
// - space/dimension: the types `Fraction` (position, 2^-32 of the box), `Steps` (integer momentum or displacement) and `Vector`
//   (real numbers), and conversions between them and stored words. Variants one, two, three; plans follow the box of the scene.
// - space/mass_of_particle: the inverse mass for analyses. Variants of_species; own (Voronoi cells).
// - space/coefficients: repulsion, friction and noise of a pair, even under exchange, the position bath of a species and the body
//   force on it, all in integer momentum units. Variants single, table; chosen by
//   src/families/particles/plan/species.rs.

// What the sums of impulses hold.
const IMPULSE_LIMIT: f32 = 134217728.0; // 2^27 units: several of them still fit

// Whether every component is a number smaller than a limit, whatever its sign: see `is_within`.
fn all_within(v: Vector, limit: f32) -> bool {
    return all((bitcast<Fraction>(v) & Fraction(0x7fffffffu)) < Fraction(bitcast<u32>(limit)));
}

// Displacement in 2^-32 of the box. That of a split step, whose report comes between two halves, is exactly two halves,
// each rounded once: a report changes nothing.
override HALVES: i32; // halves of which the drift is made; 0 where a whole one is rounded once

fn drift_steps(momentum: vec4<i32>) -> Steps {
    if (HALVES != 0) { return HALVES * part_of_drift(momentum); }
    return part_of_drift(momentum);
}
// The equal parts of which a drift is made, and one of them.
fn drift_parts() -> i32 {
    if (HALVES != 0) { return HALVES; }
    return 1;
}
fn part_of_drift(momentum: vec4<i32>) -> Steps {
    var drift = drift_of(species_in(momentum));
    if (HALVES != 0) { drift *= 0.5; }
    return Steps(round(Vector(steps_of(momentum)) * (drift / unit_lengths())));
}
