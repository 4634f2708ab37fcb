// Cells drift with the velocity that they have after the exchange.
fn moved(cell: Particle, before: Vector) -> vec4<u32> { return drifted(cell, velocity_of(cell)); }
