// Loads what the pass before has stored.
fn load_pair(butterfly: Butterfly, leg: u32) -> vec4<f32> {
    return vec4<f32>(
        wave(element_of_line(butterfly.line, source(butterfly, leg))),
        wave(element_of_line(butterfly.line, source(butterfly, leg + RADIX / 2u))),
    );
}
