//! The plan: everything a run does on the device, as plain data that can be printed, compared and tested without one.

mod compared;
mod failure;
mod grid;
mod layout;
pub(crate) mod paths;
mod physics;
mod precision;
pub(crate) mod prefix_sum;
pub(crate) mod recording;
pub(crate) mod serial_memory;
mod table;
mod texture;

pub use compared::Compared;
pub use failure::{Failure, FailureKind};
pub use grid::Grid;
pub use layout::{Layout, Length, Misfit, StateLayout};
pub(crate) use layout::{Places, content};
pub use paths::Paths;
pub(crate) use physics::{Measured, Need, Ordered, PhysicsPlan, Reported};
pub use precision::check_precision;
pub use table::{Table, Words};
pub use texture::Texture;

use std::collections::BTreeSet;

use crate::document::{AnalysisId, Distribution};
use crate::noise::Generator;
use crate::shaders::noise::Deviate;
use crate::shaders::{self, Array, Choices, Constant, Entry};
use crate::state::Units;

/// Folds a number of workgroups into two dimensions of at most 65 535; a few of them may find nothing to do.
pub(crate) fn folded(workgroups: u32) -> [u32; 2] {
    const LIMIT: u32 = 65_535;
    if workgroups <= LIMIT {
        [workgroups, 1]
    } else {
        let height = workgroups.div_ceil(LIMIT);
        [workgroups.div_ceil(height), height]
    }
}

/// What the plan may use of the adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Hardware {
    /// Lanes of every subgroup, if fixed and usable.
    pub subgroup_size: Option<u32>,
    /// Whether lanes load and store one after the other, as on software adapters: every access to a buffer is expensive, and one of
    /// eight bytes costs no more than one of four; texels of a texture are loaded whole.
    pub serial_memory: bool,
}

impl Hardware {
    /// Whether it pays that a subgroup works on eight particles or cells together: where every subgroup has eight lanes and these are the
    /// lanes of a processor's vectors. Lanes of a GPU need not run in step after a loop that they leave at different times.
    ///
    /// ```
    /// use mesoscope::plan::Hardware;
    ///
    /// let processor = Hardware { subgroup_size: Some(8), serial_memory: true };
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
    /// Lanes of a workgroup, where neither a subgroup nor a prefix sum decides: raised to a power of two of at most 256; 64
    /// if `None`.
    pub workgroup_size: Option<u32>,
    /// Capacity for copies of particles in the frames of rows; a quarter more than expected if `None`.
    pub copies: Option<u64>,
    /// How the particles of shallow water are stored; chosen from their number in a cell if `None`.
    pub storage: Option<Storage>,
    /// Whether kernels are adapted to lanes that run one after the other; left to the hardware if `None`.
    pub serial_memory: Option<bool>,
    /// Whether pairs without memory are kept in a list too, for integrators with one traversal a step.
    pub listed: bool,
    /// How often the capacity of the list for the pairs of a particle has been doubled.
    pub list_growth: u32,
    /// The most pairs that one dispatch examines for a radial distribution function; about a second's work if `None`.
    pub pairs_in_dispatch: Option<u64>,
    /// Prefix sum over cells in several levels even where one workgroup would do.
    pub many_level_scan: bool,
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

    /// Whether kernels are adapted to lanes that run one after the other.
    #[must_use]
    pub fn suits_serial_memory(&self, hardware: Hardware) -> bool {
        self.serial_memory.unwrap_or(hardware.serial_memory)
    }

    /// Lanes of a workgroup: a power of two, because sums over a workgroup are halved again and again.
    #[must_use]
    pub fn workgroup(&self) -> u64 {
        u64::from(self.workgroup_size.unwrap_or(64).clamp(1, 256)).next_power_of_two()
    }
}

/// How pairs, and the cells of a mesh, are visited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Traversal {
    /// One invocation a particle or cell; for any adapter.
    Rows,
    /// Eight particles or cells a subgroup; only where subgroups have eight lanes.
    Clusters,
    /// No pairs at all: none has a force on each other.
    Alone,
}

/// Steps after which particles are sorted in memory: rarely enough to cost almost nothing, and often enough that neighbours in space
/// stay neighbours in memory.
pub const TIDYING: u64 = 32;

