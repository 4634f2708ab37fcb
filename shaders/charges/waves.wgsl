// The energy, virial, curvature and stress of charges, wave by wave.
override CHARGE_WAVES: u32;   // waves that are kept
override CHARGE_SUMS: u32;    // 0 where all is summed, 1 for the motion, 2 for the configuration
override CHARGE_ENERGY: f32;  // energy of a wave per square of its amplitude and weight, over its quantum
override CHARGE_CURVATURE: f32; // its part of the Laplacian per square of a wave number, over its quantum
override CHARGE_WIDTH: f32;   // twice the square of the width of a charge, for long waves
override CHARGE_DECREASE: f32; // by which it becomes less, per square of a wave number
override CHARGE_STRESS: f32;  // its part of the stress per square of its amplitude and weight, over the unit of a stress
// Wave numbers of one wave in the box.
override WAVE_X: f32;
override WAVE_Y: f32;
override WAVE_Z: f32;

// Twice the square of the width of a charge that waves of a number see.
fn seen_width(square: f32) -> f32 { return CHARGE_WIDTH / (1.0 + CHARGE_DECREASE * square); }

// A wave of charges.
struct ChargeWave {
    square: f32,       // of its amplitude, times its weight and the number of waves alike
    number: vec3<f32>, // its number along each axis; at the middle of an axis of either sign
    in_middle: vec3<bool>,
}

// Slot charges/wave, without a default: `charge_wave`, one of the waves. Variants of_mesh, listed (each summed by itself); the plan follows the
// scene.

// Adds up the waves of charges. One invocation every so many waves; reads `waves` and `charge_energies`, writes rows of `partial_sums`.
// For a wave of number k and energy u the virial is u (1 - 2k²σ²), σ being the width that the wave sees, and a charge by itself has been counted.
@compute @workgroup_size(WORKGROUP)
fn report_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    for (var index = group * WORKGROUP + lane; index < CHARGE_WAVES; index += GROUPS * WORKGROUP) {
        let wave = charge_wave(index);
        let energy = wave.square * CHARGE_ENERGY;
        let square = dot(wave.number, wave.number);
        let virial = sum64_of_signed(energy * (1.0 - seen_width(square) * square));
        if (CHARGE_SUMS != 2u) { total_add(SUM_VIRIAL, virial); }
        if (CHARGE_SUMS != 1u) {
            total_add(SUM_POTENTIAL_ENERGY, sum64_of_signed(energy));
            total_add(SUM_ELECTROSTATIC_ENERGY, sum64_of_signed(energy));
            total_add(SUM_CONSERVATIVE_VIRIAL, virial);
            total_add(SUM_CURVATURE, sum64_of_signed(-energy * square * CHARGE_CURVATURE));
        }
    }
    total_reduce(group, lane);
}

// Adds up the stress of the waves of charges, a symmetric tensor xx, yy, zz, xy, xz, yz: that of a wave of number k and energy u is u (δ - 2
// kk (1/k² + σ²)). One invocation every so many waves; reads `waves` and `charge_energies`, writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn stress_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    var sums = array<vec2<u32>, 6>();
    for (var index = group * WORKGROUP + lane; index < CHARGE_WAVES; index += GROUPS * WORKGROUP) {
        let wave = charge_wave(index);
        let energy = wave.square * CHARGE_STRESS;
        let square = dot(wave.number, wave.number);
        // That of all zeros has no energy.
        let pull = energy * (seen_width(square) + select(0.0, 2.0 / square, square > 0.0));
        let diagonal = energy - pull * wave.number * wave.number;
        // Waves in the middle are of both signs.
        let number = select(wave.number, vec3<f32>(0.0), wave.in_middle);
        let across = -pull * number.xxy * number.yzz;
        for (var axis = 0u; axis < 3u; axis++) {
            sums[axis] = sum64_add(sums[axis], sum64_of_signed(diagonal[axis]));
            sums[3u + axis] = sum64_add(sums[3u + axis], sum64_of_signed(across[axis]));
        }
    }
    for (var word = 0u; word < 6u; word++) { reduce_quantity(group, lane, word, sums[word]); }
}

// == charges/wave/of_mesh
// A wave of the transform of a mesh, of which those beyond the middle along x are not kept.
fn charge_wave(index: u32) -> ChargeWave {
    let along_x = index % WAVE_COLUMNS;
    let y = index / WAVE_COLUMNS % MESH_HEIGHT;
    let z = index / (WAVE_COLUMNS * MESH_HEIGHT);
    let along_y = min(y, MESH_HEIGHT - y);
    let along_z = min(z, MESH_DEPTH - z);
    let weight = charge_energies[(along_y * (MESH_DEPTH / 2u + 1u) + along_z) * WAVE_COLUMNS + along_x];
    let amplitude = wave_at(index);
    let alike = select(2.0, 1.0, along_x == 0u || along_x == WAVE_COLUMNS - 1u);
    let square = alike * weight * (amplitude.x * amplitude.x + amplitude.y * amplitude.y);
    let signs = vec3<f32>(1.0, select(1.0, -1.0, y > along_y), select(1.0, -1.0, z > along_z));
    let number = signs * vec3<f32>(vec3<u32>(along_x, along_y, along_z)) * vec3<f32>(WAVE_X, WAVE_Y, WAVE_Z);
    let in_middle = vec3<bool>(along_x == WAVE_COLUMNS - 1u, 2u * y == MESH_HEIGHT, 2u * z == MESH_DEPTH);
    return ChargeWave(square, number, in_middle);
}
