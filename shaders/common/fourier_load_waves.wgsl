// What the pass before has left.
fn load_pair(site: Site, leg: u32) -> vec4<f32> {
    return vec4<f32>(
        wave(element(site.line, source(site, leg))),
        wave(element(site.line, source(site, leg + RADIX / 2u))),
    );
}