/// How the particles of shallow water are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// Sorted by cell every step: for any number of particles in a cell.
    Sorted,
    /// In a bin of fixed capacity for every cell, without a sort: faster on small meshes, as long as none is full.
    Bins,
}

/// A kernel: its entry point and variants, its constants and its size.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    /// What it does, in a word or two.
    pub name: &'static str,
    /// Its entry point.
    pub entry: Entry,
    /// The variants chosen for it; those of slots that it does not reach have no effect.
    pub choices: Choices,
    /// Number of workgroups.
    pub workgroups: u32,
    /// The position of its number of workgroups in the buffer `demands`, which has three words for each, if that depends on the step.
    pub demand: Option<u32>,
    /// Constants of this kernel only; all others come from [`Plan::constants`].
    pub constants: Vec<(Constant, f64)>,
    /// Variables in whose place it has another buffer or texture: `(variable, in its place)`.
    pub renamed: Vec<(Array, Array)>,
    /// Whether it may take so long that it has to be the last of a submission: systems with a watchdog end a submission that takes
    /// seconds.
    pub takes_long: bool,
}

/// What a buffer holds before the first step.
#[derive(Debug, Clone, PartialEq)]
pub enum Contents {
    /// Zeros.
    Zeros,
    /// These bytes.
    Bytes(Vec<u8>),
    /// A table that grows with the number of particles and is generated on upload.
    Table(Table),
}

impl Contents {
    /// The bytes; `None` for zeros.
    #[must_use]
    pub fn bytes(&self) -> Option<std::borrow::Cow<'_, [u8]>> {
        match self {
            Self::Zeros => None,
            Self::Bytes(bytes) => Some(bytes.into()),
            Self::Table(table) => Some(table.bytes().into()),
        }
    }
}

/// A buffer on the device; kernels find it by the name of its array.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffer {
    /// What it holds.
    pub array: Array,
    /// Size in bytes.
    pub bytes: u64,
    /// Initial contents.
    pub contents: Contents,
}

/// What a sampler is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SamplerId {
    /// The observables.
    Observables,
    /// An analysis.
    Analysis(AnalysisId),
}

impl SamplerId {
    /// Its name, for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Observables => "observables",
            Self::Analysis(analysis) => analysis.name(),
        }
    }
}

/// Kernels that turn the particles of a report into one row of sums.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampler {
    /// What is sampled.
    pub id: SamplerId,
    /// The first step sampled.
    pub first: u64,
    /// Steps between two samples.
    pub every: u64,
    /// Kernels in order, as indices into [`Plan::kernels`].
    pub kernels: Vec<usize>,
    /// The buffer that receives the rows.
    pub samples: Array,
    /// Number of sums in a row.
    pub quantities: usize,
    /// Rows the buffer holds.
    pub capacity: u64,
    /// Whether the kernels read the particles that the report leaves in the order of their ids.
    pub needs_report: bool,
    /// What stays on the device from one sample to the next, if anything.
    pub window: Option<Window>,
}

/// A window of samples, each compared with the first: a buffer of the plan holds the particles as they were then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// The buffer.
    pub buffer: Array,
    /// Samples in a window; the next begins a new one.
    pub samples: u64,
}

/// Values of the integer units in which the observables are summed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quanta {
    /// Kinetic energy.
    pub energy: f64,
    /// Energy and virial of pairs.
    pub pair_energy: f64,
    /// Square of a force.
    pub force_squared: f64,
    /// Second derivative of the potential.
    pub curvature: f64,
    /// Square of a length.
    pub length_squared: f64,
    /// Square of a velocity.
    pub velocity_squared: f64,
    /// Square of a bath variable.
    pub bath_squared: f64,
}

