// Threefry2x32 with 20 rounds (Salmon and others 2011, doi:10.1145/2063384.2063405): two random words from a counter and a key.
fn threefry_round(x: vec2<u32>, rotation: u32) -> vec2<u32> {
    let first = x.x + x.y;
    return vec2<u32>(first, ((x.y << rotation) | (x.y >> (32u - rotation))) ^ first);
}
fn threefry_mix_even(x: vec2<u32>) -> vec2<u32> {
    return threefry_round(threefry_round(threefry_round(threefry_round(x, 13u), 15u), 26u), 6u);
}
fn threefry_mix_odd(x: vec2<u32>) -> vec2<u32> {
    return threefry_round(threefry_round(threefry_round(threefry_round(x, 17u), 29u), 16u), 24u);
}
fn threefry2x32(counter: vec2<u32>, key: vec2<u32>) -> vec2<u32> {
    let last = 0x1BD11BDAu ^ key.x ^ key.y;
    var x = counter + key;
    x = threefry_mix_even(x) + vec2<u32>(key.y, last + 1u);
    x = threefry_mix_odd(x) + vec2<u32>(last, key.x + 2u);
    x = threefry_mix_even(x) + vec2<u32>(key.x, key.y + 3u);
    x = threefry_mix_odd(x) + vec2<u32>(key.y, last + 4u);
    return threefry_mix_even(x) + vec2<u32>(last, key.x + 5u);
}
