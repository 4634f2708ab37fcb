//! What descriptors add their samplers to a plan with.

use crate::families::Model;
use crate::plan::recording::{SAMPLE_ROWS, record_histogram, record_sums};
use crate::plan::{Kernel, Options, Ordered, PARTICLE_WORDS, PhysicsPlan, Plan, Reported, Sampler, SamplerId, Window};
use crate::scene::{AnalysisId, Frame, Output};
use crate::shaders::analyses::{Frame as CentreFrame, Measured, Sampled};
use crate::shaders::{Array, Choices, Constant, Entry};

/// A plan of the physics that samplers are added to.
pub(in crate::run) struct Planner<'a> {
    /// The plan.
    pub plan: &'a mut Plan,
    /// The model.
    pub model: &'a Model,
    /// What a scene asks for.
    pub output: &'a Output,
    /// The first step sampled.
    pub equilibration: u64,
    /// Choices that change how the scene is computed.
    pub options: Options,
    /// Particles in order of cells, where an analysis needs them.
    pub ordered: Option<&'a Ordered>,
    /// Particles by id, of a family that has analyses of them.
    reported: Option<&'a Reported>,
    /// The kernels that find the centre of mass, once there is a need for them.
    centre: Option<Vec<usize>>,
}

/// What distinguishes one sampler of sums over particles from another.
pub(super) struct SumSampler {
    /// The analysis.
    pub id: AnalysisId,
    /// The kernel that leaves a row of sums for every workgroup.
    pub entry: Entry,
    /// Its variants, beside those that find the particles.
    pub choices: Choices,
    /// Its constants.
    pub constants: Vec<(Constant, f64)>,
    /// Its variables whose buffers have other names.
    pub renamed: Vec<(Array, Array)>,
    /// Kernels that run before it.
    pub before: Vec<usize>,
    /// The buffer of the sums of workgroups.
    pub sums: Array,
    /// The buffer of rows that wait to be read.
    pub samples: Array,
    /// Number of sums in a row.
    pub quantities: usize,
    /// Steps between two samples.
    pub every: u64,
    /// What is kept from one sample to the next, if anything.
    pub window: Option<Window>,
}

impl SumSampler {
    /// A sampler of so many sums, into a buffer of those of workgroups and one of rows, without anything else.
    pub(super) fn new(
        id: AnalysisId,
        entry: Entry,
        [sums, samples]: [Array; 2],
        quantities: usize,
        every: u64,
    ) -> Self {
        Self {
            id,
            entry,
            choices: Choices::new(),
            constants: Vec::new(),
            renamed: Vec::new(),
            before: Vec::new(),
            sums,
            samples,
            quantities,
            every,
            window: None,
        }
    }
}

impl<'a> Planner<'a> {
    /// Begins with a plan of the physics.
    pub(in crate::run) fn new(
        model: &'a Model,
        output: &'a Output,
        equilibration: u64,
        options: Options,
        physics: &'a mut PhysicsPlan,
    ) -> Self {
        let PhysicsPlan { plan, reported, ordered, .. } = physics;
        let (ordered, reported) = (ordered.as_ref(), reported.as_ref());
        Self { plan, model, output, equilibration, options, ordered, reported, centre: None }
    }

    /// Workgroups with a lane for every particle.
    pub(super) fn groups(&self) -> u64 {
        self.plan.particles.div_ceil(self.options.workgroup()).max(1)
    }

    /// Particles that this device measures by id: of several ranks the first measures all of them.
    pub(super) fn measured(&self) -> u64 {
        let measures = self.plan.part.as_ref().is_none_or(|part| part.part.rank == 0);
        if measures { self.plan.particles } else { 1 }
    }

    /// A kernel that reads the particles by id, if they are reported.
    pub(super) fn kernel_of_particles(
        &self,
        name: &'static str,
        entry: Entry,
        choices: &Choices,
        groups: u64,
        renamed: &[(Array, Array)],
    ) -> Option<Kernel> {
        let reported = self.reported?;
        let here = [(Array::Particles, reported.particles), (Array::ReportedForces, reported.forces)];
        let momenta = reported.momenta.map(|buffer| (Array::ReportedMomenta, buffer));
        let all = here.into_iter().chain(momenta).chain(renamed.iter().copied());
        let renamed = all.filter(|(variable, buffer)| variable != buffer).collect();
        Some(Kernel::new(name, entry, reported.choices.clone().and(choices), groups).renamed(renamed))
    }

    /// Constants of a kernel that measures every particle: of several ranks the first gathers those of all, which are more
    /// than have a place in its part.
    pub(super) fn of_all_particles(&self) -> Vec<(Constant, f64)> {
        self.plan.part.iter().map(|_| (Constant::Particles, self.plan.particles as f64)).collect()
    }

    /// Constants of kernels that find the way between two particles.
    pub(super) fn between(&self) -> Vec<(Constant, f64)> {
        self.reported.map_or_else(Vec::new, |reported| reported.between.clone())
    }