/// Everything a run does on the device.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Number of particles.
    pub particles: u64,
    /// Scales of the integer state.
    pub units: Units,
    /// Cells on each axis.
    pub cells: [u32; 3],
    /// How the integer state lies in buffers and textures.
    pub layout: Layout,
    /// Units of the observables' sums.
    pub quanta: Quanta,
    /// Key of the noise stream.
    pub seed_key: [u32; 2],
    /// Time step.
    pub time_step: f64,
    /// The force of one unit in the buffer of forces that a report leaves by id; zero where no analysis asks for them.
    pub force_unit: f64,
    /// A time step worth trying where this one turns out to be unstable.
    pub suggested_step: f64,
    /// All kernels.
    pub kernels: Vec<Kernel>,
    /// Constants for all kernels that declare them.
    pub constants: Vec<(Constant, f64)>,
    /// All buffers.
    pub buffers: Vec<Buffer>,
    /// All textures: arrays that are loaded lane by lane where that is expensive.
    pub textures: Vec<Texture>,
    /// Kernels that run once after an upload. Where steps end with the beginning of the next one, they also begin the first step.
    pub prepare: Vec<usize>,
    /// Kernels that begin a step, unless the end of the previous step has done so, and sort the particles.
    pub sort: Vec<usize>,
    /// Kernels that sort the particles in memory too, every [`TIDYING`] steps: neighbours in memory load faster, and the results are
    /// the same.
    pub tidy: Vec<usize>,
    /// Kernels between the sort and the report.
    pub before_report: Vec<usize>,
    /// Kernels that report: sums of observables, and particles in order of id.
    pub report: Vec<usize>,
    /// Kernels that finish a step without a report.
    pub advance: Vec<usize>,
    /// Kernels that finish a step after a report.
    pub finish_report: Vec<usize>,
    /// The samplers; the first is that of the observables.
    pub samplers: Vec<Sampler>,
    /// How often particles go round the box, where a trajectory asks.
    pub paths: Paths,
    /// The most storage buffers that one kernel binds, before any of them is kept in a texture; at least eight, which every adapter
    /// allows.
    pub storage_buffers: u32,
    /// The buffer in which a report leaves the particles by number and how they lie there, if it is not the one that holds
    /// the state.
    pub reported: Option<(Array, Layout)>,
    /// Arithmetic operations a particle and step, an estimate from the density.
    pub operations_per_particle: f64,
}

/// The shader of the noise of a pair or a mesh node.
pub(crate) fn deviate(distribution: Distribution) -> Deviate {
    match distribution {
        Distribution::Uniform => Deviate::Uniform,
        Distribution::Gaussian => Deviate::Gaussian,
    }
}

/// The shader that draws random words.
pub(crate) fn words(generator: Generator) -> shaders::noise::Generator {
    match generator {
        Generator::Pcg4d => shaders::noise::Generator::Pcg4d,
        Generator::Threefry2x32 => shaders::noise::Generator::Threefry,
    }
}

impl Kernel {
    /// A kernel of at least one workgroup, without constants of its own.
    pub(crate) fn new(name: &'static str, entry: Entry, choices: Choices, workgroups: u64) -> Self {
        Self {
            name,
            entry,
            choices,
            workgroups: workgroups.max(1) as u32,
            demand: None,
            constants: Vec::new(),
            renamed: Vec::new(),
            takes_long: false,
        }
    }

    /// Paths of the pages and variants that it reaches, below `shaders` and without extensions.
    ///
    /// ```
    /// use mesoscope::families::Model;
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let scene = mesoscope::scene::load("dpd-fluid", &[])?;
    /// let plan = plan(&Model::new(&scene), 0, &scene.output, Hardware::default(), Options::default());
    /// let step = &plan.kernels[plan.advance[0]];
    /// assert!(step.files()?.contains("pairs/friction/relaxation"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`shaders::Unlinked`] if it does not link.
    pub fn files(&self) -> Result<BTreeSet<&'static str>, shaders::Unlinked> {
        let linked = shaders::linked_text(self.entry, &self.choices)?;
        Ok(linked.parts.iter().map(|part| part.path).collect())
    }

    /// The same with constants of its own.
    pub(crate) fn with(self, constants: Vec<(Constant, f64)>) -> Self {
        Self { constants, ..self }
    }

    /// The same with other buffers and textures in the place of variables.
    pub(crate) fn renamed(self, renamed: Vec<(Array, Array)>) -> Self {
        Self { renamed, ..self }
    }

    /// The buffer or texture that a variable stands for.
    ///
    /// ```
    /// use mesoscope::families::Model;
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    /// use mesoscope::shaders::{Array, Entry};
    ///
    /// let asked = r#"output.viscosity={"every":10,"window":50}"#.to_owned();
    /// let scene = mesoscope::scene::load("dpd-fluid", &[asked])?;
    /// let plan = plan(&Model::new(&scene), 0, &scene.output, Hardware::default(), Options::default());
    /// let kernel = plan.kernels.iter().find(|kernel| kernel.entry == Entry::SumTransverseModes);
    /// let array_of = |variable| kernel.map(|kernel| kernel.array_of(variable));
    /// assert_eq!(array_of(Array::PartialSums), Some(Array::ModeSums));
    /// assert_eq!(array_of(Array::Particles), Some(Array::Particles));
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn array_of(&self, variable: Array) -> Array {
        self.renamed.iter().find(|(known, _)| *known == variable).map_or(variable, |(_, array)| *array)
    }

    /// Its own constants, then those of the plan that it does not set for itself.
    pub fn constants_in<'a>(&'a self, plan: &'a Plan) -> impl Iterator<Item = (Constant, f64)> + 'a {
        let own = |name: Constant| self.constants.iter().any(|(known, _)| *known == name);
        self.constants.iter().chain(plan.constants.iter().filter(move |(name, _)| !own(*name))).copied()
    }
}

