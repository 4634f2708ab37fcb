// What the passes over pairs of a split step have in common with baths that are not of pairs: those relax the momenta
// of sorted particles between the closing kick and the relaxation of pairs, in place.

// Gives a sorted particle another momentum, and its copy in the frame of its row too. The species' word stays, with
// what the first pass has left in it.
fn replace_momentum(index: u32, me: Particle, momentum: Steps) {
    keep_momentum_of_all(row_of(fraction_of(me.position)), index, me, momentum_word(momentum, me.momentum.w));
}
fn keep_momentum_of_all(row: u32, index: u32, me: Particle, word: vec4<i32>) {
    keep_momentum(index, word);
    let copy = copy_in_frame(row, index, me);
    if (copy != index) { keep_momentum(copy, word); }
}
