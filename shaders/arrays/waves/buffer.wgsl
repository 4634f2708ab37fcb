// Waves as the pass before has left them.
var<storage, read_write> waves: array<vec2<f32>>;

fn wave(index: u32) -> vec2<f32> { return waves[index]; }
