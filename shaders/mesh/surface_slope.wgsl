// The half kick of a particle by the slope of the surface, from the polynomial that the splines make of it in a cell.
override KICK_X: f32; // velocity units per slope in cells
override KICK_Y: f32;
override VELOCITY_LIMIT: i32; // beyond which a velocity, or the displacement in a step, leaves the range of its integers

// Failures are gathered and raised once, when all particles of an invocation are done.
var<private> failures_of_motion: u32;

// The coefficients of xᵃ yᵇ in a cell, from the surface on its nodes.
fn surface_of(nodes: Square) -> Square { return transpose(SPLINE) * nodes * SPLINE; }
fn surface_in_cell(column: u32, row: u32) -> Square { return surface_of(nodes_of(column, row)); }
fn half_kick(polynomial: Square, x: f32, y: f32) -> vec2<i32> {
    return vec2<i32>(round(vec2<f32>(KICK_X, KICK_Y) * gradient(polynomial, x, y)));
}

// Slot mesh/surface: `surface_at` is what drives the particles on a node, `depth_in_cell` the depth on the node of a cell,
// given the surface on the nodes under its splines. Default: the smoothed depth. The plan chooses `bath` if there is one.
fn surface_at(node: u32) -> f32 { return depths[node]; }
fn depth_in_cell(cell: u32, nodes: Square) -> f32 { return nodes[NODES_BEFORE][NODES_BEFORE]; }
