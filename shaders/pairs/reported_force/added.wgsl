// The same, added to what an earlier kernel of the report has kept.
var<private> total_force: vec4<i32>;

fn begin_force() { total_force = vec4<i32>(0); }
fn add_reported_force(impulse: vec4<i32>) { total_force += impulse; }
fn store_force(id: u32) { reported_forces[id] += total_force; }
