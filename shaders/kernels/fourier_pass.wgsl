// One pass of a Fourier transform, one invocation a butterfly.
@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= LINES * (LENGTH / RADIX)) { return; }
    let site = site_of(index);
    scattered(site, transformed(twisted(gathered(site), site.place % SPAN, RADIX * SPAN)));
}
