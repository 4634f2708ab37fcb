// Waves for the next pass.
var<storage, read_write> waves_next: array<vec2<f32>>;

fn put_wave(index: u32, value: vec2<f32>) { waves_next[index] = value; }
