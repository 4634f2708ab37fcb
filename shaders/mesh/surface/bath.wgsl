// The smoothed depth and the bath together drive the particles.
fn surface_at(node: u32) -> f32 { return surface[node]; }

// The depth on the node of a cell, which the surface does not give.
fn depth_in_cell(cell: u32, nodes: Square) -> f32 { return depths[cell]; }
