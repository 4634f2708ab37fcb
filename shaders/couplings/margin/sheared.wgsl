// Copies across a boundary that shears move on without their particles. The margin holds how far they go until the
// shift reaches the next multiple of a part of it: then neighbours are listed again.
override SHEAR_MARGIN: u32; // that part, in 2^-32 of the box

fn way_from_anchor(place: Fraction, anchor: Fraction) -> Steps {
    var way = signed(place - anchor);
    way.x -= boxes_up(place, anchor) * bitcast<i32>(shift_at(halves_of(control.next)));
    return way;
}
fn is_outdated(step: vec2<u32>) -> bool {
    let halves = halves_of(step);
    let before = shift_at(sum64_add(halves, Sum64(0xfffffffeu, 0xffffffffu))); // two half steps
    return shift_at(halves) / SHEAR_MARGIN != before / SHEAR_MARGIN;
}
