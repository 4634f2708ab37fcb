// Arrays that kernels of several pages share.
var<storage, read_write> came_from: array<u32>;
var<storage, read_write> centre: array<vec4<f32>>;
var<storage, read_write> counts: array<u32>; // particles in each cell
var<storage, read_write> demands: array<u32>; // workgroups of an iteration, as they are and as needed
var<storage, read_write> depths: array<f32>;  // deviation of the smoothed depth from 1
var<storage, read_write> estimates: array<vec4<f32>>; // mean velocity, residual
var<storage, read_write> node_masses: array<u32>;
var<storage, read_write> partial_sums: array<vec2<u32>>;
var<storage, read_write> predictions: array<vec4<f32>>; // velocity, pressure, volume
var<storage, read_write> probes: array<u32>;
var<storage, read_write> reported_forces: array<vec4<i32>>; // by id
var<storage, read_write> reported_momenta: array<vec4<i32>>; // by id
var<storage, read_write> samples: array<vec2<u32>>; // rows in the batch and in all, then the rows
var<storage, read_write> slots: array<u32>;
var<storage, read_write> surface: array<f32>; // the same with the bath
