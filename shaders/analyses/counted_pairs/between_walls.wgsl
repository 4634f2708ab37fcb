// Between walls no pair is counted through the space behind them, and none of a frozen particle: their ids come last.
override FIRST_FROZEN: u32;
override WALLED_AXES: u32; // a bit for each axis

fn counts_pair(position: vec4<u32>, other: vec4<u32>) -> bool {
    // The nearest copy of a particle that is more than half a period away is one on the other side of the walls.
    let through = (max(position, other) - min(position, other)) >> vec4<u32>(31u);
    let walled = (vec3<u32>(WALLED_AXES) >> vec3<u32>(0u, 1u, 2u)) & through.xyz & vec3<u32>(1u);
    return position.w < other.w && other.w < FIRST_FROZEN && all(walled == vec3<u32>(0u));
}
