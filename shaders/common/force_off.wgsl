// No analysis asks for the forces of a report.
fn begin_force() {}
fn add_force(impulse: vec4<i32>) {}
fn store_force(id: u32) {}