impl Sampler {
    /// Whether a sample is due at a step.
    #[must_use]
    pub fn due(&self, step: u64) -> bool {
        step >= self.first && (step - self.first).is_multiple_of(self.every)
    }

    /// Number of samples before a step.
    ///
    /// ```
    /// # use mesoscope::plan::{Hardware, Options};
    /// # use mesoscope::{families::Model, run::plan, scene};
    /// let scene = scene::load("dpd-fluid", &[r#"output={"energies":{"every":20}}"#.to_owned()])?;
    /// let plan = plan(&Model::new(&scene), 0, &scene.output, Hardware::default(), Options::default());
    /// assert_eq!([0, 1, 20, 21].map(|step| plan.samplers[0].samples_before(step)), [0, 1, 1, 2]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn samples_before(&self, step: u64) -> u64 {
        step.saturating_sub(self.first).div_ceil(self.every.max(1))
    }

    /// The buffer of the window that is open before the sample of a step, and the number of its samples so far.
    #[must_use]
    pub fn open_window(&self, step: u64) -> Option<(Array, u64)> {
        let window = self.window?;
        let taken = self.samples_before(step) % window.samples;
        (taken > 0).then_some((window.buffer, taken))
    }
}

impl Plan {
    /// A plan of no particles that does nothing yet.
    pub(crate) fn new(units: Units, layout: impl StateLayout, quanta: Quanta) -> Self {
        Self {
            particles: 0,
            units,
            cells: [1; 3],
            layout: Layout::new(layout),
            quanta,
            seed_key: [0; 2],
            time_step: 0.0,
            force_unit: 0.0,
            suggested_step: 0.0,
            kernels: Vec::new(),
            constants: Vec::new(),
            buffers: Vec::new(),
            textures: Vec::new(),
            prepare: Vec::new(),
            sort: Vec::new(),
            tidy: Vec::new(),
            before_report: Vec::new(),
            report: Vec::new(),
            advance: Vec::new(),
            finish_report: Vec::new(),
            samplers: Vec::new(),
            paths: Paths::default(),
            storage_buffers: 8,
            reported: None,
            operations_per_particle: 0.0,
        }
    }

    /// Adds a kernel and returns its index.
    pub(crate) fn add_kernel(&mut self, kernel: Kernel) -> usize {
        self.kernels.push(kernel);
        self.kernels.len() - 1
    }

    /// Adds a kernel unless the same one is there already, and returns its index.
    pub(crate) fn add_kernel_once(&mut self, kernel: Kernel) -> usize {
        let same = |known: &Kernel| known.entry == kernel.entry && known.choices == kernel.choices;
        self.kernels.iter().position(same).unwrap_or_else(|| self.add_kernel(kernel))
    }

    /// Adds a buffer of zeros.
    pub(crate) fn add_buffer(&mut self, array: Array, bytes: u64) {
        self.add_buffer_with(array, bytes, Contents::Zeros);
    }

    /// Adds a buffer of these bytes.
    pub(crate) fn add_table(&mut self, array: Array, contents: Vec<u8>) {
        self.add_buffer_with(array, contents.len() as u64, Contents::Bytes(contents));
    }

    /// Adds a buffer of a table that grows with the number of particles.
    pub(crate) fn add_long_table(&mut self, array: Array, words: impl Words) {
        let table = Table::new(words);
        self.add_buffer_with(array, table.length(), Contents::Table(table));
    }

