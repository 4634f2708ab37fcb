//! Cells no narrower than the cutoff, and the windows of the prefilter.

use crate::shaders::Constant;
use crate::state::Units;

/// The cell grid of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of dimensions.
    pub dimension: usize,
    /// Cells on each axis; 1 where fewer than three would fit.
    pub cells: [u32; 3],
    /// On each axis, the prefilter sees the box divided by two to this power.
    pub windows: [u32; 3],
    /// Length of a window unit on each axis, relative to x; 0 where the prefilter does not look: on another axis with three cells or one.
    pub ratios: [f64; 3],
    /// Square of the prefilter's reach in window units of x.
    pub reach_squared: f64,
}

impl Grid {
    /// The grid for a cutoff in a box.
    ///
    /// There are at most 1024 cells on an axis and, for few particles in a large box, about four cells per particle.
    ///
    /// ```
    /// use mesoscope::{plan::Grid, state::Units};
    ///
    /// let units = Units { dimension: 3, lengths: [10.0, 7.5, 2.5], gaps: [0.0; 3], momentum: 1.0 };
    /// let grid = Grid::new(&units, 1.0, 500);
    /// // No cell is narrower than the cutoff, and two cells on an axis are as good as one.
    /// assert_eq!(grid.cells, [10, 7, 1]);
    /// assert_eq!((grid.rows(), grid.count()), (7, 70));
    /// ```
    #[must_use]
    pub fn new(units: &Units, cutoff: f64, particles: u64) -> Self {
        Self::with_least(units, cutoff, particles, [1; 3])
    }

    /// The same with at least so many cells on each axis, all of which are wider than the cutoff.
    pub(crate) fn with_least(units: &Units, cutoff: f64, particles: u64, least: [u32; 3]) -> Self {
        let dimension = units.dimension;
        let mut cells = [1_u32; 3];
        let budget = (4.0 * particles as f64).max(27.0);
        let mut width = cutoff;
        loop {
            for (axis, count) in cells.iter_mut().enumerate().take(dimension) {
                let room = (units.lengths[axis] / width * (1.0 + 1e-12)).floor().min(1024.0) as u32;
                *count = if room < 3 { least[axis] } else { room };
            }
            if cells.iter().map(|count| f64::from(*count)).product::<f64>() <= budget {
                break;
            }
            width *= 1.1;
        }
        // Bits that the probe word gives to each axis.
        let bits: [u32; 3] = if dimension == 3 { [12, 10, 10] } else { [16, 16, 0] };
        let windows: [u32; 3] =
            std::array::from_fn(|axis| (cells[axis] / if axis == 0 { 8 } else { 4 }).max(1).ilog2());
        let unit: [f64; 3] = std::array::from_fn(|axis| units.lengths[axis] / 2_f64.powi(32 + windows[axis] as i32));
        let ratios: [f64; 3] = std::array::from_fn(|axis| {
            // Across three cells, the neighbours of a row are as wide as the box: rounding would take what is at one of their ends to the
            // other.
            if axis < dimension && (axis == 0 || cells[axis] > 3) { unit[axis] / unit[0] } else { 0.0 }
        });
        let diagonal: f64 =
            (0..dimension).map(|axis| (2_f64.powi(32 - bits[axis] as i32) * ratios[axis]).powi(2)).sum::<f64>().sqrt();
        // Half a quantum's diagonal, and a little for the rounding of single precision.
        let reach = (cutoff / unit[0] + 0.5 * diagonal) * (1.0 + 1e-5);
        Self { dimension, cells, windows, ratios, reach_squared: reach * reach }
    }

    /// Number of rows along x.
    #[must_use]
    pub fn rows(&self) -> u64 {
        u64::from(self.cells[1]) * u64::from(self.cells[2])
    }

    /// Number of cells.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.rows() * u64::from(self.cells[0])
    }

    /// What kernels that find particles by their cells have to know: the length of a unit of positions and the cells on each axis, and
    /// the number of all cells.
    pub(crate) fn constants(&self, units: &Units) -> [(Constant, f64); 7] {
        let unit = |axis: usize| units.lengths[axis] / 2_f64.powi(32);
        let cells = |axis: usize| f64::from(self.cells[axis]);
        [
            (Constant::UnitX, unit(0)),
            (Constant::UnitY, unit(1)),
            (Constant::UnitZ, unit(2)),
            (Constant::CellsX, cells(0)),
            (Constant::CellsY, cells(1)),
            (Constant::CellsZ, cells(2)),
            (Constant::Cells, self.count() as f64),
        ]
    }

    /// Whether rows are framed by copies of their last and first cell.
    pub(crate) fn framed(&self) -> bool {
        self.cells[0] >= 3
    }
}
