// A random force on every particle that is constant for random times, independent of the time step: its impulses are integrals
// over all jumps, wherever within a step they come.
//
// `jump_after` of baths/jump gives the next force and how long it lasts, in half steps, from an id and the number of
// the jump.
struct NoiseImpulses { closing: Steps, opening: Steps }

override COLOURED_NOISE: u32 = 0u; // 1 where there is one
override HOLD_IMPULSE: f32;   // impulse of half a step per force

// Time is counted in half steps; `halves` whole ones and a `fraction` are left of the force.
struct Hold {
    force: array<f32, 3>,
    fraction: f32,
    halves: u32,
    jump: u32, // jumps so far
}

struct Jump { force: Vector, time: f32 }

// Ends a loop whatever its data; a scene may have at most 256 jumps on average.
const MOST_JUMPS: u32 = 2048u;
// The longest time that is kept, just below 2^32 half steps: no run lasts so long.
const LONGEST_HOLD: f32 = 4294967040.0;
const BELOW_ONE: f32 = 0.99999994;

// The impulse of one half step, which takes the process to its end.
fn cross_half_step(id: u32, hold: ptr<function, Hold>) -> Steps {
    var force = force_of((*hold).force);
    var fraction = (*hold).fraction;
    var halves = (*hold).halves;
    var jump = (*hold).jump;
    var integral = Vector(0.0);
    var rest = 1.0;
    for (var jumps = 0u; halves == 0u && fraction < rest && jumps < MOST_JUMPS; jumps += 1u) {
        integral += fraction * force;
        rest -= fraction;
        let next = jump_after(id, jump);
        let time = clamp(next.time, 0.0, LONGEST_HOLD);
        force = next.force;
        halves = u32(time);
        fraction = time - floor(time);
        jump += 1u;
    }
    let impulse = Steps(round(HOLD_IMPULSE * (integral + rest * force)));
    let borrows = fraction < rest;
    *hold = Hold(
        words_of_force(force),
        // A loop that ran out of jumps leaves nothing: the next half step begins with one.
        select(fraction - rest, select(0.0, min(fraction + (1.0 - rest), BELOW_ONE), halves > 0u), borrows),
        select(halves, max(halves, 1u) - 1u, borrows),
        jump,
    );
    return impulse;
}

// The impulses of both half steps around this step: one ends at it, one begins with it.
fn advance_hold(id: u32) -> NoiseImpulses {
    if (COLOURED_NOISE == 0u) { return NoiseImpulses(Steps(0), Steps(0)); }
    // Stored momenta of step 0 are full-step ones, and its process begins with it.
    let crossed = u32(1 + clock_closing());
    let whole = Steps(round(HOLD_IMPULSE * force_of(holds[id].force)));
    let halves = holds[id].halves;
    var impulses = NoiseImpulses(clock_closing() * whole, whole);
    var left = halves - crossed;
    // Most forces outlast a step.
    for (var pending = halves < crossed; pending; pending = false) {
        var hold = holds[id];
        for (var closing = clock_closing(); closing != 0; closing = 0) { impulses.closing = cross_half_step(id, &hold); }
        impulses.opening = cross_half_step(id, &hold);
        holds[id] = hold;
        left = hold.halves;
    }
    holds[id].halves = left;
    return impulses;
}
// The impulse of the half step that ends at this step alone, for a report: nothing is stored. At step 0, where the momentum is
// complete without it, it is that of the half step that begins there, which shows the force.
fn closing_of_hold(id: u32) -> Steps {
    if (COLOURED_NOISE == 0u) { return Steps(0); }
    var hold = holds[id];
    return cross_half_step(id, &hold);
}

// Random words of a jump: they depend on the jump's number, not on the step.
override JUMP_STREAM_X: u32; // key of the stream over all steps
override JUMP_STREAM_Y: u32;

fn words_of_jump(id: u32, jump: u32, half: u32) -> vec2<u32> {
    return pair_words(vec2<u32>(JUMP_STREAM_X, JUMP_STREAM_Y), vec2<u32>(id, 2u * jump + half));
}
// In (0, 1]: half a unit below 1 rounds to 1.
fn uniform_of_jump(word: u32) -> f32 { return centred_uniform(word) + 0.5; }
