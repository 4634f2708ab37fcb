// Cells drift with the velocity that they had before the exchange.
fn moved_place(cell: Particle, before: Vector) -> vec4<u32> { return drifted_place(cell, before); }
