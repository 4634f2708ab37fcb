// Goes on to the next of the dispatches that share the work, or from the last to the first.
override DISPATCHES: u32;
@group(0) @binding(50) var<storage, read_write> dispatches_done: u32;

@compute @workgroup_size(1)
fn main() { dispatches_done = (dispatches_done + 1u) % DISPATCHES; }
