// Dispatches share the work, as many shares each: systems that watch over their displays end what takes an adapter seconds.
override SHARES: u32; // of a dispatch
@group(0) @binding(50) var<storage, read_write> dispatches_done: u32;

// A folded dispatch has a few workgroups too many: no row is theirs.
fn share_of(group: u32) -> u32 {
    return select(0xffffffffu, dispatches_done * SHARES + group, group < SHARES);
}
