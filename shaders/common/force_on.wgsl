// The impulses on each particle at a report, kept by id for the analyses of forces.
@group(0) @binding(41) var<storage, read_write> reported_forces: array<vec4<i32>>;
var<private> force: vec4<i32>;

fn begin_force() { force = vec4<i32>(0); }
fn add_force(impulse: vec4<i32>) { force += impulse; }
fn store_force(id: u32) { reported_forces[id] = force; }
