// Loads what the pass before has stored.
fn load_pair(butterfly: Butterfly, leg: u32) -> vec4<f32> {
    return vec4<f32>(
        wave_at(element_of_line(butterfly.line, source(butterfly, leg))),
        wave_at(element_of_line(butterfly.line, source(butterfly, leg + RADIX / 2u))),
    );
}
