// What the passes over pairs of a split step have in common with baths that are not of pairs: those relax the momenta
// of sorted particles between the closing kick and the relaxation of pairs, in place.

// Gives a sorted particle another momentum, and its copy in the frame of its row too. The species' word stays, with
// what the first pass has left in it.
fn replace_momentum(index: u32, me: Particle, momentum: Steps) {
    let word = momentum_word(momentum, me.momentum.w);
    keep_momentum(index, word);
    let fraction = fraction_of(me.position);
    let row = row_of(fraction);
    let column = column_of(fraction);
    if (frame() == 1u && (column == 0u || column == CELLS_X - 1u)) {
        let copies = cell_at(row * row_width() + select(0u, CELLS_X + 1u, column == 0u));
        keep_momentum(copies + index - cell_at(cell_index(row, column)), word);
    }
}
