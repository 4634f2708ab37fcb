//! The plan: everything a run does on the device, as plain data that can be printed, compared and tested without one.

mod buffer;
mod compared;
mod failure;
mod grid;
mod kernel;
mod layout;
mod options;
mod part;
pub(crate) mod paths;
mod physics;
mod precision;
pub(crate) mod prefix_sum;
pub(crate) mod recording;
mod sampler;
pub(crate) mod serial_memory;
mod sums;
mod table;
mod texture;

pub use buffer::{Buffer, Contents};
pub use compared::Compared;
pub use failure::{Failure, FailureKind};
pub use grid::{ByteWindows, Grid};
pub use kernel::Kernel;
pub(crate) use kernel::{folded, generator, switch};
pub(crate) use layout::content;
pub use layout::{Layout, Length, Misfit, Places, StateLayout};
pub use options::{Hardware, Options, Storage, Traversal};
pub use part::{
    Beyond, Cells, Division, Domain, Part, ParticleWords, Passage, PlannedPart, Rows, SharedSum, Stretch, Wider,
};
pub(crate) use part::{FREE_SHARE, Halo};
pub use paths::Paths;
pub(crate) use physics::{Measured, Need, Ordered, PhysicsPlan, Reported};
pub use precision::check_precision;
pub use sampler::{Sampler, SamplerId, Window};
pub use sums::{ReportRow, Sums};
pub use table::{Table, Words};
pub use texture::Texture;

use crate::gpu::{ConstantsIn, Portions, Undivided, link_once, storage_buffers};
use crate::shaders::{Array, Constant, declared_buffers};
use crate::state::Units;
use std::collections::BTreeMap;

/// Words of a particle that passes from rank to rank: `shaders/space/particle`.
pub(crate) const PARTICLE_WORDS: u32 = 8;

/// Steps after which particles are sorted in memory: rarely enough to cost almost nothing, and often enough that neighbours in space
/// stay neighbours in memory.
pub const TIDYING: u64 = 32;

/// Values of the integer units in which the observables are summed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
    /// Products with a bath variable.
    pub bath_products: ProductQuanta,
}

