// Splines of third order.

// == mesh/spline/cubic
// Cubic splines: the nodes of a cell and one more on either side.
alias Powers = vec4<f32>;
alias IntegerPowers = vec4<i32>;
alias Square = mat4x4<f32>;
const WIDTH: u32 = 4u;
const NODES_BEFORE: u32 = 1u;
const CELL_SHIFT: u32 = 0u;
// Column a: what the power a of the place in the cell adds to the weight of each node.
const SPLINE = Square(
    0.16666667, 0.6666667, 0.16666667, 0.0,
    -0.5, 0.0, 0.5, 0.0,
    0.5, -1.0, 0.5, 0.0,
    -0.16666667, 0.5, -0.5, 0.16666667,
);

fn powers(x: f32) -> Powers { return Powers(1.0, x, x * x, x * x * x); }
// The gradient of Σ p[a][b] xᵃ yᵇ.
fn gradient(p: Square, x: f32, y: f32) -> vec2<f32> {
    let along_x = p[1] + x * (2.0 * p[2] + 3.0 * x * p[3]);
    let along_y = p[0] + x * (p[1] + x * (p[2] + x * p[3]));
    return vec2<f32>(
        along_x.x + y * (along_x.y + y * (along_x.z + y * along_x.w)),
        along_y.y + y * (2.0 * along_y.z + 3.0 * y * along_y.w),
    );
}

// Moments of a cell for splines of order 3, written out: loops that are kept as loops cost far more than they do.
alias Moments = array<IntegerPowers, WIDTH>;

fn add_moments(moments: ptr<function, Moments>, x: f32, first: Powers) {
    var terms = first;
    (*moments)[0] += bitcast<IntegerPowers>(terms + MASS_ROUNDING);
    terms *= x;
    (*moments)[1] += bitcast<IntegerPowers>(terms + MASS_ROUNDING);
    terms *= x;
    (*moments)[2] += bitcast<IntegerPowers>(terms + MASS_ROUNDING);
    terms *= x;
    (*moments)[3] += bitcast<IntegerPowers>(terms + MASS_ROUNDING);
}
fn without_rounding(moments: Moments, count: i32) -> Moments {
    let offset = count * bitcast<i32>(MASS_ROUNDING);
    return Moments(moments[0] - offset, moments[1] - offset, moments[2] - offset, moments[3] - offset);
}
// The masses of the nodes, [along x][along y].
fn node_weights(moments: Moments) -> Square {
    return SPLINE * Square(Powers(moments[0]), Powers(moments[1]), Powers(moments[2]), Powers(moments[3])) * transpose(SPLINE);
}

// == mesh/nodes/cubic
// The surface under splines of order 3, written out: loops that are kept as loops cost far more.

// The surface on the nodes of a cell, [along x][along y].
fn nodes_of(column: u32, row: u32) -> Square {
    let k = vec4<u32>(node_along(column, 0u, CELLS_X), node_along(column, 1u, CELLS_X), node_along(column, 2u, CELLS_X),
        node_along(column, 3u, CELLS_X));
    let l = vec4<u32>(node_along(row, 0u, CELLS_Y), node_along(row, 1u, CELLS_Y), node_along(row, 2u, CELLS_Y),
        node_along(row, 3u, CELLS_Y)) * CELLS_X;
    return Square(
        surface_at(k[0] + l[0]), surface_at(k[0] + l[1]), surface_at(k[0] + l[2]), surface_at(k[0] + l[3]),
        surface_at(k[1] + l[0]), surface_at(k[1] + l[1]), surface_at(k[1] + l[2]), surface_at(k[1] + l[3]),
        surface_at(k[2] + l[0]), surface_at(k[2] + l[1]), surface_at(k[2] + l[2]), surface_at(k[2] + l[3]),
        surface_at(k[3] + l[0]), surface_at(k[3] + l[1]), surface_at(k[3] + l[2]), surface_at(k[3] + l[3]),
    );
}

// == mesh/spread/cubic
// Spreads the rounded masses of a cell over the nodes of splines of order 3; what is left of the total goes to one node.

fn spread_masses(cell: u32, weights: Square, total: i32, too_much: bool) {
    let count = CELLS_X * CELLS_Y;
    let share0 = IntegerPowers(round(weights[0]));
    let share1 = IntegerPowers(round(weights[1]));
    let share2 = IntegerPowers(round(weights[2]));
    let share3 = IntegerPowers(round(weights[3]));
    let given = share0 + share1 + share2 + share3;
    let left = total - (given.x + given.y + given.z + given.w);
    contributions[0u * count + cell] = share0.x;
    contributions[1u * count + cell] = share0.y;
    contributions[2u * count + cell] = share0.z;
    contributions[3u * count + cell] = share0.w;
    contributions[4u * count + cell] = share1.x;
    contributions[5u * count + cell] = select(share1.y + left, TOO_MUCH, too_much);
    contributions[6u * count + cell] = share1.z;
    contributions[7u * count + cell] = share1.w;
    contributions[8u * count + cell] = share2.x;
    contributions[9u * count + cell] = share2.y;
    contributions[10u * count + cell] = share2.z;
    contributions[11u * count + cell] = share2.w;
    contributions[12u * count + cell] = share3.x;
    contributions[13u * count + cell] = share3.y;
    contributions[14u * count + cell] = share3.z;
    contributions[15u * count + cell] = share3.w;
}
