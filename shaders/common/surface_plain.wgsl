// The smoothed depth drives the particles.
@group(0) @binding(13) var<storage, read_write> depths: array<f32>; // deviation of the smoothed depth from 1
fn surface_at(node: u32) -> f32 { return depths[node]; }
// The depth on the node of a cell, given the surface on the nodes under its splines.
fn depth_in_cell(cell: u32, nodes: Square) -> f32 { return nodes[NODES_BEFORE][NODES_BEFORE]; }
