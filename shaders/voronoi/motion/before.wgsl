// Cells drift with the velocity that they had before the exchange.
fn moved(cell: Particle, before: Vector) -> vec4<u32> { return drifted(cell, before); }
