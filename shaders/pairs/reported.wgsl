// Forces and momenta that a report keeps by id for analyses.
//
// The impulses on it, in integer momentum units.
override KEEPS_FORCES: u32;      // 1 where an analysis needs forces
override FORCES_BEGUN: u32 = 0u; // 1 where an earlier kernel of the report has kept some, to which these are added
var<private> total_force: vec4<i32>;

fn begin_force() { total_force = vec4<i32>(0); }
fn add_reported_force(impulse: vec4<i32>) { total_force += impulse; }
fn store_force(id: u32) {
    if (KEEPS_FORCES == 0u) { return; }
    if (FORCES_BEGUN == 1u) { total_force += reported_forces[id]; }
    reported_forces[id] = total_force;
}

// The momentum of a split step's report, right after the relaxation, where the temperature is measured.
override KEEPS_MOMENTA: u32;     // 1 where an analysis needs velocities, 2 where those relative to the flow
var<private> reported_flow: f32; // along x, in the linear profile where the particle is

fn store_momentum(id: u32, momentum: vec4<i32>) {
    if (KEEPS_MOMENTA == 0u) { return; }
    var word = momentum;
    if (KEEPS_MOMENTA == 2u) { word.x -= i32(round(reported_flow)); }
    reported_momenta[id] = word;
}
