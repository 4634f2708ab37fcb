// Begins a step: the clock, the key of its random words, and whether neighbours have to be listed again, which takes the
// kernels of the list or leaves them without workgroups.
override CONDITIONAL: u32; // kernels that depend on it
// Workgroups of each such kernel, x, y, z: first as they are, then as they are to be in this step.
@group(0) @binding(38) var<storage, read_write> demands: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    let demanded = atomicLoad(&control.demand) != 0u;
    for (var word = lane; word < 3u * CONDITIONAL; word += 64u) {
        demands[3u * CONDITIONAL + word] = select(0u, demands[word], demanded);
    }
    storageBarrier();
    if (lane == 0u) {
        atomicStore(&control.demand, 0u);
        begin_step();
    }
}
