// The smoothed depth drives the particles.
@group(0) @binding(13) var<storage, read_write> depths: array<f32>; // deviation of the smoothed depth from 1
fn surface_at(node: u32) -> f32 { return depths[node]; }
