// Splines of four points: the recursion M(n, x) = (x M(n-1, x) + (n - x) M(n-1, x-1))/(n - 1) in integers of 2^-28.
const ORDER: u32 = 4u;
struct SplineWeights { values: array<f32, 4> }

// A weight times a number of wholes and a fraction in 2^-32.
fn weight_times(weight: u32, wholes: u32, fraction: u32) -> u32 { return wholes * weight + high_of_product(fraction, weight); }

// The weights of nodes, in 2^-24, at a place between two of them in 2^-32, from the node that is furthest before it on.
fn weights_along(after: u32) -> SplineWeights {
    let before = ~after;
    let a0 = before >> 4u;
    let a1 = after >> 4u;
    let b0 = weight_times(a0, 0u, before) / 2u;
    let b1 = (weight_times(a0, 1u, after) + weight_times(a1, 1u, before)) / 2u;
    let b2 = weight_times(a1, 0u, after) / 2u;
    let c0 = weight_times(b0, 0u, before) / 3u;
    let c1 = (weight_times(b0, 2u, after) + weight_times(b1, 1u, before)) / 3u;
    let c2 = (weight_times(b1, 1u, after) + weight_times(b2, 2u, before)) / 3u;
    let c3 = weight_times(b2, 0u, after) / 3u;
    return SplineWeights(array<f32, 4>(
        f32((c0 + 8u) >> 4u),
        f32((c1 + 8u) >> 4u),
        f32((c2 + 8u) >> 4u),
        f32((c3 + 8u) >> 4u),
    ));
}
