// Moves the particles of a cell by one step, from before the closing kick or, after a report, from the report point.
override LEAST_DEPTH: f32; // as a deviation from the mean

fn visit_cell(cell: u32) {
    let nodes = nodes_of(cell % CELLS_X, cell / CELLS_X);
    // A negative depth, beyond what rounding makes of zero, has no waves, only instability; nor has NaN.
    let depth = depth_in_cell(cell, nodes);
    raise_at(select(FAILURE_DEPTH, 0u, is_number(depth) && depth > LEAST_DEPTH), cell);
    let polynomial = surface_of(nodes);
    let closes = CLOSES == 1u && clock_closing() == 1;
    let bin = opened_bin(cell);
    begin_moving(cell);
    for (var k = 0u; k < bin.count; k++) {
        let index = place_in(bin, k);
        var particle = load_water(index);
        let x = place_along(particle.position.x, CELLS_X).offset;
        let y = place_along(particle.position.y, CELLS_Y).offset;
        let kick = half_kick(polynomial, x, y);
        if (closes) { particle.velocity = closed(particle.velocity, kick); }
        store_moved(cell, bin, index, opened(particle, kick));
    }
    end_moving(cell, bin);
    raise(failures_of_motion);
}
