// Some listed pairs are spared their repulsion: their word says so.
fn spared(neighbour: u32) -> bool { return (neighbour & ~NEIGHBOUR_MASK) != 0u; }