    /// Adds a sampler whose kernel reads the particles by id and leaves its sums to `record_sample`. Of several ranks the first measures, and
    /// gathers the particles for it.
    pub(super) fn add_sums(&mut self, sampler: &SumSampler) {
        let gathered = self.plan.part.is_some();
        if gathered && !self.plan.has_buffer(Array::Reported) {
            let bytes = 4 * u64::from(PARTICLE_WORDS) * self.measured();
            self.plan.add_buffer(Array::Reported, bytes);
        }
        let groups = self.groups();
        let rows = vec![(Array::PartialSums, sampler.sums), (Array::Samples, sampler.samples)];
        let renamed = [&rows[..], &sampler.renamed].concat();
        let kernel = self.kernel_of_particles(sampler.id.name(), sampler.entry, &sampler.choices, groups, &renamed);
        let Some(kernel) = kernel else { return };
        let constants = [&sampler.constants[..], &[(Constant::Quantities, sampler.quantities as f64)]].concat();
        let sums = self.plan.add_kernel(kernel.with(constants));
        let recorded = record_sums("record_sample", sampler.quantities as u64, groups);
        let record = self.plan.add_kernel(recorded.renamed(rows));
        self.plan.add_buffer(sampler.sums, 8 * sampler.quantities as u64 * groups);
        let kernels = [&sampler.before[..], &[sums, record]].concat();
        let plain = self.sampler(sampler.id, sampler.every, sampler.samples, sampler.quantities, SAMPLE_ROWS);
        self.plan.samplers.push(Sampler { kernels, gathered, window: sampler.window, ..plain });
    }

    /// Adds a sampler whose kernel reads the particles by id in so many workgroups and adds to as many places as there are quantities, which
    /// `record_histogram` records.
    pub(super) fn add_counts(&mut self, sampler: &SumSampler, groups: u64) {
        let renamed = [(Array::Histogram, sampler.sums)];
        let kernel = self.kernel_of_particles(sampler.id.name(), sampler.entry, &sampler.choices, groups, &renamed);
        let Some(kernel) = kernel else { return };
        let count = self.plan.add_kernel(kernel.with(sampler.constants.clone()));
        let entries = sampler.quantities as u64;
        let rows = vec![(Array::Histogram, sampler.sums), (Array::Samples, sampler.samples)];
        let record = self.plan.add_kernel(record_histogram(entries).renamed(rows));
        // About a mebibyte, or sixteen rows.
        let capacity = ((1 << 17) / (1 + entries)).clamp(16, SAMPLE_ROWS);
        self.plan.add_buffer(sampler.sums, 8 * entries);
        let kernels = [&sampler.before[..], &[count, record]].concat();
        let plain = self.sampler(sampler.id, sampler.every, sampler.samples, sampler.quantities, capacity);
        self.plan.samplers.push(Sampler { kernels, ..plain });
    }

    /// A sampler without kernels, with room in its buffer for so many rows of so many quantities.
    pub(super) fn sampler(
        &mut self,
        id: AnalysisId,
        every: u64,
        samples: Array,
        quantities: usize,
        capacity: u64,
    ) -> Sampler {
        self.plan.add_buffer(samples, 8 * (1 + capacity * (1 + quantities as u64)));
        Sampler {
            id: SamplerId::Analysis(id),
            first: self.equilibration,
            every,
            kernels: Vec::new(),
            samples,
            quantities,
            capacity,
            needs_report: true,
            gathered: false,
            window: None,
            whole: 0..0,
        }
    }

    /// How kernels choose the particles of a species, where one is named.
    pub(super) fn particles_of(&self, species: Option<&str>) -> (Option<Measured>, Option<(Constant, f64)>) {
        let number = species.and_then(|name| self.model.species_named(name));
        (number.map(|_| Measured::OfSpecies), number.map(|number| (Constant::MeasuredSpecies, number as f64)))
    }

    /// How kernels read velocities in a frame, and the kernels that have to run before.
    pub(super) fn velocities(&mut self, asked: Option<Frame>) -> (Choices, Vec<usize>) {
        let apart = self.reported.is_some_and(|reported| reported.momenta.is_some());
        let velocity = Choices::new().with(match (apart, self.model.particles().shear.is_some()) {
            (true, _) => Sampled::Momentum,
            (false, true) => Sampled::PeculiarVelocity,
            (false, false) => Sampled::Velocity,
        });
        // In a sheared box velocities are relative to the flow already.
        let in_box = self.model.conserves_momentum() || self.model.particles().shear.is_some();
        let natural = if in_box { Frame::Box } else { Frame::CentreOfMass };
        if asked.unwrap_or(natural) == Frame::Box {
            return (velocity, Vec::new());
        }
        let kernels = self.centre.clone().unwrap_or_else(|| self.find_centre());
        self.centre = Some(kernels.clone());
        (velocity.with(CentreFrame::CentreOfMass), kernels)
    }

    /// Adds the kernels that find the velocity of the centre of mass.
    fn find_centre(&mut self) -> Vec<usize> {
        let groups = self.groups();
        let sums = [(Array::PartialSums, Array::MomentumSums)];
        let kernel = self.kernel_of_particles("sum_momenta", Entry::SumMomenta, &Choices::new(), groups, &sums);
        let Some(kernel) = kernel else { return Vec::new() };
        let sum = self.plan.add_kernel(kernel.with(vec![(Constant::Quantities, 3.0)]));
        let mobile = self.model.species.iter().filter(|species| !species.fixed);
        let mass: f64 = mobile.map(|species| species.mass * species.count as f64).sum();
        let find = self.plan.add_kernel(
            Kernel::new("find_centre", Entry::FindCentre, Choices::new(), 1)
                .with(vec![
                    (Constant::Groups, groups as f64),
                    (Constant::InverseTotalMass, if mass > 0.0 { 1.0 / mass } else { 0.0 }),
                ])
                .renamed(sums.to_vec()),
        );
        self.plan.add_buffer(Array::MomentumSums, 24 * groups);
        self.plan.add_buffer(Array::Centre, 16);
        vec![sum, find]
    }
}
