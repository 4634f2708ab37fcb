//! Centred B-splines on a periodic line of nodes.

/// The most nodes that a spline reaches.
const WIDTH: usize = 4;

/// Values ψ(x - k) of a centred B-spline at a place x, over the nodes k that it reaches, in node spacings.
///
/// A spline of order p is p times integrated from a box of unit width, has p + 1 pieces and reaches p + 1 nodes. The
/// splines of all nodes add up to 1 everywhere, and their slopes to 0. What is left of the arrays for a lower order
/// than 3 has no weight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spline {
    /// The nodes, modulo their number; none twice where there are more nodes than the order.
    pub nodes: [usize; WIDTH],
    /// Values ψ(x - k).
    pub weights: [f64; WIDTH],
    /// Derivatives ψ'(x - k) by x.
    pub slopes: [f64; WIDTH],
}

impl Spline {
    /// The spline of order 1, 2 or 3 at a place in `[0, count)` on a line of so many nodes.
    pub(crate) fn at(order: u32, place: f64, count: usize) -> Self {
        // An odd order has nodes at the ends of its pieces, an even one at their middle.
        let nearest = if order == 2 { (place + 0.5).floor() } else { place.floor() };
        let u = place - nearest;
        let v = 1.0 - u;
        let (first, weights, slopes) = match order {
            1 => (nearest, [v, u, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0]),
            2 => (
                nearest - 1.0,
                [0.5 * (0.5 - u).powi(2), 0.75 - u * u, 0.5 * (0.5 + u).powi(2), 0.0],
                [u - 0.5, -2.0 * u, u + 0.5, 0.0],
            ),
            _ => (
                nearest - 1.0,
                [
                    v * v * v / 6.0,
                    2.0 / 3.0 - u * u * (1.0 - 0.5 * u),
                    2.0 / 3.0 - v * v * (1.0 - 0.5 * v),
                    u * u * u / 6.0,
                ],
                [-0.5 * v * v, u * (1.5 * u - 2.0), v * (2.0 - 1.5 * v), 0.5 * u * u],
            ),
        };
        let count = count as i64;
        let mut nodes = [0; WIDTH];
        for (offset, node) in nodes.iter_mut().enumerate().take(order as usize + 1) {
            let reached = first as i64 + offset as i64;
            *node = if (0..count).contains(&reached) { reached } else { reached.rem_euclid(count) } as usize;
        }
        Self { nodes, weights, slopes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The B-spline by its recursion, at a distance from its centre.
    fn recursive(order: u32, distance: f64) -> f64 {
        if order == 0 {
            return if (-0.5..0.5).contains(&distance) { 1.0 } else { 0.0 };
        }
        let half = 0.5 * f64::from(order + 1);
        ((distance + half) * recursive(order - 1, distance + 0.5)
            + (half - distance) * recursive(order - 1, distance - 0.5))
            / f64::from(order)
    }

    #[test]
    fn values_are_those_of_the_recursion_and_slopes_their_derivatives() {
        for order in 1..=3 {
            for place in [0.0, 0.13, 0.49, 0.5, 2.0, 3.77, 5.5, 6.999] {
                let spline = Spline::at(order, place, 7);
                let sum: f64 = spline.weights.iter().sum();
                assert!((sum - 1.0).abs() < 1e-15 && spline.slopes.iter().sum::<f64>().abs() < 1e-15);
                let (mut weights, mut slopes) = ([0.0; 7], [0.0; 7]);
                for entry in 0..WIDTH {
                    weights[spline.nodes[entry]] += spline.weights[entry];
                    slopes[spline.nodes[entry]] += spline.slopes[entry];
                }
                for node in 0..7 {
                    let value = |place: f64| -> f64 {
                        [-7.0, 0.0, 7.0].iter().map(|turn| recursive(order, place + turn - node as f64)).sum()
                    };
                    assert!((weights[node] - value(place)).abs() < 1e-14, "order {order} at {place}");
                    // From the side on which the piece at this place continues.
                    let slope = (4.0 * value(place + 1e-5) - 3.0 * value(place) - value(place + 2e-5)) / 2e-5;
                    assert!((slopes[node] - slope).abs() < 1e-6, "order {order} at {place}");
                }
            }
        }
    }

    #[test]
    fn the_smallest_line_of_nodes_is_reached_once_each() {
        for order in 1..=3 {
            let count = order as usize + 1;
            for step in 0..40 {
                let place = 0.025 * f64::from(step) * count as f64;
                let mut nodes = Spline::at(order, place, count).nodes[..count].to_vec();
                nodes.sort_unstable();
                assert_eq!(nodes, (0..count).collect::<Vec<_>>(), "order {order} at {place}");
            }
        }
    }
}
