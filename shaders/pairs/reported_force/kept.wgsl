// The impulses on each particle at a report, kept by id for the analyses of forces.
override FORCES_BEGUN: u32 = 0u; // 1 where an earlier kernel of the report has kept some, to which these are added
var<private> total_force: vec4<i32>;

fn begin_force() { total_force = vec4<i32>(0); }
fn add_reported_force(impulse: vec4<i32>) { total_force += impulse; }
fn store_force(id: u32) {
    if (FORCES_BEGUN == 1u) { total_force += reported_forces[id]; }
    reported_forces[id] = total_force;
}
