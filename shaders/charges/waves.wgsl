// The energy, virial and curvature of charges, wave by wave.
override CHARGE_WAVES: u32;   // waves that are kept
override CHARGE_SUMS: u32;    // 0 where all is summed, 1 for the motion, 2 for the configuration
override CHARGE_ENERGY: f32;  // energy of a wave per square of its amplitude and weight, over its quantum
override CHARGE_CURVATURE: f32; // its part of the Laplacian per square of a wave number, over its quantum
override CHARGE_WIDTH: f32;   // twice the square of the width of a charge
// Wave numbers of one wave in the box.
override WAVE_X: f32;
override WAVE_Y: f32;
override WAVE_Z: f32;

// Adds up the waves of charges. One invocation every so many waves; reads `waves` and `charge_energies`, writes rows of `partial_sums`.
// For a wave of number k and energy u the virial is u (1 - 2k²σ²), and a charge by itself has been counted.
@compute @workgroup_size(WORKGROUP)
fn report_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    for (var index = group * WORKGROUP + lane; index < CHARGE_WAVES; index += GROUPS * WORKGROUP) {
        let along_x = index % WAVE_COLUMNS;
        let y = index / WAVE_COLUMNS % MESH_HEIGHT;
        let z = index / (WAVE_COLUMNS * MESH_HEIGHT);
        let along_y = min(y, MESH_HEIGHT - y);
        let along_z = min(z, MESH_DEPTH - z);
        let weight = charge_energies[(along_y * (MESH_DEPTH / 2u + 1u) + along_z) * WAVE_COLUMNS + along_x];
        let amplitude = wave_at(index);
        // Waves beyond the middle along x are not kept.
        let alike = select(2.0, 1.0, along_x == 0u || along_x == WAVE_COLUMNS - 1u);
        let energy = alike * weight * (amplitude.x * amplitude.x + amplitude.y * amplitude.y) * CHARGE_ENERGY;
        let number = vec3<f32>(vec3<u32>(along_x, along_y, along_z)) * vec3<f32>(WAVE_X, WAVE_Y, WAVE_Z);
        let square = dot(number, number);
        let virial = sum64_of_signed(energy * (1.0 - CHARGE_WIDTH * square));
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
