// How often something crosses the ends of the box on its way, which is shorter than half of it, from one fraction to
// another: a signed step that carries out of the fraction is a crossing.
fn crossings(before: vec4<u32>, now: vec4<u32>) -> vec4<i32> {
    let moved = bitcast<vec4<i32>>(now - before);
    let forward = (moved >= vec4<i32>(0)) & (now < before);
    let backward = (moved < vec4<i32>(0)) & (now > before);
    return select(vec4<i32>(0), vec4<i32>(1), forward) - select(vec4<i32>(0), vec4<i32>(1), backward);
}
