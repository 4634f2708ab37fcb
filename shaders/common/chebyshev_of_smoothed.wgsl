// What is smoothed once more.
@group(0) @binding(16) var<storage, read_write> once_smoothed: array<f32>;

fn given(node: u32) -> f32 { return once_smoothed[node]; }
