//! The order of the particles and the cells around them.

use super::Builder;

/// Rows of cells that a single workgroup still scans faster than three kernels would.
const SINGLE_SCAN_ROWS: u64 = 1024;

impl Builder<'_> {
    /// Kernels that order the particles as they are now.
    pub(super) fn geometry(&mut self) -> Vec<usize> {
        let groups = self.groups(self.particles);
        let rows = self.grid.rows();
        let mut kernels = vec![self.kernel("bin", &["common/grid2", "kernels/bin"], groups)];
        let scan = ["common/grid2", "common/cells_plain", "common/row_scan"];
        if rows <= SINGLE_SCAN_ROWS && !self.options.many_level_scan {
            let all = [&scan[..], &["common/workgroup_scan", "common/same_step", "kernels/scan"]].concat();
            kernels.push(self.kernel("scan", &all, 1));
        } else {
            let blocks = [&scan[..], &["common/workgroup_scan", "kernels/scan_blocks"]].concat();
            kernels.push(self.kernel("scan_blocks", &blocks, rows.div_ceil(256)));
            let tops = ["common/grid2", "common/workgroup_scan", "common/same_step", "kernels/scan_tops"];
            kernels.push(self.kernel("scan_tops", &tops, 1));
            let groups = self.groups(rows);
            kernels.push(self.kernel("scan_rows", &[&scan[..], &["kernels/scan_rows"]].concat(), groups));
            self.buffer("row_sums", "prefix sums over rows", 8 * (rows + rows.div_ceil(256)));
        }
        let arrange_groups = self.groups(self.particles.max(self.grid.count()));
        let unnoted = ["common/anchors_off", "common/origins_off", "common/slots_off", "kernels/arrange"];
        let sorted = ["common/grid2", "common/cells_plain", "common/sorted_plain"];
        kernels.push(self.kernel("arrange", &[&sorted[..], &unnoted].concat(), arrange_groups));
        self.buffer("sorted", "particles in order of cells", 32 * self.particles);
        self.buffer("cells", "where each cell begins", 4 * (self.grid.count() + 1 + rows));
        self.buffer("counts", "particles in each cell", 4 * self.grid.count());
        self.buffer("ranks", "place of each particle in its cell", 4 * self.particles);
        kernels
    }
}
