// What is smoothed first.
fn given(node: u32) -> f32 { return deviation(node); }
