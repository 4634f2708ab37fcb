// First pass along rows: two rows, half a mesh apart, as one of complex numbers.
fn load(line: u32, place: u32) -> vec2<f32> {
    let node = line * LENGTH + place;
    return vec2<f32>(deviation(node), deviation(node + LINES * LENGTH));
}
fn load_pair(site: Site, leg: u32) -> vec4<f32> {
    return vec4<f32>(load(site.line, source(site, leg)), load(site.line, source(site, leg + RADIX / 2u)));
}
