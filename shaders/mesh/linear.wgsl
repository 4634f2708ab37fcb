// Splines of first order: what the mesh has of a particle.

// == mesh/spline/linear
// Linear splines: the two nodes of a cell.
alias Powers = vec2<f32>;
alias IntegerPowers = vec2<i32>;
alias Square = mat2x2<f32>;
const WIDTH: u32 = 2u;
const NODES_BEFORE: u32 = 0u;
const CELL_SHIFT: u32 = 0u;
// Column a: what the power a of the place in the cell adds to the weight of each node.
const SPLINE = Square(1.0, 0.0, -1.0, 1.0);

fn powers(x: f32) -> Powers { return Powers(1.0, x); }
// The gradient of Σ p[a][b] xᵃ yᵇ.
fn gradient(p: Square, x: f32, y: f32) -> vec2<f32> {
    return vec2<f32>(p[1].x + y * p[1].y, p[0].y + x * p[1].y);
}

// Moments of a cell for splines of order 1, written out: loops that are kept as loops cost far more than they do.
alias Moments = array<IntegerPowers, WIDTH>;

fn add_moments(moments: ptr<function, Moments>, x: f32, first: Powers) {
    var terms = first;
    (*moments)[0] += bitcast<IntegerPowers>(terms + MASS_ROUNDING);
    terms *= x;
    (*moments)[1] += bitcast<IntegerPowers>(terms + MASS_ROUNDING);
}
fn without_rounding(moments: Moments, count: i32) -> Moments {
    let offset = count * bitcast<i32>(MASS_ROUNDING);
    return Moments(moments[0] - offset, moments[1] - offset);
}
// The masses of the nodes, [along x][along y].
fn node_weights(moments: Moments) -> Square {
    return SPLINE * Square(Powers(moments[0]), Powers(moments[1])) * transpose(SPLINE);
}

// == mesh/nodes/linear
// The surface under splines of order 1, written out: loops that are kept as loops cost far more.

// The surface on the nodes of a cell, [along x][along y].
fn nodes_of(column: u32, row: u32) -> Square {
    let k = vec2<u32>(node_along(column, 0u, CELLS_X), node_along(column, 1u, CELLS_X));
    let l = vec2<u32>(node_along(row, 0u, CELLS_Y), node_along(row, 1u, CELLS_Y)) * CELLS_X;
    return Square(
        surface_at(k[0] + l[0]), surface_at(k[0] + l[1]),
        surface_at(k[1] + l[0]), surface_at(k[1] + l[1]),
    );
}

// == mesh/spread/linear
// Spreads the rounded masses of a cell over the nodes of splines of order 1; what is left of the total goes to one node.

fn spread_masses(cell: u32, weights: Square, total: i32, too_much: bool) {
    let count = CELLS_X * CELLS_Y;
    let share0 = IntegerPowers(round(weights[0]));
    let share1 = IntegerPowers(round(weights[1]));
    let given = share0 + share1;
    let left = total - (given.x + given.y);
    contributions[0u * count + cell] = select(share0.x + left, TOO_MUCH, too_much);
    contributions[1u * count + cell] = share0.y;
    contributions[2u * count + cell] = share1.x;
    contributions[3u * count + cell] = share1.y;
}
