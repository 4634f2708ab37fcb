// Cells drift with the velocity that they have after the exchange.
fn moved_place(cell: Particle, before: Vector) -> vec4<u32> { return drifted_place(cell, velocity_of(cell)); }
