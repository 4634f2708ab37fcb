// Fourier transforms (smoothing/fourier) by several lanes a butterfly, which exchange legs through workgroup memory.
//
// For radices that one lane has no registers for, and for lines that are few.
var<workgroup> shared_legs: array<vec2<f32>, SHARED_LEGS>;

// The butterfly of a lane among those of its workgroup, and its part in it.
struct LaneShare { butterfly: u32, part: u32, place: u32 }
fn share_of_lane(lane: u32) -> LaneShare {
    let share = butterfly_and_part(lane);
    return LaneShare(share.x, share.y, share.x * SHARED);
}

// A leg multiplied by a power of a root of unity: by the roots of the bits of the power, from the lowest on.
fn turned_leg(leg: vec2<f32>, power: u32, step: u32) -> vec2<f32> {
    if (power == 0u) { return leg; }
    var rest = power;
    var w = roots[(rest & (~rest + 1u)) * step];
    rest &= rest - 1u;
    // Ends: every turn clears a bit.
    while (rest != 0u) {
        w = times(roots[(rest & (~rest + 1u)) * step], w);
        rest &= rest - 1u;
    }
    return times(leg, w);
}

// Slot smoothing/shared_twist: the roots of unity between two passes along a line.
// Default: off, the first pass along a line. The plan chooses `between_passes` for the others.
fn first_twisted(legs: FirstLegs, column: u32, number: u32, length: u32) -> FirstLegs { return legs; }

// One pass of a Fourier transform. SECOND invocations a butterfly; loads and stores its legs.
@compute @workgroup_size(WORKGROUP)
fn fourier_pass_of_lanes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let share = share_of_lane(lane);
    let index = linear_workgroup(workgroup) * (WORKGROUP / SECOND) + share.butterfly;
    let works = index < LINES * (LENGTH / RADIX);
    let butterfly = butterfly_of(index);
    if (works) {
        let legs = first_gathered(butterfly, share.part);
        let number = butterfly.place % SPAN;
        first_transformed(first_twisted(legs, share.part, number, RADIX * SPAN), share.part, share.place);
    }
    workgroupBarrier();
    if (works && share.part < FIRST) {
        second_scattered(butterfly, share.part, second_transformed(share.part, share.place));
    }
}

// Where the Fourier transform turns back: last pass forth, smoothing, first pass back. SECOND invocations a butterfly.
@compute @workgroup_size(WORKGROUP)
fn fourier_turn_of_lanes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let share = share_of_lane(lane);
    let index = linear_workgroup(workgroup) * (WORKGROUP / SECOND) + share.butterfly;
    let works = index < LINES * (LENGTH / RADIX);
    let has_row = works && share.part < FIRST;
    let butterfly = butterfly_of(index);
    if (works) {
        let legs = first_gathered(butterfly, share.part);
        first_transformed(first_twisted(legs, share.part, butterfly.place, LENGTH), share.part, share.place);
    }
    workgroupBarrier();
    var waves_there: SecondLegs;
    if (has_row) { waves_there = second_transformed(share.part, share.place); }
    workgroupBarrier();
    if (has_row) { second_weighed(butterfly, share.part, waves_there, share.place); }
    workgroupBarrier();
    var back: FirstLegs;
    if (works) { back = first_shared(share.part, share.place); }
    workgroupBarrier();
    if (works) { first_transformed(back, share.part, share.place); }
    workgroupBarrier();
    if (has_row) { second_scattered(butterfly, share.part, second_transformed(share.part, share.place)); }
}
