// Cells drift once they have taken up what they got, with the velocity that they then have.
fn moved(cell: Particle, before: Vector) -> vec4<u32> { return drifted(cell, velocity_of(cell)); }
