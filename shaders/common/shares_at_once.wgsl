// One dispatch has all shares of the work.
fn share_of(group: u32) -> u32 { return group; }
