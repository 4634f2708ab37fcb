// Moments of a cell for splines of order 2, written out: loops that are kept as loops cost far more than they do.
alias Moments = array<IntegerPowers, WIDTH>;

fn add_moments(moments: ptr<function, Moments>, x: f32, first: Powers) {
    var terms = first;
    (*moments)[0] += bitcast<IntegerPowers>(terms + ROUNDING);
    terms *= x;
    (*moments)[1] += bitcast<IntegerPowers>(terms + ROUNDING);
    terms *= x;
    (*moments)[2] += bitcast<IntegerPowers>(terms + ROUNDING);
}
fn without_rounding(moments: Moments, count: i32) -> Moments {
    let offset = count * bitcast<i32>(ROUNDING);
    return Moments(moments[0] - offset, moments[1] - offset, moments[2] - offset);
}
// The masses of the nodes, [along x][along y].
fn node_weights(moments: Moments) -> Square {
    return SPLINE * Square(Powers(moments[0]), Powers(moments[1]), Powers(moments[2])) * transpose(SPLINE);
}
