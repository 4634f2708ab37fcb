// Where the Fourier transform turns back: last pass forth, smoothing, first pass back; one invocation a butterfly.
@group(0) @binding(11) var<storage, read_write> symbols: array<f32>; // up to the middle of both axes

fn symbol(site: Site, leg: u32) -> f32 {
    let wave = source(site, leg);
    return symbols[min(wave, LENGTH - wave) * LINES + site.line];
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (index >= LINES * (LENGTH / RADIX)) { return; }
    let site = site_of(index);
    let waves_there = transformed(twisted(gathered(site), site.place, LENGTH));
    scattered(site, transformed(weighed(waves_there, site)));
}
