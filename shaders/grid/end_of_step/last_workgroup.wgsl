// The last workgroup to finish begins the next step and finds where its cells begin: a kernel for that would cost software
// adapters, which wake their threads for every kernel, as much as a hundred particles a thread. For workgroups of one subgroup of
// eight lanes.

fn end_step(lane: u32) {
    // What others have counted is visible once they are done: on processors every atomic addition orders what is before and after
    // it. A barrier would have the adapter keep the kernel's variables in memory, which makes all of it slower by a tenth.
    var done = 0u;
    if (lane == 0u) { done = atomicAdd(&workgroups_done, 1u) + 1u; }
    for (var last = subgroupShuffle(done, 0u) == SHARES; last; last = false) {
        if (lane == 0u) {
            atomicStore(&workgroups_done, 0u);
            begin_step();
        }
        scan_all_rows(lane);
    }
}
