// First pass along rows: loads two rows, half a mesh apart, as one of complex numbers.
fn load(line: u32, place: u32) -> vec2<f32> {
    let node = line * LENGTH + place;
    return vec2<f32>(deviation_of_node(node), deviation_of_node(node + LINES * LENGTH));
}
fn load_pair(butterfly: Butterfly, leg: u32) -> vec4<f32> {
    return vec4<f32>(load(butterfly.line, source(butterfly, leg)), load(butterfly.line, source(butterfly, leg + RADIX / 2u)));
}
