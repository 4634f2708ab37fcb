// (1 - Λ²∇²) x = b by Chebyshev's iteration from x = 0, which makes x a fixed polynomial in the operator times b:
// x_{k+1} = x_{k-1} + ω_{k+1} ((b - (1 - Λ²∇²) x_k)/θ + x_k - x_{k-1}).
// One invocation works on four rows of a column.
override NODES_X: u32;
override NODES_Y: u32;
override STIFFNESS_X: f32; // Λ²/Δx²
override STIFFNESS_Y: f32;
override INVERSE_CENTRE: f32; // 1/θ, θ the middle of the spectrum

const STRIP = 4u;

struct Iteration {
    done: array<u32, 2>,     // iterations finished, before one of even number and of odd
    weights: array<f32>,     // ω
}
@group(0) @binding(17) var<storage, read_write> iteration: Iteration;
@group(0) @binding(14) var<storage, read_write> waves: array<f32>;
@group(0) @binding(15) var<storage, read_write> waves_next: array<f32>;
