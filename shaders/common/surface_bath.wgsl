// The smoothed depth and the bath drive the particles.
@group(0) @binding(13) var<storage, read_write> depths: array<f32>;  // deviation of the smoothed depth from 1
@group(0) @binding(20) var<storage, read_write> surface: array<f32>; // the same with the bath
fn surface_at(node: u32) -> f32 { return surface[node]; }
// The depth on the node of a cell.
fn depth_in_cell(cell: u32, nodes: Square) -> f32 { return depths[cell]; }
