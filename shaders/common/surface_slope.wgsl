// The half kick of a particle by the slope of the surface, from the polynomial that the splines make of it in a cell.
override KICK_X: f32; // velocity units per slope in cells
override KICK_Y: f32;

// The coefficients of xᵃ yᵇ in a cell, from the surface on its nodes.
fn surface_of(nodes: Square) -> Square { return transpose(SPLINE) * nodes * SPLINE; }
fn surface_in_cell(column: u32, row: u32) -> Square { return surface_of(nodes_of(column, row)); }
fn half_kick(polynomial: Square, x: f32, y: f32) -> vec2<i32> {
    return vec2<i32>(round(vec2<f32>(KICK_X, KICK_Y) * gradient(polynomial, x, y)));
}
