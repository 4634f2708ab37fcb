// Between walls no pair is counted through the space behind them, and none of a frozen particle, which is there.
fn counts_pair(position: vec4<u32>, other: vec4<u32>) -> bool {
    let ends = vec3<u32>(WALL_X, WALL_Y, WALL_Z);
    let open = ends == vec3<u32>(0u);
    let inside = open | (max(position.xyz, other.xyz) < ends);
    // The nearest copy of a particle that is more than half a period away is one on the other side of the walls.
    let apart = max(position.xyz, other.xyz) - min(position.xyz, other.xyz);
    let straight = open | ((apart >> vec3<u32>(31u)) == vec3<u32>(0u));
    return position.w < other.w && all(inside & straight);
}
