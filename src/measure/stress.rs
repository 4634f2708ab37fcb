//! What follows from the pressure tensor.

/// The components of a symmetric tensor xx, yy, zz, xy, xz, yz that there are in two or three dimensions.
///
/// ```
/// use mesoscope::measure::stress::Components;
///
/// let names: Vec<&str> = Components::of(2).iter().map(|(name, _)| name).collect();
/// assert_eq!(names, ["xx", "yy", "xy"]);
/// assert_eq!(Components::of(3).len(), 6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Components {
    dimension: usize,
}

/// Names and axes of the components, in order.
const COMPONENTS: [(&str, [usize; 2]); 6] =
    [("xx", [0, 0]), ("yy", [1, 1]), ("zz", [2, 2]), ("xy", [0, 1]), ("xz", [0, 2]), ("yz", [1, 2])];

impl Components {
    /// Those in so many dimensions.
    #[must_use]
    pub fn of(dimension: usize) -> Self {
        Self { dimension }
    }

    /// Name and place of each.
    pub fn iter(self) -> impl Iterator<Item = (&'static str, usize)> {
        let all = COMPONENTS.iter().enumerate();
        all.filter(move |(_, (_, axes))| axes.iter().all(|axis| *axis < self.dimension))
            .map(|(place, (name, _))| (*name, place))
    }

    /// How many there are.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is always one")]
    pub fn len(self) -> usize {
        self.dimension * (self.dimension + 1) / 2
    }
}

/// The surface tension `γ = L (P_nn - P_tt)` of flat interfaces, from the normal and the mean tangential pressure across an axis along which
/// the box has the `length` L for each of them, half of its edge for the two of a slab; of a pressure tensor xx, yy, zz, xy, xz, yz. Kirkwood and Buff,
/// doi:10.1063/1.1747248. In two dimensions it is a line tension.
///
/// ```
/// use mesoscope::measure::stress::surface_tension;
/// assert_eq!(surface_tension(&[2.0, 4.0, 5.0, 0.3, 0.0, 0.1], 2, 3, 5.0), 10.0);
/// assert_eq!(surface_tension(&[2.0, 4.0, 0.0, 0.3, 0.0, 0.0], 0, 2, 5.0), -10.0);
/// ```
#[must_use]
pub fn surface_tension(pressure: &[f64; 6], normal: usize, dimension: usize, length: f64) -> f64 {
    let across = (0..dimension).filter(|axis| *axis != normal);
    let tangential: f64 = across.map(|axis| pressure[axis]).sum();
    length * (pressure[normal] - tangential / (dimension as f64 - 1.0))
}
