// Dispatches share the work, as many shares each: systems that watch over their displays end what takes an adapter seconds.
var<storage, read_write> dispatches_done: u32;

// A folded dispatch has a few workgroups too many: no row is theirs.
fn share_of(group: u32) -> u32 {
    return select(0xffffffffu, dispatches_done * SHARES + group, group < SHARES);
}

// Goes on to the next of the dispatches that share the work, or from the last to the first.
override DISPATCHES: u32;

@compute @workgroup_size(1)
fn next_dispatch() { dispatches_done = (dispatches_done + 1u) % DISPATCHES; }
