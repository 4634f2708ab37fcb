// Splines of six points: the recursion M(n, x) = (x M(n-1, x) + (n - x) M(n-1, x-1))/(n - 1) in integers of 2^-28.
const ORDER: u32 = 6u;
struct SplineWeights { values: array<f32, 6> }

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
    let d0 = weight_times(c0, 0u, before) / 4u;
    let d1 = (weight_times(c0, 3u, after) + weight_times(c1, 1u, before)) / 4u;
    let d2 = (weight_times(c1, 2u, after) + weight_times(c2, 2u, before)) / 4u;
    let d3 = (weight_times(c2, 1u, after) + weight_times(c3, 3u, before)) / 4u;
    let d4 = weight_times(c3, 0u, after) / 4u;
    let e0 = weight_times(d0, 0u, before) / 5u;
    let e1 = (weight_times(d0, 4u, after) + weight_times(d1, 1u, before)) / 5u;
    let e2 = (weight_times(d1, 3u, after) + weight_times(d2, 2u, before)) / 5u;
    let e3 = (weight_times(d2, 2u, after) + weight_times(d3, 3u, before)) / 5u;
    let e4 = (weight_times(d3, 1u, after) + weight_times(d4, 4u, before)) / 5u;
    let e5 = weight_times(d4, 0u, after) / 5u;
    return SplineWeights(array<f32, 6>(
        f32((e0 + 8u) >> 4u),
        f32((e1 + 8u) >> 4u),
        f32((e2 + 8u) >> 4u),
        f32((e3 + 8u) >> 4u),
        f32((e4 + 8u) >> 4u),
        f32((e5 + 8u) >> 4u),
    ));
}
