// Several dispatches share the work, SHARES workgroups each: systems that guard their displays end what takes an adapter seconds.

// A folded dispatch has a few workgroups too many, which get no share.
fn share_of(group: u32) -> u32 {
    return select(0xffffffffu, dispatches_done * SHARES + group, group < SHARES);
}

override DISPATCHES: u32;

// Goes on to the next of the dispatches that share the work, or from the last to the first. One invocation.
@compute @workgroup_size(1)
fn next_dispatch() { dispatches_done = (dispatches_done + 1u) % DISPATCHES; }
