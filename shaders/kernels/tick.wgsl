// Begins a step of a scene without a list of neighbours.
@compute @workgroup_size(1)
fn main() { begin_step(); }
