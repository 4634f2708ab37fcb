// Particles in the order of their cells, which is found in every step, for any number in a cell. The particles themselves stay
// where they lie. `cells` says where each cell ends.

struct Bin { begin: u32, count: u32 }

fn opened_bin(cell: u32) -> Bin {
    let begin = select(cells[max(cell, 1u) - 1u], 0u, cell == 0u);
    return Bin(begin, cells[cell] - begin);
}
fn place_in(bin: Bin, k: u32) -> u32 { return index_in_order(bin.begin + k); }

// The sort has collected the particles of a cell; from their number those that move are counted.
fn collect(cell: u32, bin: Bin) { counts[cell] = bin.count; }
