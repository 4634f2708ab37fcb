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
