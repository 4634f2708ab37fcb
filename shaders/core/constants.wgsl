// Numbers that kernels of several pages share. The host sets those without a value when it makes a pipeline.

// Sizes.
override PARTICLES: u32;
override CELLS_X: u32; // of the grid, or of the mesh
override CELLS_Y: u32;
override SEGMENTS: u32; // workgroups that share a row of cells
override SHARES: u32; // workgroups of a dispatch
override GROUPS: u32; // workgroups that share the work, or whose sums are added
override CAPACITY: u32; // places of the sorted array with its frames, or of a bin
override QUANTITIES: u32; // sums in a row of a report or an analysis
override BINS: u32; // of a histogram
override WINDOW: u32; // samples of an analysis that are compared with the first of them
// Cells to visit on each axis, centred on the particle's.
override SPAN_X: u32;
override SPAN_Y: u32;
override SPAN_Z: u32;

// What a report counts in: quantities of the state over the quanta of their sums.
override KINETIC: f32; // energy per square of a momentum, or of a velocity and unit of mass
override PAIR_ENERGY: f32; // potential energy of one end of a pair per impulse
override PAIR_VIRIAL: f32; // virial, or energy, per impulse and length
override GRADIENT: f32; // square of the force per square of an impulse
override LAPLACIAN: f32; // second derivative per impulse and inverse length
override BATH_SQUARE: f32; // square of a bath variable

// Physics of the step.
override DISPLACEMENT_LIMIT: f32; // the largest displacement in a step along an axis
override CLOSES: u32; // 1 where a step goes on from before its closing kick, 0 from the report point
override PERSISTENCE: f32; // the part of a bath that remains after a step
override MASS_UNIT: f32; // mass of an integer unit
override MEAN_MASS: u32; // of a mesh node, in integer units
override VISCOSITY: f32; // of Voronoi cells, times the time step

// A momentum beyond this is near the end of its range.
const MOMENTUM_LIMIT: i32 = 1073741824; // 2^30
// How far a particle may lie outside its grid cell, as a fraction of the box.
const STRAY: f32 = 3e-5;
// No cell of the mesh.
const NO_CELL: u32 = 0xffffffffu;
