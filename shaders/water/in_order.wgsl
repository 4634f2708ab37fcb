// Water sorted by cell.

// == water/storage/sorted
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

// == water/moving/sorted
// Particles that have moved stay where they lie; those that go to another cell are counted there.
fn begin_moving(cell: u32) {}
fn store_moved(cell: u32, bin: Bin, index: u32, particle: Water) {
    store_motion(index, particle);
    let destination = cell_of(particle.position);
    if (destination != cell) {
        atomicAdd(&counts[destination], 1u);
        atomicSub(&counts[cell], 1u);
    }
}
fn end_moving(cell: u32, bin: Bin) {}

// == water/sorted/by_sort
// Off: the sort has begun the step.
fn begin_unsorted_step() {}
