// The table of pairs of species, in a buffer.
var<storage, read> coefficients: array<vec4<f32>>;

fn coefficient_entry(index: u32) -> vec4<f32> { return coefficients[index]; }
