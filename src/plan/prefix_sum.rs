//! The prefix sum over cells: where each cell begins among the sorted particles.

use super::{Kernel, Options};
use crate::shaders::{Array, Choices, Entry};

/// Cells that a single workgroup still scans faster than three kernels would.
const SINGLE_SCAN_CELLS: u64 = 1 << 14;

/// What the kernels of a prefix sum depend on.
pub(crate) struct PrefixSum<'a> {
    /// The variants of every kernel: how cells form rows, and whether the sum begins a step.
    pub choices: &'a Choices,
    /// Rows of cells.
    pub rows: u64,
    /// Cells.
    pub cells: u64,
}

impl PrefixSum<'_> {
    /// The kernels, in order.
    pub(crate) fn kernels(&self, options: Options) -> Vec<Kernel> {
        let kernel = |name, entry, workgroups| Kernel::new(name, entry, self.choices.clone(), workgroups);
        if !needs_levels(self.cells, options) {
            return vec![kernel("scan", Entry::ScanCells, 1)];
        }
        vec![
            kernel("scan_blocks", Entry::ScanBlocks, self.rows.div_ceil(256)),
            kernel("scan_tops", Entry::ScanTops, 1),
            kernel("scan_rows", Entry::ScanRows, self.rows.div_ceil(options.workgroup())),
        ]
    }
}

/// Whether this many cells are summed in several levels.
pub(crate) fn needs_levels(cells: u64, options: Options) -> bool {
    cells > SINGLE_SCAN_CELLS || options.many_level_scan
}

impl super::Plan {
    /// Adds the buffer of the sums between the levels of a prefix sum, if there are any.
    pub(crate) fn add_row_sums(&mut self, rows: u64, cells: u64, options: Options) {
        if needs_levels(cells, options) {
            self.add_buffer(Array::RowSums, 8 * (rows + rows.div_ceil(256)));
        }
    }
}
