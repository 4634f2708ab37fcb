// The momenta of a split step's report, right after the relaxation, where the temperature is measured: kept by id for the
// analyses of velocities.
@group(0) @binding(43) var<storage, read_write> reported_momenta: array<vec4<i32>>;

fn store_momentum(id: u32, momentum: vec4<i32>) { reported_momenta[id] = momentum; }