/// Units of the sums of products, where particles are oscillators in baths with memory.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProductQuanta {
    /// Bath variable times momentum.
    pub momentum: f64,
    /// Bath variable times displacement.
    pub displacement: f64,
    /// Momentum times displacement.
    pub momentum_displacement: f64,
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
    /// Steps that the clock of the device is ahead, where a run goes on with an earlier one.
    pub steps_before: u64,
    /// Time step.
    pub time_step: f64,
    /// The force of one unit in the buffer of forces that a report leaves by id; zero where no analysis asks for them.
    pub force_unit: f64,
    /// The virial of one unit in the buffer of stresses that a report leaves by id; zero where no analysis asks for them.
    pub stress_unit: f64,
    /// A time step worth trying where this one turns out to be unstable.
    pub suggested_step: f64,
    /// All kernels.
    pub kernels: Vec<Kernel>,
    /// Constants for all kernels that declare them.
    pub constants: Vec<(Constant, f64)>,
    /// All buffers.
    pub buffers: Vec<Buffer>,
    /// Arrays that are larger than kernels may bind, which lie in several buffers.
    pub portions: BTreeMap<Array, Portions>,
    /// Arrays that are larger than kernels may bind and cannot lie in several buffers, with the bytes of them that could.
    pub undivided: BTreeMap<Array, u64>,
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
    /// Where the constants of kernels are.
    pub constants_in: ConstantsIn,
    /// Particles of a state that pass to the device or back at once; a sixteenth, or 65 536 if that is more, if `None`.
    pub particles_at_once: Option<u64>,
    /// What it has of a run that several ranks share, if it is the plan of one of them.
    pub part: Option<PlannedPart>,
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
            steps_before: 0,
            time_step: 0.0,
            force_unit: 0.0,
            stress_unit: 0.0,
            suggested_step: 0.0,
            kernels: Vec::new(),
            constants: Vec::new(),
            buffers: Vec::new(),
            portions: BTreeMap::new(),
            undivided: BTreeMap::new(),
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
            constants_in: ConstantsIn::Code,
            particles_at_once: None,
            part: None,
        }
    }

    /// Counts the storage buffers that kernels bind.
    pub(crate) fn count_storage_buffers(&mut self) {
        let most = self.kernels.iter().fold(self.storage_buffers, |most, kernel| {
            if declared_buffers(kernel.entry, &kernel.choices) as u32 <= most {
                return most;
            }
            let constants: Vec<_> = kernel.constants_in(self).collect();
            most.max(storage_buffers(kernel.entry, &kernel.choices, &constants) as u32)
        });
        self.storage_buffers = most;
    }

    /// Divides arrays that are larger than kernels may bind into portions, but for those that a kernel needs as a whole.
    pub(crate) fn divide(&mut self, largest_binding: Option<u64>) {
        let Some(binding) = largest_binding else { return };
        let portions = |buffer: &Buffer| Some((buffer.array, Portions::new(buffer.bytes, binding)?));
        self.portions = self.buffers.iter().filter_map(portions).collect();
        if self.portions.is_empty() {
            return;
        }
        for kernel in &self.kernels {
            let Ok((_, linked)) = link_once(kernel.name, kernel.entry, &kernel.choices, self.constants_in, None) else {
                continue;
            };
            let constants: Vec<_> = kernel.constants_in(self).collect();
            let linked = linked.specialized(&constants);
            loop {
                let portions_of = |variable| self.portions.get(&kernel.array_of(variable)).copied();
                match linked.clone().divided(portions_of) {
                    Ok(divided) => {
                        self.storage_buffers = self.storage_buffers.max(divided.storage_buffers() as u32);
                        break;
                    }
                    Err(Undivided { array, most }) => {
                        let array = kernel.array_of(array);
                        self.portions.remove(&array);
                        self.undivided.insert(array, most);
                    }
                }
            }
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

    /// Bytes of a step if each of its dispatches passes once over every array that it binds; without those that depend on the step.
    #[must_use]
    pub fn bytes_bound_in_a_step(&self) -> u64 {
        let textures = self.textures.iter().map(|texture| (texture.array, texture.bytes()));
        let buffers = self.buffers.iter().map(|buffer| (buffer.array, buffer.bytes));
        let sizes: BTreeMap<Array, u64> = buffers.chain(textures).collect();
        let bound = |kernel: &Kernel| {
            let linked = link_once(kernel.name, kernel.entry, &kernel.choices, self.constants_in, None);
            let constants: Vec<_> = kernel.constants_in(self).collect();
            let bindings = linked.map(|(_, linked)| linked.specialized(&constants).bindings).unwrap_or_default();
            bindings.iter().filter_map(|binding| sizes.get(&kernel.array_of(binding.array))).sum::<u64>()
        };
        let kernels = [&self.sort, &self.before_report, &self.advance].into_iter().flatten();
        kernels.map(|kernel| &self.kernels[*kernel]).filter(|kernel| kernel.demand.is_none()).map(bound).sum()
    }

    /// True if another plan differs in constants and in what tables hold, if at all.
    pub(crate) fn differs_in_numbers(&self, other: &Self) -> bool {
        let form = |plan: &Self| {
            let Self { prepare, sort, tidy, before_report, report, advance, finish_report, .. } = plan;
            let order = [prepare, sort, tidy, before_report, report, advance, finish_report].map(Vec::clone);
            let buffers = plan.buffers.iter().map(|buffer| (buffer.array, buffer.bytes)).collect::<Vec<_>>();
            let textures = plan.textures.iter().map(|texture| (texture.array, texture.words, texture.size));
            (order, buffers, textures.collect::<Vec<_>>())
        };
        let kernels = |plan: &Self| {
            let without = |kernel: &Kernel| Kernel { constants: Vec::new(), ..kernel.clone() };
            plan.kernels.iter().map(without).collect::<Vec<_>>()
        };
        self.particles == other.particles
            && (self.constants_in, &self.samplers, &self.paths, &self.part)
                == (other.constants_in, &other.samplers, &other.paths, &other.part)
            && form(self) == form(other)
            && kernels(self) == kernels(other)
    }

    /// True if kernels have the constants that they have in another plan with as many kernels.
    pub(crate) fn has_constants_of(&self, other: &Self) -> bool {
        let constants = |plan: &Self, kernel: &Kernel| {
            let constants = kernel.constants_in(plan);
            let mut bits: Vec<_> = constants.map(|(constant, value)| (constant.name(), value.to_bits())).collect();
            bits.sort_unstable();
            bits
        };
        let mut kernels = self.kernels.iter().zip(&other.kernels);
        kernels.all(|(own, kernel)| constants(self, own) == constants(other, kernel))
    }

    /// Bytes of all buffers and textures.
    ///
    /// ```
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let scene = mesoscope::scene::load("dpd-fluid", &["particles.0.number_density=6".to_owned()])?;
    /// let plan = plan(&scene, Hardware::default(), Options::default());
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

    /// Bytes of a state: what a checkpoint keeps, and the memory of the machine holds.
    #[must_use]
    pub fn state_bytes(&self) -> u64 {
        /// Position, momentum and species.
        const PARTICLE: u64 = 28;
        let arrays = self.layout.arrays(self.particles as usize).into_iter();
        let arrays = arrays.map(|(array, length)| (4 * array.width() as u64).saturating_mul(length.expected() as u64));
        arrays.fold(PARTICLE.saturating_mul(self.particles), u64::saturating_add)
    }

    /// Bytes of the memory of the machine that a run takes at least: a state, and as much of it as passes to the device or back at
    /// once.
    #[must_use]
    pub fn host_bytes(&self) -> u64 {
        let images = if self.paths.are_followed() { 12 * self.particles } else { 0 };
        let stretch = self.stretch(&self.layout, self.particles);
        let buffers = self.layout.buffers();
        let bytes = self.buffers.iter().filter(|buffer| buffers.contains(&buffer.array)).map(|buffer| buffer.bytes);
        let passing = bytes.sum::<u64>() as f64 * (stretch as f64 / self.particles.max(1) as f64);
        self.state_bytes().saturating_add(images).saturating_add(passing as u64)
    }

    /// Particles that pass to the device or back together: few enough that what they take on the way is little beside a state.
    pub(crate) fn stretch(&self, layout: &Layout, particles: u64) -> u64 {
        let all = particles.max(1);
        let in_buffer = layout.buffers().first().is_some_and(|array| self.has_buffer(*array));
        match self.particles_at_once {
            _ if !layout.divides() || !in_buffer => all,
            at_once => at_once.unwrap_or(all.div_ceil(16).max(1 << 16)).clamp(1, all),
        }
    }

    /// The same plan without reports, samples and analyses: the steps alone, to measure their speed.
    ///
    /// ```
    /// use mesoscope::plan::{Hardware, Options};
    /// use mesoscope::run::plan;
    ///
    /// let scene = mesoscope::scene::load("dpd-fluid", &[])?;
    /// let plan = plan(&scene, Hardware::default(), Options::default());
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

    /// The largest buffer in bytes: an array, or a portion of one that is larger than kernels may bind.
    #[must_use]
    pub fn largest_buffer(&self) -> u64 {
        self.buffers.iter().map(|buffer| self.bytes_at_once(buffer)).max().unwrap_or(0)
    }

    /// Bytes of an array that a kernel binds at once.
    pub(crate) fn bytes_at_once(&self, buffer: &Buffer) -> u64 {
        self.portions.get(&buffer.array).map_or(buffer.bytes, |portions| portions.bytes)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{Hardware, Options};

    use crate::run::plan;
    use crate::scene;

    #[test]
    fn plans_without_reports_have_the_kernels_they_name() {
        for builtin in scene::builtin() {
            // One whose particles are followed too.
            let followed = scene::load(builtin.name, &[r#"output.trajectory={"every":5}"#.to_owned()]).unwrap();
            for scene in [scene::load(builtin.name, &[]).unwrap(), followed] {
                let whole = plan(&scene, Hardware::default(), Options::default());
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
}
