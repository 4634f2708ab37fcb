// The depth of a node is its mass; what is smoothed is its deviation from the mean.
override MEAN_MASS: u32;
override MASS_UNIT: f32;

@group(0) @binding(12) var<storage, read_write> node_masses: array<u32>;

// The difference of integers is exact, and keeps all digits of a small deviation.
fn deviation(node: u32) -> f32 { return f32(i32(node_masses[node] - MEAN_MASS)) * MASS_UNIT; }
