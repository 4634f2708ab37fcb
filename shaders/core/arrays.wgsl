// Arrays that kernels of several pages share. The linker numbers them, and makes atomics of the elements that a kernel changes
// atomically.
//
// Slots arrays/particles, arrays/sorted, and those that build.rs generates: functions to load and store the elements of an array.
// Variants buffer, texture, and for sorted particles apart (two textures). Default: buffers (src/shaders/choices.rs); the plan
// chooses textures for software adapters (src/plan/serial_memory.rs, and the plan of pairs).

var<storage, read_write> counts: array<u32>; // particles in each cell
var<storage, read_write> probes: array<u32>; // what the prefilter reads of every sorted particle
var<storage, read_write> came_from: array<u32>; // where each particle was stored before the last sort
var<storage, read_write> slots: array<u32>; // where each particle is stored, by id
var<storage, read_write> demands: array<u32>; // workgroups of kernels that depend on the step, as they are and as needed
// Sums of each workgroup, QUANTITIES a row.
var<storage, read_write> partial_sums: array<vec2<u32>>;
// Rows in the batch and in all; then the rows, each headed by the step.
var<storage, read_write> samples: array<vec2<u32>>;
// What a report leaves by id: integer impulses and momenta.
var<storage, read_write> reported_forces: array<vec4<i32>>;
var<storage, read_write> reported_momenta: array<vec4<i32>>;
var<storage, read_write> centre: array<vec4<f32>>; // velocity of the centre of mass, one element

// The mesh of shallow water: integer mass on each node, deviation of the smoothed depth from 1, the same with the bath.
var<storage, read_write> node_masses: array<u32>;
var<storage, read_write> depths: array<f32>;
var<storage, read_write> surface: array<f32>;

// Voronoi cells: velocity, pressure and volume expected of an exchange; mean velocity in friction and residual.
var<storage, read_write> predictions: array<vec4<f32>>;
var<storage, read_write> estimates: array<vec4<f32>>;
