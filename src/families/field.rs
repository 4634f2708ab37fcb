//! Scalar fields on the nodes of a periodic mesh.

use thiserror::Error;

/// One number at every node of a regular two-dimensional mesh that is periodic in both directions.
///
/// Node (kx, ky) lies at (kx·Lx/nx, ky·Ly/ny), so the first node of each row lies in the origin and there is none at
/// the far edge: that is the first one again. A number that is not finite stands for a node without a value.
///
/// ```
/// use mesoscope::measure::Field;
/// let depth = Field::from_function("depth", "depth h (H_{0})", [8, 4], [2.0, 1.0], |[x, y]| 1.0 + x * y);
/// assert_eq!(depth.at(1, 2), 1.0 + 0.25 * 0.5);
/// assert_eq!(depth.extrema(), Some([1.0, 1.0 + 1.75 * 0.75]));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Field {
    /// What it is, as in "depth".
    pub name: String,
    /// The quantity with its symbol and unit, for the colour bar; `_{…}` sets an index and `^{…}` an exponent.
    pub label: String,
    /// Nodes along x and y.
    pub nodes: [usize; 2],
    /// Edge lengths of the box, in units of length.
    pub lengths: [f64; 2],
    /// Values, with that of node (kx, ky) at `kx * nodes[1] + ky`.
    pub values: Vec<f64>,
}

/// A field whose parts do not fit together.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FieldError {
    /// The number of values is not that of the nodes.
    #[error("the field `{name}` has {values} values for {} x {} nodes", nodes[0], nodes[1])]
    Values {
        /// Name of the field.
        name: String,
        /// Nodes along x and y.
        nodes: [usize; 2],
        /// Values given.
        values: usize,
    },
    /// There are no nodes.
    #[error("the field `{name}` has {} x {} nodes; there must be one at least along each axis", nodes[0], nodes[1])]
    Nodes {
        /// Name of the field.
        name: String,
        /// Nodes along x and y.
        nodes: [usize; 2],
    },
    /// An edge of the box has no length.
    #[error("the field `{name}` lies in a box of {} x {}; its edges must be positive", lengths[0], lengths[1])]
    Lengths {
        /// Name of the field.
        name: String,
        /// Edge lengths of the box.
        lengths: [f64; 2],
    },
}

impl Field {
    /// The field whose value at each node is that of a function of the node's position.
    #[must_use]
    pub fn from_function(
        name: &str,
        label: &str,
        nodes: [usize; 2],
        lengths: [f64; 2],
        function: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let spacing = [0, 1].map(|axis| lengths[axis] / nodes[axis] as f64);
        let values = (0..nodes[0])
            .flat_map(|kx| (0..nodes[1]).map(move |ky| [kx, ky]))
            .map(|node| function([node[0] as f64 * spacing[0], node[1] as f64 * spacing[1]]))
            .collect();
        Self { name: name.to_owned(), label: label.to_owned(), nodes, lengths, values }
    }

    /// Makes sure that there is a value for every node and that the box has an area.
    ///
    /// # Errors
    /// [`FieldError`] says what does not fit.
    pub(crate) fn check(&self) -> Result<(), FieldError> {
        let (nodes, lengths) = (self.nodes, self.lengths);
        let name = || self.name.clone();
        if nodes.contains(&0) {
            return Err(FieldError::Nodes { name: name(), nodes });
        }
        if nodes[0].checked_mul(nodes[1]) != Some(self.values.len()) {
            return Err(FieldError::Values { name: name(), nodes, values: self.values.len() });
        }
        if !lengths.iter().all(|length| length.is_finite() && *length > 0.0) {
            return Err(FieldError::Lengths { name: name(), lengths });
        }
        Ok(())
    }

    /// The value of a node; NaN where there is none.
    #[must_use]
    pub fn at(&self, kx: usize, ky: usize) -> f64 {
        if ky >= self.nodes[1] {
            return f64::NAN;
        }
        self.values.get(kx * self.nodes[1] + ky).copied().unwrap_or(f64::NAN)
    }

    /// The value of the node with these indices modulo the numbers of nodes.
    fn at_wrapped(&self, node: [i64; 2]) -> f64 {
        let [kx, ky] = [0, 1].map(|axis| node[axis].rem_euclid(self.nodes[axis].max(1) as i64) as usize);
        self.at(kx, ky)
    }

    /// The smallest and the largest finite value; none where no value is finite.
    #[must_use]
    pub fn extrema(&self) -> Option<[f64; 2]> {
        self.values.iter().filter(|value| value.is_finite()).fold(None, |extrema, value| {
            let [low, high] = extrema.unwrap_or([*value; 2]);
            Some([low.min(*value), high.max(*value)])
        })
    }

