// For the next pass.
fn store_pair(site: Site, leg: u32, pair: vec4<f32>) {
    waves_next[element(site.line, target_of(site, leg))] = pair.xy;
    waves_next[element(site.line, target_of(site, leg + RADIX / 2u))] = pair.zw;
}
