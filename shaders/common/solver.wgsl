// What the conjugate gradients of the friction have come to: Chronopoulos and Gear, doi:10.1016/0377-0427(89)90045-9,
// whose iterations need a single sum over all cells. Sums are of single precision, in an order that depends on nothing but
// where the cells are.
struct Solver {
    key: vec2<u32>,   // of the step's random words
    iterations: u32,
    running: u32,     // 1 as long as the residual is too large
    step_length: f32, // along the direction of search
    turn: f32,        // part of the last direction in the next
    square: f32,      // of the residual, in the norm of the preconditioner
    scale: f32,       // the same of the right-hand side
    residual: f32,    // relative to that
    sums: array<vec4<f32>>, // of each workgroup: squares of residual, its image, and the right-hand side
}
@group(0) @binding(20) var<storage, read_write> solver: Solver;
