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
