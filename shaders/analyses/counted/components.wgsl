// A histogram counts the components of a vector from one axis up to another.
override FIRST_AXIS: u32;
override END_AXIS: u32;

fn counted(vector: vec3<f32>, axis: u32) -> f32 { return vector[axis]; }
