// The second half of a drift that a report has interrupted.
override PARTICLES: u32;
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    let particle = particles[index];
    let fraction = fraction_of(particle.position) + unsigned(half_drift_steps(particle.momentum));
    particles[index].position = position_word(fraction, particle.position.w);
    put_rank(index, atomicAdd(&counts[row_of(fraction) * CELLS_X + column_of(fraction)], 1u));
}
