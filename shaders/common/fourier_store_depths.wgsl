// Last pass along rows, back: the two rows that went through as one.
@group(0) @binding(13) var<storage, read_write> depths: array<f32>;

fn store(line: u32, place: u32, value: vec2<f32>) {
    let node = line * LENGTH + place;
    depths[node] = value.y;
    depths[node + LINES * LENGTH] = value.x;
}
fn store_pair(site: Site, leg: u32, pair: vec4<f32>) {
    store(site.line, target_of(site, leg), pair.xy);
    store(site.line, target_of(site, leg + RADIX / 2u), pair.zw);
}
