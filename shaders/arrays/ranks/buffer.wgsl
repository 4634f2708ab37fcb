// Place of each particle in its cell.
var<storage, read_write> ranks: array<u32>;

fn rank_of(index: u32) -> u32 { return ranks[index]; }
fn put_rank(index: u32, rank: u32) { ranks[index] = rank; }
