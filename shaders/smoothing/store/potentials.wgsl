// Last pass along rows, back: stores the potentials of the two rows that were transformed as one, rounded to integers once.
// Sums of differences of smaller potentials are below 2^31.
const MOST_POTENTIAL: f32 = 16777216.0; // 2^24

fn is_possible(value: f32) -> bool { return is_within(value, MOST_POTENTIAL); }
fn store_potential(node: u32, value: f32) {
    node_potentials[node] = i32(round(select(0.0, value, is_possible(value))));
}
fn store_potentials(line: u32, place: u32, value: vec2<f32>) {
    let node = line * LENGTH + place;
    store_potential(node, value.y);
    store_potential(node + LINES * LENGTH, value.x);
}
fn store_pair(butterfly: Butterfly, leg: u32, pair: vec4<f32>) {
    let possible = is_possible(pair.x) && is_possible(pair.y) && is_possible(pair.z) && is_possible(pair.w);
    raise(select(FAILURE_CHARGES, 0u, possible));
    store_potentials(butterfly.line, target_of(butterfly, leg), pair.xy);
    store_potentials(butterfly.line, target_of(butterfly, leg + RADIX / 2u), pair.zw);
}
