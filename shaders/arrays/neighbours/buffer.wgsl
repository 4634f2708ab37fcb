// The number of a particle's pairs, then its pairs: one row of particles after the other.
var<storage, read_write> neighbours: array<u32>;

fn neighbour_word(index: u32) -> u32 { return neighbours[index]; }
fn put_neighbour_word(index: u32, word: u32) { neighbours[index] = word; }
