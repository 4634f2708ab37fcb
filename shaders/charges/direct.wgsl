// Waves of charges, each summed by itself with exact phases, in place of a mesh: for few charges in small boxes.
override WAVE_UNIT: f32; // units of the sums of a wave in an elementary charge
const WAVE_SHARE: u32 = 64u; // waves that an invocation gathers impulses from

// Cosine and sine of the phase of a wave at a place.
fn phase_at(wave: vec4<u32>, place: vec4<u32>) -> vec2<f32> {
    let along = wave.xyz * place.xyz;
    let turns = f32(bitcast<i32>(along.x + along.y + along.z)) * 2.3283064e-10; // 2^-32
    return vec2<f32>(cosine_of_turns(turns), sine_of_turns(turns));
}
fn wave_sum_at(wave: u32) -> vec2<f32> {
    return vec2<f32>(f32(bitcast<i32>(wave_sums[2u * wave].x)), f32(bitcast<i32>(wave_sums[2u * wave + 1u].x)));
}

// Sums charges times cosine and sine of the phase of a wave, in integers. One workgroup a wave of `listed_waves`; reads `charged`, `slots` and
// particles, writes a row of `partial_sums`, clears `charge_impulses`.
@compute @workgroup_size(WORKGROUP)
fn sum_charge_waves(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    if (group * WORKGROUP + lane < 3u) { charge_impulses[group * WORKGROUP + lane] = 0; }
    if (group >= CHARGE_WAVES) { return; }
    let wave = listed_waves[group];
    var cosine = Sum64(0u);
    var sine = Sum64(0u);
    for (var rank = lane; rank < CHARGED; rank += WORKGROUP) {
        let word = charged[rank];
        let slot = slots[word.x];
        // A charge belongs to one of several ranks.
        if (!is_known(slot) || !is_own(particle_at(slot).position)) { continue; }
        let parts = bitcast<f32>(word.y) * WAVE_UNIT * phase_at(wave, particle_at(slot).position);
        cosine = sum64_add(cosine, sum64_of_i32(i32(round(parts.x))));
        sine = sum64_add(sine, sum64_of_i32(i32(round(parts.y))));
    }
    reduce_quantity(group, lane, 0u, cosine);
    reduce_quantity(group, lane, 1u, sine);
}

// Gathers the impulses of waves on charges. One invocation some waves and a charge; reads `charged`, `slots`, particles, `listed_waves` and
// `wave_sums`, adds to `kicks` and `charge_impulses`.
@compute @workgroup_size(WORKGROUP)
fn pull_by_waves(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    let shares = (CHARGE_WAVES + WAVE_SHARE - 1u) / WAVE_SHARE;
    if (index >= CHARGED * shares) { return; }
    let word = charged[index / shares];
    let slot = slots[word.x];
    if (!is_known(slot)) { return; }
    let position = particle_at(slot).position;
    let first = index % shares * WAVE_SHARE;
    var sum = vec3<f32>(0.0);
    for (var wave = first; wave < min(first + WAVE_SHARE, CHARGE_WAVES); wave++) {
        let listed = listed_waves[wave];
        let here = phase_at(listed, position);
        let all = wave_sum_at(wave);
        sum += bitcast<f32>(listed.w) * (all.x * here.y - all.y * here.x) * vec3<f32>(bitcast<vec3<i32>>(listed.xyz));
    }
    let impulse = bitcast<f32>(word.y) * vec3<f32>(CHARGE_IMPULSE_X, CHARGE_IMPULSE_Y, CHARGE_IMPULSE_Z) * sum;
    let possible = all_within(impulse, IMPULSE_LIMIT);
    raise(select(FAILURE_IMPULSE, 0u, possible));
    let kick = select(Steps(0), Steps(round(impulse)), possible);
    let own_kick = select(Steps(0), kick, is_own(position));
    atomicAdd(&charge_impulses[0], own_kick.x);
    atomicAdd(&charge_impulses[1], own_kick.y);
    atomicAdd(&charge_impulses[2], own_kick.z);
    add_kick(slot, kick);
    note_charge(slot, kick);
}

// == charges/wave/listed
// A wave of charges that is summed by itself, for it and for its opposite.
fn charge_wave(index: u32) -> ChargeWave {
    let listed = listed_waves[index];
    let sum = wave_sum_at(index);
    let number = vec3<f32>(bitcast<vec3<i32>>(listed.xyz)) * vec3<f32>(WAVE_X, WAVE_Y, WAVE_Z);
    return ChargeWave(bitcast<f32>(listed.w) * dot(sum, sum), number, vec3<bool>(false));
}
