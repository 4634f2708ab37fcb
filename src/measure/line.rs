//! Straight lines through points.

/// A straight line.
pub(super) struct Line {
    pub slope: f64,
    pub intercept: f64,
}

/// The line that minimises Σ w (y - intercept - slope x)² over (x, y, w).
pub(super) fn weighted_line(points: impl Iterator<Item = (f64, f64, f64)> + Clone) -> Option<Line> {
    let (mut weight, mut x, mut y) = (0.0, 0.0, 0.0);
    for point in points.clone() {
        weight += point.2;
        x += point.2 * point.0;
        y += point.2 * point.1;
    }
    let (x, y) = (x / weight, y / weight);
    let (mut spread, mut joint) = (0.0, 0.0);
    for point in points {
        spread += point.2 * (point.0 - x).powi(2);
        joint += point.2 * (point.0 - x) * (point.1 - y);
    }
    (spread > 0.0).then(|| Line { slope: joint / spread, intercept: y - joint / spread * x })
}
