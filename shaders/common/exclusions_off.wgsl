// No pair is spared its repulsion.
fn excluded(id: u32, other: u32) -> u32 { return 0u; }
