// The drift of a cell, rounded once to fractions of the box, and no further than a few widths of a cell.
override DRIFT_STEP: f32;
override DISPLACEMENT_LIMIT: f32;

fn drifted(cell: Particle, velocity: Vector) -> vec4<u32> {
    let way = velocity * DRIFT_STEP;
    raise(select(FAILURE_DISPLACEMENT, 0u, all_within(way, DISPLACEMENT_LIMIT)));
    let fraction = fraction_of(cell.position) + unsigned(Steps(round(way / unit_lengths())));
    return vec4<u32>(fraction, cell.position.zw);
}
