// Every listed pair repels.
fn spared(neighbour: u32) -> bool { return false; }
