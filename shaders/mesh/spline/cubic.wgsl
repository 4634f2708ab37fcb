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
