// Particles in order of their cells, sorted anew every step: for any crowd.
@group(0) @binding(2) var<storage, read_write> sorted: array<Water>;

fn first_of(cell: u32) -> u32 { return cells[cell]; }
fn end_of(cell: u32) -> u32 { return cells[cell + 1u]; }
fn stored(index: u32) -> Water { return sorted[index]; }
