// A listed neighbour: where it is stored, and whether the pair is spared its repulsion.
const NEIGHBOUR_MASK: u32 = 0x7fffffffu;
