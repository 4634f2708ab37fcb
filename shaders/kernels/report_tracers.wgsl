// Brings tracers to the report point.
override TRACERS: u32;
@group(0) @binding(19) var<storage, read_write> tracers: array<Water>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= TRACERS || clock_closing() == 0) { return; }
    let tracer = tracers[index];
    let x = place_along(tracer.position.x, CELLS_X);
    let y = place_along(tracer.position.y, CELLS_Y);
    let kick = half_kick(surface_in_cell(x.cell, y.cell), x.offset, y.offset);
    tracers[index].velocity = closed(tracer.velocity, kick);
}
