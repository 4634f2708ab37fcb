// Every cell has a bin: its particles at the bottom, those that arrive in a step from the top. What stays in its cell
// stays in its bin, so that no sort is needed; only a crowd in one cell does not fit.
override CAPACITY: u32;
@group(0) @binding(2) var<storage, read_write> bins: array<Water>;
@group(0) @binding(6) var<storage, read_write> residents: array<u32>; // particles of each cell when the step began

fn first_of(cell: u32) -> u32 { return cell * CAPACITY; }
fn end_of(cell: u32) -> u32 { return cell * CAPACITY + residents[cell]; }
fn stored(index: u32) -> Water { return bins[index]; }
