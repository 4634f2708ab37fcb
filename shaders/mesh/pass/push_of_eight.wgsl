// Moves the particles of eight cells by one step, eight at a time regardless of their cells, from before the closing kick or,
// after a report, from the report point.
override LEAST_DEPTH: f32; // as a deviation from the mean
var<private> dry_cell: u32 = NO_CELL; // the first whose depth is not positive

fn of_lane(polynomial: Square, lane: u32) -> Square {
    return Square(subgroupShuffle(polynomial[0], lane), subgroupShuffle(polynomial[1], lane),
        subgroupShuffle(polynomial[2], lane), subgroupShuffle(polynomial[3], lane));
}

fn visit_cell(cell: u32) {
    let nodes = nodes_of(cell % CELLS_X, cell / CELLS_X);
    // A negative depth, beyond what rounding makes of zero, has no waves, only instability; nor has NaN.
    let depth = depth_in_cell(cell, nodes);
    dry_cell = select(min(dry_cell, cell), dry_cell, is_number(depth) && depth > LEAST_DEPTH);
    let polynomial = surface_of(nodes);
    let closes = CLOSES == 1u && clock_closing() == 1;
    let bin = opened_bin(cell);
    let eight = opened_eight(bin);
    var first = 0u;
    loop { // left at its end: see pairs/clusters
        if (first < eight.count) {
            let index = place_in_eight(eight, bin, min(first + lane_of_eight, eight.count - 1u));
            var particle = load_water(index);
            let x = place_along(particle.position.x, CELLS_X);
            let y = place_along(particle.position.y, CELLS_Y).offset;
            let owner = x.cell & 7u;
            let kick = half_kick(of_lane(polynomial, owner), x.offset, y);
            if (closes) { particle.velocity = closed(particle.velocity, kick); }
            store_moved_of_eight(eight, bin, cell, owner, first, index, opened(particle, kick));
        }
        first += 8u;
        if (first >= eight.count) { break; }
    }
    end_moving_eight(eight, bin, cell);
}
// Once a strip: software adapters pay for every place in the program that raises, even if nothing fails.
fn end_strip(column: u32, row: u32) {
    raise_at(failures_of_motion | select(FAILURE_DEPTH, 0u, dry_cell == NO_CELL), dry_cell);
}
