// Spreads the rounded masses of a cell over the nodes of splines of order 2; what is left of the total goes to one node.

fn spread_masses(cell: u32, weights: Square, total: i32, too_much: bool) {
    let count = CELLS_X * CELLS_Y;
    let share0 = IntegerPowers(round(weights[0]));
    let share1 = IntegerPowers(round(weights[1]));
    let share2 = IntegerPowers(round(weights[2]));
    let given = share0 + share1 + share2;
    let left = total - (given.x + given.y + given.z);
    contributions[0u * count + cell] = share0.x;
    contributions[1u * count + cell] = share0.y;
    contributions[2u * count + cell] = share0.z;
    contributions[3u * count + cell] = share1.x;
    contributions[4u * count + cell] = select(share1.y + left, TOO_MUCH, too_much);
    contributions[5u * count + cell] = share1.z;
    contributions[6u * count + cell] = share2.x;
    contributions[7u * count + cell] = share2.y;
    contributions[8u * count + cell] = share2.z;
}
