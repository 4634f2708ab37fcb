// Moves tracers by one step, as the water around them.
override TRACERS: u32;
override CLOSES: u32; // 1 from before the closing kick
@group(0) @binding(19) var<storage, read_write> tracers: array<Water>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= TRACERS) { return; }
    var tracer = tracers[index];
    let x = place_along(tracer.position.x, CELLS_X);
    let y = place_along(tracer.position.y, CELLS_Y);
    let kick = half_kick(surface_in_cell(x.cell, y.cell), x.offset, y.offset);
    if (CLOSES == 1u && clock_closing() == 1) { tracer.velocity = closed(tracer.velocity, kick); }
    tracers[index] = opened(tracer, kick);
    raise(failures_of_motion);
}
