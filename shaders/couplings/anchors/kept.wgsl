// Positions when neighbours were listed: a particle that has moved further than half the margin of the list demands a new one.
override SQUARED_REACH: f32; // of half the margin

fn check_anchor(slot: u32, fraction: Fraction) {
    let d = Vector(signed(fraction - fraction_of(anchors[slot]))) * unit_lengths();
    // A loop, not a branch: software adapters execute both sides of a branch, atomics included, but leave a loop.
    for (var far = dot(d, d) > SQUARED_REACH; far; far = false) { atomicStore(&control.demand, 1u); }
}
fn note_anchor(slot: u32, position: vec4<u32>) { anchors[slot] = position; }
