// The longest transverse momentum waves, from whose decay the viscosity follows.

// For every axis of the box, sums the momenta across it weighted with the cosine and the sine of the position along it. One
// invocation a particle, by id; writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn sum_transverse_modes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let id = group * WORKGROUP + lane;
    var quantity = 0u;
    for (var axis = 0u; axis < DIMENSION; axis++) {
        for (var across = 1u; across < DIMENSION; across++) {
            var cosine = Sum64(0u);
            var sine = Sum64(0u);
            if (id < PARTICLES) {
                let particle = stored_particle(id);
                let turns = f32(bitcast<i32>(particle.position[axis])) * 2.3283064e-10; // 2^-32
                let momentum = f32(particle.momentum[(axis + across) % DIMENSION]);
                cosine = sum64_of_f32(momentum * cosine_of_turns(turns));
                sine = sum64_of_f32(momentum * sine_of_turns(turns));
            }
            reduce_quantity(group, lane, quantity, cosine);
            reduce_quantity(group, lane, quantity + 1u, sine);
            quantity += 2u;
        }
    }
}
