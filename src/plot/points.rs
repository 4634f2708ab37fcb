//! Points made of columns.

/// With more points than this, markers and their error bars would run into each other.
pub(super) const MOST_MARKERS: usize = 60;

/// Points of two columns.
pub(super) fn pairs(x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    x.iter().zip(y).map(|(x, y)| [*x, *y]).collect()
}

/// The outline of a histogram, from edge to edge of each bin at its height.
pub(super) fn steps(bins: impl IntoIterator<Item = ([f64; 2], f64)>) -> Vec<[f64; 2]> {
    bins.into_iter().flat_map(|(edges, height)| edges.map(|edge| [edge, height])).collect()
}

/// What values have changed by since the first.
pub(super) fn since_first(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let first = points.first().map_or(f64::NAN, |point| point[1]);
    points.iter().map(|[time, value]| [*time, value - first]).collect()
}

/// The largest of finite values, zero without one that is positive.
pub(super) fn highest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().filter(|value| value.is_finite()).fold(0.0, f64::max)
}
