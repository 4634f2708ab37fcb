// The right-hand side is what has been smoothed before.

fn given_depth(node: u32) -> f32 { return once_smoothed[node]; }
