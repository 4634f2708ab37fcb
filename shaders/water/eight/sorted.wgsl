// The particles of eight cells side by side, in the order of their cells, are one stretch.
struct Eight { begin: u32, count: u32 }

fn opened_eight(bin: Bin) -> Eight {
    let begin = subgroupShuffle(bin.begin, 0u);
    return Eight(begin, subgroupShuffle(bin.begin + bin.count, 7u) - begin);
}
fn place_in_eight(eight: Eight, bin: Bin, number: u32) -> u32 { return index_in_order(eight.begin + number); }
fn store_moved_of_eight(eight: Eight, bin: Bin, cell: u32, owner: u32, first: u32, index: u32, particle: Water) {
    if (first + lane_of_eight < eight.count) { store_moved(cell - lane_of_eight + owner, bin, index, particle); }
}
fn end_moving_eight(eight: Eight, bin: Bin, cell: u32) {}
