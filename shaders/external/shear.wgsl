// Shear: periodic boundaries across an axis that move along x past each other (Lees and Edwards, doi:10.1088/0022-3719/5/15/006). The copy
// of the box above it is displaced along x by a shift that grows with time, and its particles are faster by a jump. All of it is integers.
override SHEAR_AXIS: u32;   // across which the boundaries are: 1 or 2
override SHEAR_LOW: u32;    // what the shift grows by in half a step, in 2^-64 of the box: low and high word
override SHEAR_HIGH: u32;
override SHEAR_STEP: i32;   // and in a step, in 2^-32 of the box
override SHEAR_FIRST: u32;  // the shift at the start, in 2^-32 of the box
override SHEAR_MOMENT: u32; // half steps since the step began at which a kernel sees the particles
override SHEAR_PART: u32;   // half steps in a part of a drift

// The shift some half steps after the step began, in 2^-32 of the box: the high word of a product of 64 bits, exact in every step.
fn shift_after(more: u32) -> u32 { return shift_at(sum64_add(halves_of(clock_step()), Sum64(more, 0u))); }
// The half steps before a step, and the shift after so many.
fn halves_of(step: vec2<u32>) -> Sum64 { return Sum64(step.x << 1u, (step.y << 1u) | (step.x >> 31u)); }
fn shift_at(halves: Sum64) -> u32 {
    return SHEAR_FIRST + high_of_product(halves.x, SHEAR_LOW) + halves.x * SHEAR_HIGH + halves.y * SHEAR_LOW;
}

// Slot external/shift: the shift where a kernel sees the particles. Variant kept; the plan of particles chooses it for
// kernels that visit particles one by one. Default: from the clock.
fn shift_here() -> u32 { return shift_after(SHEAR_MOMENT); }

// By how many units the momentum of a particle is larger above a boundary than below.
override SHEAR_JUMP: i32;   // of the only species
override JUMP_ENTRIES: u32; // entries before those of species in their table, in whole halves; 0 without one

fn jump_of(species: i32) -> i32 {
    if (JUMP_ENTRIES == 0u) { return SHEAR_JUMP; }
    let entry = vec4<i32>(coefficient_entry(JUMP_ENTRIES + u32(species)));
    return entry.x * 65536 + entry.y;
}

// By how many boxes the nearest copy of another particle is above it: 1, 0 or -1. Odd under exchange.
fn boxes_up(mine: Fraction, other: Fraction) -> i32 {
    let apart = bitcast<i32>(mine[SHEAR_AXIS] - other[SHEAR_AXIS]);
    let above = (apart < 0) & (mine[SHEAR_AXIS] > other[SHEAR_AXIS]);
    let below = (apart > 0) & (mine[SHEAR_AXIS] < other[SHEAR_AXIS]);
    return select(select(0, -1, below), 1, above);
}

// The momentum along x with which a particle at a place would flow, in the linear profile that rests in the middle of the box.
fn flow_at(fraction: Fraction, species: i32) -> f32 {
    let place = bitcast<i32>(fraction[SHEAR_AXIS] ^ 0x80000000u);
    return f32(jump_of(species)) * (f32(place) * 2.3283064e-10); // 2^-32
}

// A particle that drifts through boundaries.
struct ShearedFlight { place: Fraction, momentum: Steps }

// Drifts a part of a step that ends some half steps after the step began. What crosses a boundary goes on as the copy that comes in at the
// opposite one: where that is, depends on the shift at the end of the drift only.
fn drift_through(start: ShearedFlight, species: i32, end: u32) -> ShearedFlight {
    var there = start.place + unsigned(part_of_drift(momentum_word(start.momentum, species)));
    let moved = bitcast<i32>(there[SHEAR_AXIS] - start.place[SHEAR_AXIS]);
    let up = (moved >= 0) & (there[SHEAR_AXIS] < start.place[SHEAR_AXIS]);
    let down = (moved < 0) & (there[SHEAR_AXIS] > start.place[SHEAR_AXIS]);
    let crossed = select(select(0, -1, down), 1, up);
    let taken = crossed * jump_of(species);
    var momentum = start.momentum;
    momentum.x -= taken;
    there.x -= bitcast<u32>(crossed) * shift_after(end);
    note_crossing(taken);
    return ShearedFlight(there, momentum);
}

// All parts of a drift.
fn drift_through_all(start: ShearedFlight, species: i32) -> ShearedFlight {
    var flight = start;
    for (var part = 1; part <= drift_parts(); part++) { flight = drift_through(flight, species, u32(part) * SHEAR_PART); }
    return flight;
}

// Books the momentum along x that a boundary takes from a particle: low and high word, in any order.
fn note_crossing(taken: i32) {
    let value = sum64_of_i32(taken);
    // A loop, not a branch: software adapters execute both sides of a branch, atomics included, but leave a loop.
    for (var pending = taken != 0 && is_booked; pending; pending = false) {
        let before = atomicAdd(&wall_impulses[0], value.x);
        let carry = select(0u, 1u, before + value.x < before);
        atomicAdd(&wall_impulses[1], value.y + carry);
    }
}
