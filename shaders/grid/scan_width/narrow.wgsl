// Lanes of a workgroup of the prefix sum: few, where they are taken one after the other and wait for each other at a price.
const SCAN_LANES: u32 = 8u;
