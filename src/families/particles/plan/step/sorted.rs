//! Where sorted particles lie, and which kernel sums the cells: all of a plan of particles that depends on whether an adapter takes lanes one
//! after the other. Passes over pairs do not see it.

use super::{Builder, Order};
use crate::families::particles::plan::prefix_sum::needs_levels;
use crate::families::particles::plan::{Hardware, PARTICLE, Plan, Texture, Traversal};
use crate::shaders::{Array, Choices, arrays, grid, pairs};

impl Builder<'_> {
    /// The array of sorted momenta, and that in which the second of two stages of friction finds those of the first.
    pub(crate) const fn staged(&self) -> (Array, Array) {
        self.sorted.staged()
    }
}

/// Cells up to which a step ends with the prefix sum for the next one, where lanes are taken one after the other. With 1 000 cells
/// (3 000 particles) this saves a tenth of a step; with 3 000 it saves nothing any more.
const SCAN_AT_END_CELLS: u64 = 1 << 11;

/// Particles up to which one workgroup sums the cells and sorts them, where lanes are taken together: four turns of 256 lanes, each some
/// microsecond of latency, where a dispatch and its barrier are assumed to take two or three. A card has measured neither.
const SORTED_BY_ONE_WORKGROUP: u64 = 1 << 10;

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sorted {
    /// Positions and momenta lie in textures, whose texels are loaded whole.
    in_textures: bool,
    /// The prefilter of pairs reads a word of each particle and not its position.
    probes: bool,
    cells: CellSums,
}

/// Kernels that sum up cells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum CellSums {
    /// Kernels of their own.
    #[default]
    Apart,
    /// The last one of a step, for the next one.
    AtEndOfStep,
    /// One workgroup, which sorts particles too.
    WithSort,
}

impl Sorted {
    pub(crate) fn new(builder: &Builder<'_>, hardware: Hardware) -> Self {
        let (options, cells) = (builder.options, builder.grid.count());
        let serial = options.suits_serial_memory(hardware);
        let in_textures =
            builder.order == Order::EveryStep && serial && Texture::holds(builder.slots + builder.frame_capacity(), 4);
        // Probes are not read from textures. Beside two more they would be one buffer too many, and beside one where several ranks tell what
        // is stored.
        let beside = builder.more_buffers() + u32::from(options.part.is_some());
        let one_kernel = !needs_levels(cells, options) && options.part.is_none();
        // A step that visits pairs once is not ended by a traversal.
        let at_end = serial
            && one_kernel
            && builder.traversal == Traversal::Clusters
            && cells <= SCAN_AT_END_CELLS
            && !builder.visits_once();
        let with_sort = !serial && one_kernel && builder.slots <= SORTED_BY_ONE_WORKGROUP;
        Self {
            in_textures,
            probes: builder.traversal != Traversal::Alone && !in_textures && beside < 2 && !builder.is_sheared(),
            cells: if at_end {
                CellSums::AtEndOfStep
            } else if with_sort {
                CellSums::WithSort
            } else {
                CellSums::Apart
            },
        }
    }

    /// True if a step ends with the prefix sum over cells for the next one.
    pub(super) fn scans_at_end(self) -> bool {
        self.cells == CellSums::AtEndOfStep
    }

    /// True if one workgroup sums up cells and sorts particles.
    pub(super) fn is_in_one_workgroup(self) -> bool {
        self.cells == CellSums::WithSort
    }

    /// The choices of all kernels.
    pub(crate) fn choices(self) -> Choices {
        Choices::new()
            .with_if(self.in_textures, arrays::Sorted::Apart)
            .with_if(self.in_textures, grid::Sorted::Apart)
            .with_if(self.probes, grid::Probes::Kept)
    }

    /// The choices of the kernel that ends a step.
    pub(crate) fn end_of_step(self) -> Choices {
        Choices::new()
            .with_if(self.scans_at_end(), grid::EndOfStep::LastWorkgroup)
            .with_if(self.scans_at_end(), grid::ScanWidth::Narrow)
            .with_if(self.scans_at_end(), grid::ScanLanes::Eight)
    }

    /// The form in which particles are sorted; the first pass of a split step keeps its hits in the buffer of the particles.
    pub(crate) const fn copied(self, splits: bool) -> grid::Copied {
        if self.in_textures && !splits { grid::Copied::Particles } else { grid::Copied::Fours }
    }

    /// The array that the prefilter of pairs reads.
    pub(crate) const fn prefilter_source(self) -> pairs::PrefilterSource {
        if self.probes { pairs::PrefilterSource::Words } else { pairs::PrefilterSource::Positions }
    }

    /// The choices of the first of two stages of friction, which leaves momenta for the second.
    pub(crate) fn staged_choices(self) -> Choices {
        Choices::new()
            .with_if(self.in_textures, pairs::Staged::Apart)
            .with_if(self.in_textures, arrays::StagedMomenta::Texture)
    }

    const fn staged(self) -> (Array, Array) {
        if self.in_textures { (Array::SortedMomenta, Array::StagedMomenta) } else { (Array::Sorted, Array::Staged) }
    }

    /// Adds arrays of some sorted particles, twice where friction has two stages.
    pub(crate) fn add_arrays(self, plan: &mut Plan, count: u64, stages: bool) {
        let (momenta, staged) = self.staged();
        for array in [momenta].into_iter().chain(stages.then_some(staged)) {
            if self.in_textures {
                plan.add_texture(array, count);
            } else {
                plan.add_buffer(array, PARTICLE * count);
            }
        }
        if self.in_textures {
            plan.add_texture(Array::SortedPositions, count);
        }
        if self.probes {
            plan.add_buffer(Array::Probes, 4 * count);
        }
        if self.scans_at_end() {
            plan.add_buffer(Array::WorkgroupsDone, 4);
        }
    }
}
