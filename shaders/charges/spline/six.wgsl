// Splines of six points: the recursion M(n, x) = (x M(n-1, x) + (n - x) M(n-1, x-1))/(n - 1) in integers of 2^-28. Written out, because
// arrays whose elements are known are no memory.
const ORDER: u32 = 6u;
struct SplineWeights { values: array<i32, 6> }

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
    return SplineWeights(array<i32, 6>(
        i32((e0 + 8u) >> 4u),
        i32((e1 + 8u) >> 4u),
        i32((e2 + 8u) >> 4u),
        i32((e3 + 8u) >> 4u),
        i32((e4 + 8u) >> 4u),
        i32((e5 + 8u) >> 4u),
    ));
}

// Spreads the charge of a row of a cloud, from the first node under its spline on.
fn spread_row(row: u32, first: u32, weights: SplineWeights, of_row: f32) {
    spread_on(row + node_after(first, 0u, CHARGE_NODES_X), weights.values[0], of_row);
    spread_on(row + node_after(first, 1u, CHARGE_NODES_X), weights.values[1], of_row);
    spread_on(row + node_after(first, 2u, CHARGE_NODES_X), weights.values[2], of_row);
    spread_on(row + node_after(first, 3u, CHARGE_NODES_X), weights.values[3], of_row);
    spread_on(row + node_after(first, 4u, CHARGE_NODES_X), weights.values[4], of_row);
    spread_on(row + node_after(first, 5u, CHARGE_NODES_X), weights.values[5], of_row);
}

// The weights by which a spline gathers antisymmetric differences, from half as many nodes before it on.
struct SplineSlopes { values: array<f32, 12> }
fn slopes_along(weights: SplineWeights) -> SplineSlopes {
    let w = weights.values;
    return SplineSlopes(array<f32, 12>(
        f32(-DIFFERENCE_THREE * w[0]),
        f32(-DIFFERENCE_TWO * w[0] - DIFFERENCE_THREE * w[1]),
        f32(-DIFFERENCE_ONE * w[0] - DIFFERENCE_TWO * w[1] - DIFFERENCE_THREE * w[2]),
        f32(-DIFFERENCE_ONE * w[1] - DIFFERENCE_TWO * w[2] - DIFFERENCE_THREE * w[3]),
        f32(DIFFERENCE_ONE * (w[0] - w[2]) - DIFFERENCE_TWO * w[3] - DIFFERENCE_THREE * w[4]),
        f32(DIFFERENCE_ONE * (w[1] - w[3]) + DIFFERENCE_TWO * (w[0] - w[4]) - DIFFERENCE_THREE * w[5]),
        f32(DIFFERENCE_ONE * (w[2] - w[4]) + DIFFERENCE_TWO * (w[1] - w[5]) + DIFFERENCE_THREE * w[0]),
        f32(DIFFERENCE_ONE * (w[3] - w[5]) + DIFFERENCE_TWO * w[2] + DIFFERENCE_THREE * w[1]),
        f32(DIFFERENCE_ONE * w[4] + DIFFERENCE_TWO * w[3] + DIFFERENCE_THREE * w[2]),
        f32(DIFFERENCE_ONE * w[5] + DIFFERENCE_TWO * w[4] + DIFFERENCE_THREE * w[3]),
        f32(DIFFERENCE_TWO * w[5] + DIFFERENCE_THREE * w[4]),
        f32(DIFFERENCE_THREE * w[5]),
    ));
}

// The potential of a row of nodes weighed by the spline along x; and in `slope_of_row` by its slopes as well, which reach further.
fn potential_of_row(row: u32, first: u32) -> f32 {
    var sum = plain_x.values[0] * potential_at(row + node_after(first, 3u, CHARGE_NODES_X));
    sum = fma(plain_x.values[1], potential_at(row + node_after(first, 4u, CHARGE_NODES_X)), sum);
    sum = fma(plain_x.values[2], potential_at(row + node_after(first, 5u, CHARGE_NODES_X)), sum);
    sum = fma(plain_x.values[3], potential_at(row + node_after(first, 6u, CHARGE_NODES_X)), sum);
    sum = fma(plain_x.values[4], potential_at(row + node_after(first, 7u, CHARGE_NODES_X)), sum);
    sum = fma(plain_x.values[5], potential_at(row + node_after(first, 8u, CHARGE_NODES_X)), sum);
    return sum;
}
fn slope_of_row(row: u32, first: u32) -> vec2<f32> {
    let p0 = potential_at(row + node_after(first, 0u, CHARGE_NODES_X));
    let p1 = potential_at(row + node_after(first, 1u, CHARGE_NODES_X));
    let p2 = potential_at(row + node_after(first, 2u, CHARGE_NODES_X));
    let p3 = potential_at(row + node_after(first, 3u, CHARGE_NODES_X));
    let p4 = potential_at(row + node_after(first, 4u, CHARGE_NODES_X));
    let p5 = potential_at(row + node_after(first, 5u, CHARGE_NODES_X));
    let p6 = potential_at(row + node_after(first, 6u, CHARGE_NODES_X));
    let p7 = potential_at(row + node_after(first, 7u, CHARGE_NODES_X));
    let p8 = potential_at(row + node_after(first, 8u, CHARGE_NODES_X));
    let p9 = potential_at(row + node_after(first, 9u, CHARGE_NODES_X));
    let p10 = potential_at(row + node_after(first, 10u, CHARGE_NODES_X));
    let p11 = potential_at(row + node_after(first, 11u, CHARGE_NODES_X));
    var plain = plain_x.values[0] * p3;
    plain = fma(plain_x.values[1], p4, plain);
    plain = fma(plain_x.values[2], p5, plain);
    plain = fma(plain_x.values[3], p6, plain);
    plain = fma(plain_x.values[4], p7, plain);
    plain = fma(plain_x.values[5], p8, plain);
    var slope = slopes_x.values[0] * p0;
    slope = fma(slopes_x.values[1], p1, slope);
    slope = fma(slopes_x.values[2], p2, slope);
    slope = fma(slopes_x.values[3], p3, slope);
    slope = fma(slopes_x.values[4], p4, slope);
    slope = fma(slopes_x.values[5], p5, slope);
    slope = fma(slopes_x.values[6], p6, slope);
    slope = fma(slopes_x.values[7], p7, slope);
    slope = fma(slopes_x.values[8], p8, slope);
    slope = fma(slopes_x.values[9], p9, slope);
    slope = fma(slopes_x.values[10], p10, slope);
    slope = fma(slopes_x.values[11], p11, slope);
    return vec2<f32>(plain, slope);
}

// Weights as real numbers.
struct PlainWeights { values: array<f32, 6> }
fn plain_weights(weights: SplineWeights) -> PlainWeights {
    let w = weights.values;
    return PlainWeights(array<f32, 6>(
        f32(w[0]),
        f32(w[1]),
        f32(w[2]),
        f32(w[3]),
        f32(w[4]),
        f32(w[5]),
    ));
}
