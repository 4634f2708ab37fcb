// From the nearest copy of the other particle, which shear displaces across a boundary: odd under exchange.
fn separation(position: vec4<u32>, other: vec4<u32>) -> Vector {
    let mine = fraction_of(position);
    let theirs = fraction_of(other);
    var apart = signed(mine - theirs);
    apart.x -= boxes_up(mine, theirs) * bitcast<i32>(shift_here());
    return Vector(apart) * unit_lengths();
}
