// A histogram counts the magnitude of a vector, a single value.
const FIRST_AXIS: u32 = 0u;
const END_AXIS: u32 = 1u;

fn counted(vector: vec3<f32>, axis: u32) -> f32 { return length(vector); }
