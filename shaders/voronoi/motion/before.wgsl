// Cells drift with the velocity that they had before they took up anything.
fn moved(cell: Particle, before: Vector) -> vec4<u32> { return drifted(cell, before); }
