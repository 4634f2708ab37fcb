// The order of cells: where the particle lies that is the first in it, the second, and so on.
var<storage, read_write> order: array<u32>;

fn in_order(number: u32) -> u32 { return order[number]; }
fn set_order(number: u32, index: u32) { order[number] = index; }
