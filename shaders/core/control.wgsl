// What changes from step to step, kept on the device so that many steps can be recorded ahead: the clock, the key of random
// words, and the failures.
struct Control {
    step: vec2<u32>,             // current step, low and high word
    next: vec2<u32>,             // the step that the next sort begins
    key: vec2<u32>,              // key of this step's random words
    seed_key: vec2<u32>,         // key of the whole stream, from the seed
    closing: i32,                // 0 at step 0, where stored momenta are full-step ones; else 1
    elapsed: u32,                // sorts since the state was uploaded
    failures: atomic<u32>,       // FAILURE_ bits
    failure_elapsed: atomic<u32>,// `elapsed` when the first of them was raised
    failure_place: atomic<u32>,  // the first mesh node, bond or cell with a failure
    demand: atomic<u32>,        // LIST_ bits
    limited: atomic<u32>,       // exchanges between Voronoi cells that a limit has cut, low and high word
    limited_high: atomic<u32>,
}

// Whether a number is smaller than a limit, whatever its sign; NaN is not. The bits are compared because a compiler may assume
// that there is no NaN, and the larger of NaN and a number is the number.
fn is_within(value: f32, limit: f32) -> bool { return (bitcast<u32>(value) & 0x7fffffffu) < bitcast<u32>(limit); }
// Whether a value is neither infinite nor NaN.
fn is_number(value: f32) -> bool { return (bitcast<u32>(value) & 0x7fffffffu) < 0x7f800000u; }

// Bits of `failures`. The host translates them into messages.
const FAILURE_IMPULSE: u32 = 1u;   // the impulses on a particle left the range of integers, or were not numbers
const FAILURE_MOMENTUM: u32 = 2u;  // a momentum came near the end of its range
const FAILURE_DISPLACEMENT: u32 = 4u; // a particle moved further than the cutoff in one step
const FAILURE_FRAMES: u32 = 8u; // the sorted array, a bin, or a list of neighbours or faces overflowed
const FAILURE_CROWDING: u32 = 16u; // more mass around a mesh node than its integers hold
const FAILURE_DEPTH: u32 = 32u;    // the depth at a mesh node became zero or negative
const FAILURE_BOND: u32 = 64u;     // a bond longer than its potential allows
const FAILURE_MASS: u32 = 128u;    // a Voronoi cell lost all of its mass, or has far too much
const FAILURE_ENERGY: u32 = 256u;  // the internal energy of a Voronoi cell became negative
const FAILURE_LOOPS: u32 = 512u;   // the adapter left a loop before its end
const FAILURE_REACH: u32 = 1024u;  // a bond reaches beyond the halo of a rank
const FAILURE_ITERATIONS: u32 = 2048u; // a solver needs more iterations than were recorded
const FAILURE_CHARGES: u32 = 4096u; // more charge around a mesh node, or a larger potential, than its integers hold

// A failure in a later step than the first is its consequence and is not reported.
fn no_failure_before() -> bool { return atomicLoad(&control.failure_elapsed) >= control.elapsed; }
// Records a failure. A loop, not a branch: software adapters execute both sides of a branch, atomics included, but leave a loop.
fn raise(failure: u32) {
    for (var pending = failure; pending != 0u; pending = 0u) {
        if (no_failure_before()) {
            atomicOr(&control.failures, pending);
            atomicMin(&control.failure_elapsed, control.elapsed);
        }
    }
}
// Records a failure and the mesh node, bond or cell where it is; the first place is kept.
fn raise_at(failure: u32, place: u32) {
    for (var pending = failure; pending != 0u; pending = 0u) {
        // Where there is too much mass the depth means nothing.
        let later = pending != FAILURE_CROWDING && (atomicLoad(&control.failures) & FAILURE_CROWDING) != 0u;
        if (no_failure_before() && !later) { atomicMin(&control.failure_place, place); }
        raise(pending);
    }
}

// Slot core/clock: how kernels read the clock. `clock_step` gives the low and high word of the step, `clock_key` the key of its
// random words, `clock_closing` 0 at step 0 and else 1; `show_clock` publishes a clock that has moved.
// Default: they read `control`. The plan chooses the texture for software adapters (src/plan/serial_memory.rs).
fn clock_step() -> vec2<u32> { return control.step; }
fn clock_key() -> vec2<u32> { return control.key; }
fn clock_closing() -> i32 { return control.closing; }
fn show_clock() {}

// 0 at step 0, where stored momenta are full-step ones; else 1.
fn closing_of(step: vec2<u32>) -> i32 { return select(1, 0, all(step == vec2<u32>(0u))); }

// Slot core/step: what begins a step.
// Default: moves the clock to the next step and draws the step's key. Plans choose `same` for a sort within a step.
fn begin_step() {
    let step = control.next;
    control.step = step;
    control.next = vec2<u32>(step.x + 1u, step.y + select(0u, 1u, step.x == 0xffffffffu));
    control.key = threefry2x32(step, control.seed_key);
    control.closing = closing_of(step);
    control.elapsed += 1u;
    show_clock();
}

// Begins a step of a scene without a list of neighbours. One invocation; reads and writes `control`.
@compute @workgroup_size(1)
fn begin_plain_step() { begin_step(); }

// Bits of `demand`.
const LIST_DEMANDED: u32 = 1u; // the list of neighbours has to be rebuilt
const LIST_SECOND: u32 = 2u;   // the second of two lists is the current one

override CONDITIONAL: u32; // kernels that depend on it

// Begins a step of a scene with a list of neighbours, and decides whether it is rebuilt. One workgroup; a lane copies every
// 64th word. `demands` holds the workgroups (x, y, z) of each kernel of the list: first as they are when it runs, then as they
// are in this step, which are none if no particle has demanded a new list and none is due. Of two lists the new one is the other.
@compute @workgroup_size(64)
fn begin_listed_step(@builtin(local_invocation_index) lane: u32) {
    let word = atomicLoad(&control.demand);
    let demanded = (word & LIST_DEMANDED) != 0u || is_outdated(control.next);
    for (var word = lane; word < 3u * CONDITIONAL; word += 64u) {
        demands[3u * CONDITIONAL + word] = select(0u, demands[word], demanded);
    }
    storageBarrier();
    if (lane == 0u) {
        atomicStore(&control.demand, select(word, ~word & LIST_SECOND, demanded));
        begin_step();
    }
}
