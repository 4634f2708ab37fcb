// Random words for a key and two counters.
override GENERATOR: u32; // of the scene: 0 is Threefry2x32, 1 pcg4d

fn pair_words(key: vec2<u32>, counters: vec2<u32>) -> vec2<u32> {
    if (GENERATOR == 0u) { return threefry2x32(counters, key); }
    return pcg4d(key, counters);
}
// Words w and z of pcg4d (Jarzynski and Olano, JCGT 9(3), 2020).
fn pcg4d(key: vec2<u32>, counters: vec2<u32>) -> vec2<u32> {
    var v = vec4<u32>(counters, key) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4<u32>(16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v.wz;
}
