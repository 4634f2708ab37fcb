// The report of shallow water: energies, momentum and mass.
override POTENTIAL: f32;      // energy per unit of mass and depth, over its quantum
override MOMENTUM: f32;       // product of mass and velocity, over its quantum

// Brings the particles of a cell to the report point, and sums what is observed of them and of the cell's node. One invocation
// a cell; updates the particles, writes `partial_sums`: kinetic energy, momentum, potential energy, bath energy, mass.
@compute @workgroup_size(WORKGROUP)
fn report_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let cell = group * WORKGROUP + lane;
    var kinetic = Sum64(0u);
    var momentum_x = Sum64(0u);
    var momentum_y = Sum64(0u);
    var potential = Sum64(0u);
    var bath = Sum64(0u);
    var on_node = Sum64(0u);
    if (cell < CELLS_X * CELLS_Y) {
        let polynomial = surface_in_cell(cell % CELLS_X, cell / CELLS_X);
        let bin = opened_bin(cell);
        for (var k = 0u; k < bin.count; k++) {
            let index = place_in(bin, k);
            var particle = load_water(index);
            if (clock_closing() == 1) {
                let x = place_along(particle.position.x, CELLS_X).offset;
                let y = place_along(particle.position.y, CELLS_Y).offset;
                particle.velocity = closed(particle.velocity, half_kick(polynomial, x, y));
            }
            store_water(index, particle);
            let v = vec2<f32>(particle.velocity);
            let mass = f32(particle.mass);
            kinetic = sum64_add(kinetic, sum64_of_f32(mass * (KINETIC * dot(v, v))));
            momentum_x = sum64_add(momentum_x, sum64_of_f32(MOMENTUM * mass * v.x));
            momentum_y = sum64_add(momentum_y, sum64_of_f32(MOMENTUM * mass * v.y));
        }
        on_node = Sum64(node_masses[cell], 0u);
        let deviation = f32(bitcast<i32>(on_node.x - MEAN_MASS));
        potential = sum64_of_f32(POTENTIAL * deviation * depths[cell]);
        // What drives the particles in addition to the depth is the bath.
        let s = surface_at(cell) - depths[cell];
        bath = sum64_of_f32(BATH_SQUARE * s * s);
    }
    report_turns(workgroup.x >> 16u);
    reduce_quantity(group, lane, SUM_KINETIC_ENERGY, kinetic);
    reduce_quantity(group, lane, SUM_MOMENTUM, momentum_x);
    reduce_quantity(group, lane, SUM_MOMENTUM + 1u, momentum_y);
    reduce_quantity(group, lane, SUM_POTENTIAL_ENERGY, potential);
    reduce_quantity(group, lane, SUM_BATH_SQUARE, bath);
    reduce_quantity(group, lane, SUM_MASS, on_node);
}
