// For the next pass.
fn store_pair(site: Site, leg: u32, pair: vec4<f32>) {
    put_wave(element(site.line, target_of(site, leg)), pair.xy);
    put_wave(element(site.line, target_of(site, leg + RADIX / 2u)), pair.zw);
}
