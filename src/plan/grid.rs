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
    /// The windows of the prefilter by bytes.
    pub bytes: ByteWindows,
}

/// Windows of the box that the prefilter by bytes divides into 256 units on each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ByteWindows {
    /// Windows in the box on each axis.
    pub count: [u32; 3],
    /// Above the square of the distance in units of any two particles within the cutoff.
    pub reach: u32,
}

impl ByteWindows {
    /// Windows of at least three cells, so that particles a window apart are no candidates of each other, and units that are as equal on all
    /// axes as whole numbers of windows allow.
    fn new(units: &Units, cutoff: f64, cells: [u32; 3]) -> Self {
        let axes = 0..units.dimension;
        let unit = |axis: usize, count: u32| units.lengths[axis] / (256.0 * f64::from(count));
        let coarsest = axes.clone().map(|axis| unit(axis, (cells[axis] / 3).max(1))).fold(0.0, f64::max);
        let mut count = [0; 3];
        for axis in axes.clone() {
            count[axis] = ((unit(axis, 1) / coarsest * (1.0 + 1e-12)).floor() as u32).max(1);
        }
        let finest = axes.clone().map(|axis| unit(axis, count[axis])).fold(f64::INFINITY, f64::min);
        // Rounding adds this to a difference on each axis, the fourth byte at most one: shaders/pairs/prefilter/bytes.wgsl.
        let rounding = axes.map(|axis| if axis == 0 { 1.0 } else { 1.5_f64 }.powi(2)).sum::<f64>().sqrt();
        let reach = (cutoff / finest * (1.0 + 1e-5) + rounding).powi(2) + 1.0;
        // No word is further from another than this.
        Self { count, reach: reach.min(65536.0) as u32 + 1 }
    }
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
        let bytes = ByteWindows::new(units, cutoff, cells);
        Self { dimension, cells, windows, ratios, reach_squared: reach * reach, bytes }
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    /// The word of a place in 2⁻³² of the box, and whether two words may be within the cutoff: shaders/pairs/prefilter/bytes.wgsl.
    fn word(windows: ByteWindows, place: [u32; 3], further: u32) -> u32 {
        let byte = |axis: usize| {
            let moved = if axis > 0 && windows.count[axis] > 0 { further } else { 0 };
            place[axis].wrapping_mul(windows.count[axis]).wrapping_add(moved) >> 24
        };
        byte(0) | byte(1) << 8 | byte(2) << 16
    }

    fn hits(windows: ByteWindows, probe: u32, candidate: u32) -> bool {
        let apart = probe.wrapping_sub(candidate).to_le_bytes().map(|byte| i32::from(byte.cast_signed()));
        (apart.map(|byte| byte * byte).iter().sum::<i32>() as u32) < windows.reach
    }

    #[test]
    fn bytes_never_miss_a_neighbour() {
        let mut random = StdRng::seed_from_u64(4);
        let boxes = [
            (3, [69.0, 69.0, 69.0]),
            (3, [3.0, 3.0, 3.0]),
            (3, [2.01, 2.5, 40.0]),
            (3, [7.3, 11.9, 1000.0]),
            (2, [5.0, 31.7, 1.0]),
            (1, [12.0, 1.0, 1.0]),
        ];
        for (dimension, lengths) in boxes {
            let units = Units { dimension, lengths, gaps: [0.0; 3], momentum: 1.0 };
            let volume: f64 = lengths.iter().product();
            for particles in [(3.0 * volume) as u64, 20] {
                let grid = Grid::new(&units, 1.0, particles);
                for axis in 0..dimension {
                    let (cells, windows) = (grid.cells[axis], grid.bytes.count[axis]);
                    assert!(
                        windows >= 1 && (windows == 1 || 3 * windows <= cells),
                        "{lengths:?}: {windows} of {cells}"
                    );
                }
                for _ in 0..100_000 {
                    let first: [u32; 3] =
                        std::array::from_fn(|axis| if axis < dimension { random.random() } else { 0 });
                    // Any direction, most often just within the cutoff.
                    let way: [f64; 3] =
                        std::array::from_fn(|axis| if axis < dimension { random.random_range(-1.0..1.0) } else { 0.0 });
                    let length = way.iter().map(|part| part * part).sum::<f64>().sqrt().max(1e-9);
                    let distance = 1.0 - random.random_range(0.0..1.0_f64).powi(8);
                    let second: [u32; 3] = std::array::from_fn(|axis| {
                        let steps = way[axis] / length * distance / lengths[axis] * 2_f64.powi(32);
                        first[axis].wrapping_add((steps.trunc() as i64) as u32)
                    });
                    let (probe, candidate) = (word(grid.bytes, first, 1 << 23), word(grid.bytes, second, 0));
                    assert!(hits(grid.bytes, probe, candidate), "{lengths:?}: {first:?} and {second:?}");
                }
            }
        }
    }

    #[test]
    fn bytes_find_little_else() {
        let mut random = StdRng::seed_from_u64(5);
        for (lengths, most) in
            [([69.0; 3], 1.13), ([30.0, 31.0, 100.0], 1.22), ([5.0; 3], 1.18), ([40.0, 40.0, 2.5], 1.8)]
        {
            let units = Units { dimension: 3, lengths, gaps: [0.0; 3], momentum: 1.0 };
            let grid = Grid::new(&units, 1.0, 1_000_000);
            let (mut found, mut near) = (0, 0);
            for _ in 0..200_000 {
                // Candidates are up to two cells away.
                let first: [u32; 3] = std::array::from_fn(|_| random.random());
                let way: [f64; 3] = std::array::from_fn(|_| random.random_range(-2.0..2.0));
                let second: [u32; 3] = std::array::from_fn(|axis| {
                    first[axis].wrapping_add((way[axis] / lengths[axis] * 2_f64.powi(32)) as i64 as u32)
                });
                found += u32::from(hits(grid.bytes, word(grid.bytes, first, 1 << 23), word(grid.bytes, second, 0)));
                // In a thin slab the nearest copy is another one.
                let nearest = |axis: usize| way[axis] - lengths[axis] * (way[axis] / lengths[axis]).round();
                near += u32::from((0..3).map(|axis| nearest(axis).powi(2)).sum::<f64>() < 1.0);
            }
            let ratio = f64::from(found) / f64::from(near);
            assert!(ratio > 1.0 && ratio < most, "{lengths:?}: {ratio}");
        }
    }
}
