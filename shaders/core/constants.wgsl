// Numbers that the host sets when it makes a pipeline, for kernels of several pages.
override BATH_IMPULSE: f32; // impulse of half a step per bath
override BATH_SQUARE: f32; // inverse quantum of the square of a bath
override BINS: u32;
override CAPACITY: u32; // of those that stay
override CELLS_X: u32;
override CELLS_Y: u32;
override CLOSES: u32; // 1 from before the closing kick
override DISPLACEMENT_LIMIT: f32;
override GRADIENT: f32;     // square of the force per square of an impulse, over its quantum
override GROUPS: u32; // workgroups that share the cells in doubt
override KINETIC: f32;        // energy per unit of mass and squared velocity, over its quantum
override LAPLACIAN: f32;   // second derivative at both ends per impulse and inverse length, over its quantum
override MASS_UNIT: f32;
override MEAN_MASS: u32;
const MOMENTUM_LIMIT: i32 = 1073741824; // 2^30
const NO_CELL: u32 = 0xffffffffu;
override PAIR_ENERGY: f32;  // potential energy of one end of a pair per impulse, over its quantum
override PAIR_VIRIAL: f32;       // energy per impulse and length, over its quantum
override PARTICLES: u32;
override PERSISTENCE: f32;  // e
override QUANTITIES: u32;   // two for each group
override SEGMENTS: u32; // workgroups that share a row
override SHARES: u32; // of a dispatch
override SPAN_X: u32; // cells to visit on each axis, centred on the particle's
override SPAN_Y: u32;
override SPAN_Z: u32;
const STRAY: f32 = 3e-5;
override VISCOSITY: f32; // times the time step
override WINDOW: u32;  // samples in a window
const WORDS: u32 = 32u;
