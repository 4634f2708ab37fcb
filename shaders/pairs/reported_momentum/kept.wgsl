// The momenta of a split step's report, right after the relaxation, where the temperature is measured: kept by id for
// analyses of velocities.
fn store_momentum(id: u32, momentum: vec4<i32>) { reported_momenta[id] = momentum; }