    pub(crate) fn add_buffer_with(&mut self, array: Array, bytes: u64, contents: Contents) {
        self.buffers.push(Buffer { array, bytes: bytes.max(64).next_multiple_of(16), contents });
    }

    /// Whether there is a buffer of an array.
    #[must_use]
    pub fn has_buffer(&self, array: Array) -> bool {
        self.buffers.iter().any(|buffer| buffer.array == array)
    }

    /// Bytes of all buffers and textures.
    ///
    /// ```
    /// use mesoscope::families::Model;
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let scene = mesoscope::scene::load("dpd-fluid", &["particles.0.number_density=6".to_owned()])?;
    /// let plan = plan(&Model::new(&scene), 0, &scene.output, Hardware::default(), Options::default());
    /// // At least positions and momenta; a few MiB in all for 48 000 particles.
    /// assert!(plan.bytes() > 24 * plan.particles && plan.bytes() < 64 << 20);
    /// let textures: u64 = plan.textures.iter().map(|texture| texture.bytes()).sum();
    /// assert_eq!(plan.bytes(), textures + plan.buffers.iter().map(|buffer| buffer.bytes).sum::<u64>());
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let textures = self.textures.iter().map(Texture::bytes);
        self.buffers.iter().map(|buffer| buffer.bytes).chain(textures).sum()
    }

    /// The same plan without reports, samples and analyses: the steps alone, to measure their speed.
    ///
    /// ```
    /// use mesoscope::families::Model;
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let scene = mesoscope::scene::load("dpd-fluid", &[])?;
    /// let plan = plan(&Model::new(&scene), 0, &scene.output, Hardware::default(), Options::default());
    /// let steps = plan.clone().without_reports();
    /// assert!(steps.samplers.is_empty() && steps.kernels.len() < plan.kernels.len());
    /// let names = |plan: &mesoscope::plan::Plan| -> Vec<&str> {
    ///     plan.sort.iter().chain(&plan.advance).map(|kernel| plan.kernels[*kernel].name).collect()
    /// };
    /// assert_eq!(names(&steps), names(&plan));
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn without_reports(mut self) -> Self {
        self.samplers.clear();
        self.report.clear();
        self.finish_report.clear();
        let mut kept: Vec<usize> = Vec::new();
        let stages = [
            &mut self.prepare,
            &mut self.sort,
            &mut self.tidy,
            &mut self.before_report,
            &mut self.advance,
            &mut self.paths.kernels,
        ];
        for kernel in stages.into_iter().flatten() {
            let place = kept.iter().position(|known| known == kernel).unwrap_or(kept.len());
            if place == kept.len() {
                kept.push(*kernel);
            }
            *kernel = place;
        }
        self.kernels = kept.into_iter().map(|kernel| self.kernels[kernel].clone()).collect();
        self
    }

    /// The largest buffer in bytes.
    #[must_use]
    pub fn largest_buffer(&self) -> u64 {
        self.buffers.iter().map(|buffer| buffer.bytes).max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{Hardware, Options, folded};
    use crate::families::Model;
    use crate::run::plan;
    use crate::scene;

    #[test]
    fn plans_without_reports_have_the_kernels_they_name() {
        for builtin in scene::builtin() {
            // One whose particles are followed too.
            for set in [&[][..], &[r#"output.trajectory={"every":5}"#.to_owned()]] {
                let scene = scene::load(builtin.name, set).unwrap();
                let model = Model::new(&scene);
                let whole = plan(&model, 0, &scene.output, Hardware::default(), Options::default());
                let steps = whole.clone().without_reports();
                let stages = |plan: &super::Plan| {
                    let stages = [&plan.prepare, &plan.sort, &plan.tidy, &plan.before_report, &plan.advance];
                    let named = stages.into_iter().chain([&plan.paths.kernels]).flatten();
                    named.map(|kernel| plan.kernels[*kernel].name).collect::<Vec<_>>()
                };
                assert_eq!(stages(&steps), stages(&whole), "{}", builtin.name);
            }
        }
    }

    #[test]
    fn folding_covers_every_workgroup() {
        for count in [1, 65_535, 65_536, 131_071, 1_000_000, 20_000_000] {
            let [width, height] = folded(count);
            assert!(width <= 65_535 && height <= 65_535);
            assert!(u64::from(width) * u64::from(height) >= u64::from(count));
        }
    }
}
