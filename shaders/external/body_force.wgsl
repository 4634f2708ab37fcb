// Body forces: the same for all particles of a species at one place. Everything that gives a particle its impulse is done in
// integers, so that every kernel finds the same impulse on any compiler.
//
override PROFILE: u32;         // 0 where there are none; 1 is uniform, 2 opposed, 3 a sine, 4 uniform and oscillating
override FORCE_AXIS: u32 = 0u; // along which the force varies
override WAVES: u32 = 1u;      // of the sine, a whole number; of an oscillating force its part of a turn in a step, in 2^-32

// The impulse of half a step, in integer momentum units, for a particle, and for one of a species at a place in a step.
fn external_kick(me: Particle) -> Steps {
    if (PROFILE == 0u) { return Steps(0); }
    return external_kick_at(fraction_of(me.position), species_of(me), clock_step().x);
}
fn external_kick_at(fraction: Fraction, species: i32, step: u32) -> Steps {
    let impulse = external_impulse_of(species);
    if (PROFILE >= 3u) {
        // A cosine is the sine of a quarter of a turn more.
        let angle = select(fraction[FORCE_AXIS] * WAVES, step * WAVES + 0x40000000u, PROFILE == 4u);
        let sine = sine_of_half_turn(angle & 0x7fffffffu);
        let kick = impulse_in_step(part_of_impulse(impulse, sine), step);
        return select(kick, -kick, angle >= 0x80000000u);
    }
    let kick = impulse_in_step(impulse, step);
    // In the second half of the box the opposite of that in the first.
    return select(kick, -kick, PROFILE == 2u && fraction[FORCE_AXIS] >= 0x80000000u);
}

// An impulse in units of momentum: whole ones, and 2^-32 of one beyond.
struct Impulse { whole: Steps, rest: Fraction }

// The whole units of a step, so distributed over the steps that n of them add up to n times the impulse, less than a unit off.
fn impulse_in_step(impulse: Impulse, step: u32) -> Steps {
    let before = impulse.rest * step;
    return impulse.whole + select(Steps(0), Steps(1), before > ~impulse.rest);
}

// The sine of half a turn at most, in 2^-32, from an angle in 2^-32 of a turn: its series, off by less than 2e-9.
fn sine_of_half_turn(angle: u32) -> u32 {
    let part = min(min(angle, 0x80000000u - angle), 0x3fffffffu) << 2u; // of a quarter of a turn
    let square = high_of_product(part, part);
    var series = 15457u - high_of_product(square, 244u);
    series = 689090u - high_of_product(square, series);
    series = 20107981u - high_of_product(square, series);
    series = 342277223u - high_of_product(square, series);
    series = 2774394673u - high_of_product(square, series);
    let slope = 3373259426u - (high_of_product(square, series) >> 1u); // in 2^-31
    return min(high_of_product(part, slope), 0x7fffffffu) << 1u;
}

// A part of an impulse, in 2^-32.
fn part_of_impulse(impulse: Impulse, part: u32) -> Impulse {
    var scaled = impulse;
    for (var axis = 0u; axis < DIMENSION; axis++) {
        let whole = impulse.whole[axis];
        let low = bitcast<u32>(whole) * part;
        let rest = low + high_of_product(impulse.rest[axis], part);
        let high = high_of_product(bitcast<u32>(whole), part) - select(0u, part, whole < 0);
        scaled.whole[axis] = bitcast<i32>(high + select(0u, 1u, rest < low));
        scaled.rest[axis] = rest;
    }
    return scaled;
}

// Slot external/drifted: the impulses at both ends of the drift that has ended, times its momenta. The drift began with an impulse in its
// first place and ends with one in its last.
// Default: along a straight way. The plan chooses `between_walls` if the scene has walls.
fn work_of_drift(me: Particle, kick: Steps, step: u32) -> f32 {
    let before = fraction_of(me.position) - unsigned(drift_steps(me.momentum));
    let both = kick + external_kick_at(before, species_of(me), step - 1u);
    return dot(Vector(both), Vector(steps_of(me.momentum)));
}

// Sums of a row of the account: three of momentum and one of work, all given up to the report point of this step; then what the impulses
// of this step add, of which the opening half counts in the next.
const ACCOUNT: u32 = 8u;

// Books what body forces give in a step, before anything else changes the particles. A workgroup has a row of `account`, in the place of
// `partial_sums`; its lanes share every GROUPS-th stretch of stored particles.
@compute @workgroup_size(WORKGROUP)
fn book_external(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let step = clock_step().x;
    var given: array<vec2<u32>, 4>;
    for (var slot = group * WORKGROUP + lane; slot < stored_count(); slot += GROUPS * WORKGROUP) {
        let me = stored_particle(slot);
        if (!is_own(me.position)) { continue; }
        let species = species_of(me);
        let fraction = fraction_of(me.position);
        let kick = external_kick_at(fraction, species, step);
        let word = momentum_word(kick, 0);
        given[0] = sum64_add(given[0], sum64_of_i32(word.x));
        given[1] = sum64_add(given[1], sum64_of_i32(word.y));
        given[2] = sum64_add(given[2], sum64_of_i32(word.z));
        given[3] = sum64_add(given[3], sum64_of_signed(work_of_drift(me, kick, step) * (2.0 * kinetic_of(species))));
    }
    let row = group * ACCOUNT;
    var kept: array<vec2<u32>, 4>;
    if (lane == 0u) {
        for (var quantity = 0u; quantity < 3u; quantity++) {
            kept[quantity] = sum64_add(partial_sums[row + quantity], partial_sums[row + 4u + quantity]);
        }
        kept[3] = partial_sums[row + 3u];
    }
    for (var quantity = 0u; quantity < 4u; quantity++) { reduce_quantity(group, lane, 4u + quantity, given[quantity]); }
    if (lane == 0u) {
        let closes = clock_closing() == 1;
        for (var quantity = 0u; quantity < 4u; quantity++) {
            let now = select(Sum64(0u), partial_sums[row + 4u + quantity], closes);
            partial_sums[row + quantity] = sum64_add(kept[quantity], now);
        }
    }
}

// Tells a report what has been booked. One invocation a row of `account`; writes the last quantities of a row of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn report_external(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (group >= GROUPS) { return; }
    let row = (FIRST_GROUP + group) * QUANTITIES;
    for (var axis = 0u; axis < 3u; axis++) {
        partial_sums[row + SUM_GIVEN_MOMENTUM + axis] = account[group * ACCOUNT + axis];
    }
    partial_sums[row + SUM_GIVEN_WORK] = account[group * ACCOUNT + 3u];
}
