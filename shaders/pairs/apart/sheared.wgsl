// The nearest copy of the other particle is one that shear displaces, and moves, across a boundary.
fn way_between(position: vec4<u32>, other: vec4<u32>) -> Steps {
    let mine = fraction_of(position);
    let theirs = fraction_of(other);
    var way = signed(mine - theirs);
    way.x -= boxes_up(mine, theirs) * bitcast<i32>(shift_here());
    return way;
}
fn copy_drift(position: vec4<u32>, other: vec4<u32>) -> Steps {
    var way = Steps(0);
    way.x = boxes_up(fraction_of(position), fraction_of(other)) * SHEAR_STEP;
    return way;
}
