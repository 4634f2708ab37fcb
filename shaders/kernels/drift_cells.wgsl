// Half a drift of every cell: the whole of A in a split step is one half before and one after its exchanges.
override PARTICLES: u32;
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let me = particles[slot];
    particles[slot].position = drifted(me, velocity_of(me));
}
