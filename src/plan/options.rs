//! What may be chosen of a plan, by the adapter and by who asks for it, without changing a bit of its results.

use super::Part;
use crate::gpu::ConstantsIn;

/// What the plan may use of the adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Hardware {
    /// Lanes of every subgroup, if fixed and usable.
    pub subgroup_size: Option<u32>,
    /// Whether lanes load and store one after the other, as on software adapters: every access to a buffer is expensive, and one of
    /// eight bytes costs no more than one of four; texels of a texture are loaded whole.
    pub serial_memory: bool,
    /// True if the lanes of a workgroup share a queue of pairs, where a lane would visit all pairs of a particle.
    pub queues_pairs: bool,
    /// Bytes that a kernel can bind of one array; a larger one lies in portions. As many as an array has if `None`.
    pub largest_binding: Option<u64>,
}

impl Hardware {
    /// Whether it pays that a subgroup works on eight particles or cells together: where every subgroup has eight lanes and these are the
    /// lanes of a processor's vectors. Lanes of a GPU need not run in step after a loop that they leave at different times.
    ///
    /// ```
    /// use mesoscope::plan::Hardware;
    ///
    /// let processor = Hardware { subgroup_size: Some(8), serial_memory: true, ..Hardware::default() };
    /// assert!(processor.takes_eights());
    /// assert!(!Hardware { serial_memory: false, ..processor }.takes_eights());
    /// ```
    #[must_use]
    pub fn takes_eights(&self) -> bool {
        self.subgroup_size == Some(8) && self.serial_memory
    }
}

/// Choices that change how a scene is computed but not a bit of its results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// How pairs, and the cells of a mesh, are visited; left to the hardware if `None`.
    pub traversal: Option<Traversal>,
    /// Workgroups that share a row of cells; chosen from the sizes if `None`.
    pub segments: Option<u32>,
    /// Lanes of a workgroup, where neither a subgroup nor a prefix sum decides: raised to a power of two of at most 128,
    /// for which every adapter has workgroup memory; 64 if `None`.
    pub workgroup_size: Option<u32>,
    /// Capacity for copies of particles in the frames of rows; a quarter more than expected if `None`.
    pub copies: Option<u64>,
    /// How the particles of shallow water are stored; chosen from their number in a cell if `None`.
    pub storage: Option<Storage>,
    /// Whether kernels are adapted to lanes that run one after the other; left to the hardware if `None`.
    pub serial_memory: Option<bool>,
    /// Several lanes share a butterfly of many legs in Fourier transforms, as in plans for GPUs; left to the hardware if `None`.
    pub butterflies_by_lanes: Option<bool>,
    /// Whether pairs without memory are kept in a list too, for integrators with one traversal a step.
    pub listed: bool,
    /// How often the capacity of the list for the pairs of a particle has been doubled.
    pub list_growth: u32,
    /// How often the length that bonds may have among several ranks has been raised by half.
    pub lengthened: u32,
    /// How often the iterations that are recorded for a solver have been doubled.
    pub iteration_growth: u32,
    /// The most pairs that one dispatch examines for a radial distribution function; about a second's work if `None`.
    pub pairs_in_dispatch: Option<u64>,
    /// Prefix sum over cells in several levels even where one workgroup would do.
    pub many_level_scan: bool,
    /// Particles of a state that pass to a device and back, or from rank to rank, at once; chosen from their number if `None`.
    pub particles_at_once: Option<u64>,
    /// Where the constants of kernels are.
    pub constants_in: ConstantsIn,
    /// The part of one of several ranks; all of the box if `None`.
    pub part: Option<Part>,
}

impl Options {
    /// Whether a plan with a larger capacity exists.
    #[must_use]
    pub fn has_room_left(&self) -> bool {
        self.list_growth < 31
    }

    /// The same choices with a capacity for this many particles in any cell, and twice the capacity of lists.
    ///
    /// ```
    /// use mesoscope::plan::{Options, Storage};
    ///
    /// let roomy = Options::default().with_room(500);
    /// assert_eq!((roomy.copies, roomy.storage), (Some(500), Some(Storage::Sorted)));
    /// assert!(roomy.list_growth == 1 && roomy.has_room_left());
    /// ```
    #[must_use]
    pub fn with_room(self, particles: u64) -> Self {
        Self {
            copies: Some(particles),
            storage: Some(Storage::Sorted),
            list_growth: self.list_growth.saturating_add(1),
            ..self
        }
    }

    /// The same choices with twice as many iterations of a solver, if more can be asked for.
    #[must_use]
    pub fn with_more_iterations(self) -> Option<Self> {
        (self.iteration_growth < 31).then(|| Self { iteration_growth: self.iteration_growth + 1, ..self })
    }

    /// Whether longer bonds may be expected.
    pub(crate) fn may_lengthen(&self) -> bool {
        self.part.is_some() && self.lengthened < 31
    }

    /// The same choices with bonds that are half as long again.
    #[must_use]
    pub fn with_longer_bonds(self) -> Self {
        Self { lengthened: self.lengthened.saturating_add(1), ..self }
    }

    /// Whether kernels are adapted to lanes that run one after the other.
    pub(crate) fn suits_serial_memory(&self, hardware: Hardware) -> bool {
        self.serial_memory.unwrap_or(hardware.serial_memory)
    }

    /// Lanes of a workgroup: a power of two, because sums over a workgroup are halved again and again.
    #[must_use]
    pub fn workgroup(&self) -> u64 {
        u64::from(self.workgroup_size.unwrap_or(64).clamp(1, 128)).next_power_of_two()
    }
}

/// How pairs, and the cells of a mesh, are visited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Traversal {
    /// One invocation a particle or cell; for any adapter.
    Rows,
    /// The pairs of all particles of a workgroup in a queue, from which its lanes take them; cells of a mesh as with `Rows`.
    Queue,
    /// Eight particles or cells a subgroup; only where subgroups have eight lanes.
    Clusters,
    /// No pairs at all: none has a force on each other.
    Alone,
}

/// How the particles of shallow water are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// Sorted by cell every step: for any number of particles in a cell.
    Sorted,
    /// In a bin of fixed capacity for every cell, without a sort: faster on small meshes, as long as none is full.
    Bins,
}
