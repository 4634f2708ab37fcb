// Lanes of a workgroup of the prefix sum: as many as every adapter has.
const SCAN_LANES: u32 = 256u;
