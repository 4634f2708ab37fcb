// Where the Fourier transform turns back: last pass forth, smoothing, first pass back; one invocation a butterfly.
@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= LINES * (LENGTH / RADIX)) { return; }
    let site = site_of(index);
    let waves_there = transformed(twisted(gathered(site), site.place, LENGTH));
    scattered(site, transformed(weighed(waves_there, site)));
}
