// Particles in bins are where they should be.
fn collect(cell: u32, bin: Bin) {}
