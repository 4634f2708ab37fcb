// As `sheared`, and the ids are noted as in `noted`.
fn separation(position: vec4<u32>, other: vec4<u32>) -> Vector {
    pair_ids = vec2<u32>(position.w, other.w);
    let mine = fraction_of(position);
    let theirs = fraction_of(other);
    var apart = signed(mine - theirs);
    apart.x -= boxes_up(mine, theirs) * bitcast<i32>(shift_here());
    return Vector(apart) * unit_lengths();
}
