// Appends a row with the positions and velocities of all tracers by id, headed by the step, to the samples of a batch.
override TRACERS: u32;
override FIRST_TRACER: u32;
@group(0) @binding(19) var<storage, read_write> tracers: array<Water>;
@group(0) @binding(10) var<storage, read_write> samples: array<vec2<u32>>; // rows in the batch and in all, then the rows

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
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
