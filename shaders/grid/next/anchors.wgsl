// Neighbours are listed: a particle that has moved further than half the margin of the list from where it was listed
// demands a new list.
override SQUARED_REACH: f32; // of half the margin

fn note_place(slot: u32, place: Fraction) {
    let d = Vector(way_from_anchor(place, fraction_of(anchors[slot]))) * unit_lengths();
    // A loop, not a branch: software adapters execute both sides of a branch, atomics included, but leave a loop.
    for (var far = dot(d, d) > SQUARED_REACH; far; far = false) { atomicOr(&control.demand, LIST_DEMANDED); }
}
