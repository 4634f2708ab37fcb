// The ids are noted, by which the law finds the densities of the pair.
fn separation(position: vec4<u32>, other: vec4<u32>) -> Vector {
    pair_ids = vec2<u32>(position.w, other.w);
    return Vector(way_between(position, other)) * unit_lengths();
}
