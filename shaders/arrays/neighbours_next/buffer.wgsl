// The list that is being made: the number of a particle's pairs, then its pairs, one row of particles after the other.
var<storage, read_write> neighbours_next: array<u32>;

fn next_neighbour_word(index: u32) -> u32 { return neighbours_next[index]; }
fn put_next_neighbour_word(index: u32, word: u32) { neighbours_next[index] = word; }
