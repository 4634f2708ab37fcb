// Few lanes: where they are executed one after the other, waiting for each other is expensive.
const SCAN_LANES: u32 = 8u;
