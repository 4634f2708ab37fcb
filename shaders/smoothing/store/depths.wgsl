// Last pass along rows, back: stores the depths of the two rows that were transformed as one.
fn store_depths(line: u32, place: u32, value: vec2<f32>) {
    let node = line * LENGTH + place;
    depths[node] = value.y;
    depths[node + LINES * LENGTH] = value.x;
}
fn store_pair(butterfly: Butterfly, leg: u32, pair: vec4<f32>) {
    store_depths(butterfly.line, target_of(butterfly, leg), pair.xy);
    store_depths(butterfly.line, target_of(butterfly, leg + RADIX / 2u), pair.zw);
}
