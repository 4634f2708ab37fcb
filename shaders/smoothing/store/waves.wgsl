// Stores what the next pass loads.
fn store_pair(butterfly: Butterfly, leg: u32, pair: vec4<f32>) {
    put_wave(element_of_line(butterfly.line, target_of(butterfly, leg)), pair.xy);
    put_wave(element_of_line(butterfly.line, target_of(butterfly, leg + RADIX / 2u)), pair.zw);
}