    /// The value at a position, in units of length, interpolated between the four nodes around it; any position is
    /// taken back into the box. NaN if one of the nodes has no value or the position is not finite.
    #[must_use]
    #[cfg(test)]
    fn linear_at(&self, position: [f64; 2]) -> f64 {
        self.interpolated(position, |t| [1.0 - t, t], 0)
    }

    /// The same from the sixteen nodes around the position, with the cubic convolution of Keys,
    /// doi:10.1109/TASSP.1981.1163711: smooth, exact at the nodes and for quadratic fields, but it may overshoot the
    /// extrema between nodes.
    #[must_use]
    pub fn cubic_at(&self, position: [f64; 2]) -> f64 {
        let weights = |t: f64| {
            [
                ((-0.5 * t + 1.0) * t - 0.5) * t,
                (1.5 * t - 2.5) * t * t + 1.0,
                ((-1.5 * t + 2.0) * t + 0.5) * t,
                (0.5 * t - 0.5) * t * t,
            ]
        };
        self.interpolated(position, weights, -1)
    }

    /// The sum over nodes with weights of the position's place `t` between two nodes; the first weight is that of the
    /// node `first` places from the one below the position.
    fn interpolated<const N: usize>(&self, position: [f64; 2], weights: impl Fn(f64) -> [f64; N], first: i64) -> f64 {
        let place = [0, 1].map(|axis| (position[axis] / self.lengths[axis]).rem_euclid(1.0) * self.nodes[axis] as f64);
        let below = place.map(|place| place.floor() as i64 + first);
        let [along_x, along_y] = place.map(|place| weights(place - place.floor()));
        let mut sum = 0.0;
        for (kx, weight_x) in (below[0]..).zip(along_x) {
            for (ky, weight_y) in (below[1]..).zip(along_y) {
                sum += weight_x * weight_y * self.at_wrapped([kx, ky]);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(nodes: [usize; 2]) -> Field {
        Field::from_function("wave", "", nodes, [TAU, 2.0 * TAU], |[x, y]| (x + 0.3).sin() * (0.5 * y).cos())
    }

    #[test]
    fn interpolation_is_periodic_and_exact_at_the_nodes() {
        let field = wave([12, 20]);
        for (kx, ky) in [(0, 0), (3, 7), (11, 19), (0, 19), (11, 0)] {
            let position = [kx as f64 * TAU / 12.0, ky as f64 * 2.0 * TAU / 20.0];
            let image = [position[0] - TAU, position[1] + 4.0 * TAU];
            for position in [position, image] {
                assert!((field.linear_at(position) - field.at(kx, ky)).abs() < 1e-12);
                assert!((field.cubic_at(position) - field.at(kx, ky)).abs() < 1e-12);
            }
        }
        assert!(field.linear_at([f64::NAN, 0.0]).is_nan());
        assert!(field.at(0, 20).is_nan() && field.at(12, 0).is_nan());
    }

    #[test]
    fn interpolation_has_its_order() {
        let worst = |nodes: usize, sample: &dyn Fn(&Field, [f64; 2]) -> f64| {
            let field = wave([nodes, nodes]);
            let positions = (0..500).map(|i| [f64::from(i) * 0.173, f64::from(i) * 0.311]);
            let error = |at: [f64; 2]| (sample(&field, at) - (at[0] + 0.3).sin() * (0.5 * at[1]).cos()).abs();
            positions.map(error).fold(0.0, f64::max)
        };
        let ratio = |sample: &dyn Fn(&Field, [f64; 2]) -> f64| worst(32, sample) / worst(64, sample);
        let linear = ratio(&Field::linear_at);
        let cubic = ratio(&Field::cubic_at);
        assert!(linear > 3.5 && linear < 4.5, "second order: {linear}");
        assert!(cubic > 7.0, "third order at least: {cubic}");
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let field = wave([3, 4]);
        assert_eq!(field.check(), Ok(()));
        let short = Field { values: vec![0.0; 11], ..field.clone() };
        assert!(matches!(short.check(), Err(FieldError::Values { values: 11, .. })));
        let overflowing = Field { nodes: [usize::MAX, 2], ..field.clone() };
        assert!(matches!(overflowing.check(), Err(FieldError::Values { .. })));
        let empty = Field { nodes: [0, 4], values: Vec::new(), ..field.clone() };
        assert!(matches!(empty.check(), Err(FieldError::Nodes { .. })));
        for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let flat = Field { lengths: [1.0, length], ..field.clone() };
            assert!(matches!(flat.check(), Err(FieldError::Lengths { .. })), "{length}");
        }
    }

    #[test]
    fn extrema_leave_out_what_is_not_finite() {
        let values = vec![f64::NAN, 2.0, f64::INFINITY, -3.0];
        let field = Field { nodes: [2, 2], lengths: [1.0; 2], values, ..Field::default() };
        assert_eq!(field.extrema(), Some([-3.0, 2.0]));
        assert_eq!(Field { values: vec![f64::NAN; 4], ..field }.extrema(), None);
    }
}
