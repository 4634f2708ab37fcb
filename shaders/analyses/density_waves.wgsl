// Amplitudes of density waves, from which the structure factor follows.
//
// Slot analyses/of_wave: the particles, by id, that a wave is summed over. The plan chooses `species` where waves have one. Default: all.
override WAVE_PARTS: u32; // workgroups that share the particles of a wave

// Sums cosine and sine of the phase of a wave over its particles: one workgroup a wave of `wave_vectors` and a part of the particles, by id. A
// wave has the wave vector in waves along each axis of the box, so that its phase is exact, and a species. Writes a row of `partial_sums`, in
// 2^-24.
@compute @workgroup_size(WORKGROUP)
fn sum_density_waves(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let wave = wave_vectors[min(group / WAVE_PARTS, arrayLength(&wave_vectors) - 1u)];
    var cosine = Sum64(0u);
    var sine = Sum64(0u);
    for (var id = (group % WAVE_PARTS) * WORKGROUP + lane; id < PARTICLES; id += WORKGROUP * WAVE_PARTS) {
        if (!is_of_wave(id, wave.w)) { continue; }
        let along = vec3<u32>(wave.xyz) * stored_position(id).xyz;
        let turns = f32(bitcast<i32>(along.x + along.y + along.z)) * 2.3283064e-10; // 2^-32
        cosine = sum64_add(cosine, sum64_of_signed(cosine_of_turns(turns) * 16777216.0));
        sine = sum64_add(sine, sum64_of_signed(sine_of_turns(turns) * 16777216.0));
    }
    reduce_quantity(group, lane, 0u, cosine);
    reduce_quantity(group, lane, 1u, sine);
    report_turns(workgroup.x >> 16u);
}

fn is_of_wave(id: u32, species: i32) -> bool { return true; }
