// Tracers: particles without mass that the water carries.
override TRACERS: u32;
override FIRST_TRACER: u32;

// Moves tracers by one step, like the water around them. One invocation a tracer; updates `tracers`.
@compute @workgroup_size(WORKGROUP)
fn push_tracers(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
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

// Brings tracers to the report point. One invocation a tracer; updates `tracers`.
@compute @workgroup_size(WORKGROUP)
fn report_tracers(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= TRACERS || clock_closing() == 0) { return; }
    let tracer = tracers[index];
    let x = place_along(tracer.position.x, CELLS_X);
    let y = place_along(tracer.position.y, CELLS_Y);
    let kick = half_kick(surface_in_cell(x.cell, y.cell), x.offset, y.offset);
    tracers[index].velocity = closed(tracer.velocity, kick);
}

// Appends a row with the positions and velocities of all tracers by id, headed by the step, to `samples`. One workgroup; a lane
// copies every 64th tracer.
@compute @workgroup_size(64)
fn record_tracers(@builtin(local_invocation_index) lane: u32) {
    let row = 1u + samples[0].x * (2u * TRACERS + 1u);
    for (var index = lane; index < TRACERS; index += 64u) {
        let tracer = tracers[index];
        let place = row + 1u + 2u * (tracer.id - FIRST_TRACER);
        samples[place] = tracer.position;
        samples[place + 1u] = bitcast<vec2<u32>>(tracer.velocity);
    }
    storageBarrier();
    if (lane == 0u) {
        samples[row] = control.step;
        samples[0] += vec2<u32>(1u);
    }
}
