// The momentum that particles carry across, and the virials that a report has left of them.
fn add_layered_stress(entry: u32, id: u32, p: vec3<f32>, v: vec3<f32>) {
    let carried = array<f32, 6>(p.x * v.x, p.y * v.y, p.z * v.z, p.x * v.y, p.x * v.z, p.y * v.z);
    for (var index = 0u; index < 6u; index++) {
        add_global(entry + index, sum64_of_signed(carried[index] * LAYERED_KINETIC));
        let first = 12u * id + index;
        let conservative = sum64_of_i32(reported_stresses[first + CONSERVATIVE]);
        add_global(entry + 6u + index, sum64_add(conservative, sum64_of_i32(reported_stresses[first + FRICTIONAL])));
    }
}
