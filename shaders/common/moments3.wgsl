// Moments of a cell for splines of order 3, written out: loops that are kept as loops cost far more than they do.
alias Moments = array<IntegerPowers, WIDTH>;

fn add_moments(moments: ptr<function, Moments>, x: f32, first: Powers) {
    var terms = first;
    (*moments)[0] += bitcast<IntegerPowers>(terms + ROUNDING);
    terms *= x;
    (*moments)[1] += bitcast<IntegerPowers>(terms + ROUNDING);
    terms *= x;
    (*moments)[2] += bitcast<IntegerPowers>(terms + ROUNDING);
    terms *= x;
    (*moments)[3] += bitcast<IntegerPowers>(terms + ROUNDING);
}
fn without_rounding(moments: Moments, count: i32) -> Moments {
    let offset = count * bitcast<i32>(ROUNDING);
    return Moments(moments[0] - offset, moments[1] - offset, moments[2] - offset, moments[3] - offset);
}
// The masses of the nodes, [along x][along y].
fn node_weights(moments: Moments) -> Square {
    return SPLINE * Square(Powers(moments[0]), Powers(moments[1]), Powers(moments[2]), Powers(moments[3])) * transpose(SPLINE);
}
// Hands out the rounded masses, and what is left of the total to one node.
fn hand_out(cell: u32, weights: Square, total: i32) {
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
    contributions[5u * count + cell] = share1.y + left;
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
