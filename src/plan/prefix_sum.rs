//! The prefix sum over cells, which tells where each of them begins among the ordered particles.

use super::{Kernel, Options};

/// Cells that a single workgroup still scans faster than three kernels would.
const SINGLE_SCAN_CELLS: u64 = 1 << 14;

/// What the kernels of a prefix sum are made of.
pub(crate) struct PrefixSum<'a> {
    /// Modules of every kernel, those that know rows and cells among them.
    pub modules: Vec<&'static str>,
    /// Modules that sum up a row.
    pub row_scan: &'static [&'static str],
    /// Modules that begin the step, or `common/same_step` where it has begun.
    pub clock: &'a [&'static str],
    /// Rows of cells.
    pub rows: u64,
    /// Cells.
    pub cells: u64,
}

impl PrefixSum<'_> {
    /// The kernels, in order.
    pub fn kernels(&self, options: Options) -> Vec<Kernel> {
        let kernel = |name, more: &[&[&'static str]], workgroups| {
            Kernel::new(name, [&self.modules[..], &more.concat()].concat(), workgroups)
        };
        let lanes = &["common/scan_wide", "common/workgroup_scan"];
        if !needs_levels(self.cells, options) {
            let all_rows = &["common/scan_all_rows", "kernels/scan"];
            return vec![kernel("scan", &[self.row_scan, lanes, self.clock, all_rows], 1)];
        }
        vec![
            kernel("scan_blocks", &[self.row_scan, lanes, &["kernels/scan_blocks"]], self.rows.div_ceil(256)),
            kernel("scan_tops", &[lanes, self.clock, &["kernels/scan_tops"]], 1),
            kernel("scan_rows", &[self.row_scan, &["kernels/scan_rows"]], self.rows.div_ceil(options.workgroup())),
        ]
    }
}

/// Whether so many cells are summed in several levels.
pub(crate) fn needs_levels(cells: u64, options: Options) -> bool {
    cells > SINGLE_SCAN_CELLS || options.many_level_scan
}

impl super::Plan {
    /// Adds the buffer of the sums between the levels of a prefix sum, if there are any.
    pub(crate) fn add_row_sums(&mut self, rows: u64, cells: u64, options: Options) {
        if needs_levels(cells, options) {
            self.add_buffer("row_sums", "prefix sums over rows", 8 * (rows + rows.div_ceil(256)));
        }
    }
}
