//! Analyses of the particles that a report leaves in the order of their ids, for every path of integration.

use super::recording::{SAMPLE_ROWS, record_histogram, record_sums};
use super::{Kernel, Plan, Sampler, SamplerId, Table, Window};
use crate::families::Model;
use crate::scene::{
    AnalysisId, Autocorrelation, ChainSizes, CorrelatedQuantity, CountedQuantity, Diffusion, Frame, Histogram, Output,
    Viscosity,
};
use crate::shaders::analyses::{Counted, Frame as CentreFrame, Sampled};
use crate::shaders::{Choices, Entry};
use std::f64::consts::PI;

/// Workgroups that count into one histogram: more of them write more often to the same entries.
const HISTOGRAM_GROUPS: u64 = 1024;
/// Entries of a histogram beside its bins: values below, values above, particles far beyond.
pub(crate) const HISTOGRAM_EXTRA: usize = 3;
/// Sums of powers after the counts of a histogram.
pub(crate) const HISTOGRAM_MOMENTS: usize = 5;
/// Particles further out than this, in ranges, do not enter the sums of powers.
pub(crate) const HISTOGRAM_FARTHEST: f64 = 8.0;
/// The default range of a histogram in typical magnitudes.
const RANGE: f64 = 6.0;

/// What a path of integration leaves after a report.
pub(crate) struct Reported<'a> {
    /// The model.
    pub model: &'a Model,
    /// The first step sampled.
    pub equilibration: u64,
    /// Lanes of a workgroup.
    pub workgroup: u64,
    /// The vector space, the stored particle, and where its mass is found.
    pub choices: Choices,
    /// The buffer of particles by id.
    pub particles: &'static str,
    /// The buffer of momenta by id, where velocities are not to be taken from the particles; there only if
    /// [`needs_velocities`].
    pub momenta: Option<&'static str>,
    /// The buffer of forces by id, in integer units; there only if [`needs_forces`].
    pub forces: &'static str,
    /// The force that one unit in that buffer stands for.
    pub force_unit: f64,
}

/// Whether an analysis asks for the forces of a report.
pub(crate) fn needs_forces(output: &Output) -> bool {
    output.autocorrelations.iter().any(|asked| asked.quantity == CorrelatedQuantity::Force)
        || output.histograms.iter().any(|asked| asked.quantity == CountedQuantity::Acceleration)
}

/// Whether an analysis asks for the velocities of a report.
pub(crate) fn needs_velocities(output: &Output) -> bool {
    output.autocorrelations.iter().any(|asked| asked.quantity == CorrelatedQuantity::Velocity)
        || output.histograms.iter().any(|asked| asked.quantity != CountedQuantity::Acceleration)
}

/// Adds everything a scene asks for about reported particles to a plan.
pub(crate) fn add(plan: &mut Plan, reported: &Reported<'_>, output: &Output) {
    let mut builder = Builder { plan, reported, centre: None };
    if let Some(asked) = &output.diffusion {
        builder.diffusion(asked);
    }
    if let Some(asked) = &output.viscosity {
        builder.viscosity(asked);
    }
    if let Some(asked) = &output.chain_sizes {
        builder.chain_sizes(asked);
    }
    for asked in &output.autocorrelations {
        builder.autocorrelation(asked);
    }
    for asked in &output.histograms {
        builder.histogram(asked);
    }
}

/// The value of one unit in which products of forces are summed, over the square of the unit of forces: sums of all
/// particles have room for forces that give each sixteen times its natural momentum in a step.
fn force_product_quantum(particles: u64) -> f64 {
    ((particles.max(1) as f64).log2().ceil() - 6.0).max(0.0).exp2()
}

/// The value of one unit of the sums of an autocorrelation.
pub(crate) fn correlation_quantum(plan: &Plan, quantity: CorrelatedQuantity) -> f64 {
    match quantity {
        CorrelatedQuantity::Velocity => plan.quanta.velocity_squared,
        CorrelatedQuantity::Force => plan.force_unit.powi(2) * force_product_quantum(plan.particles),
    }
}

/// The value of one unit of the powers that a histogram sums, in powers of its range.
pub(crate) fn moment_quantum(particles: u64) -> f64 {
    let largest = HISTOGRAM_FARTHEST.powi(4).log2();
    let values = (3.0 * particles.max(1) as f64).log2().ceil();
    (-(62.0 - largest - values).min(40.0)).exp2()
}

/// The largest magnitude that a histogram counts.
pub(crate) fn histogram_range(model: &Model, asked: &Histogram) -> f64 {
    let scale = || match asked.quantity {
        CountedQuantity::Velocity | CountedQuantity::Speed => velocity_scale(model),
        CountedQuantity::Acceleration => acceleration_scale(model),
    };
    asked.range.unwrap_or_else(|| RANGE * scale())
}

/// The mass of the lightest species that has particles.
fn lightest(model: &Model) -> f64 {
    let present = model.species.iter().filter(|species| species.count > 0);
    let lightest = present.map(|species| species.mass).fold(f64::INFINITY, f64::min);
    if lightest.is_finite() { lightest } else { 1.0 }
}

/// A typical component of the velocity of the lightest species: thermal, or that of the unit of momentum.
fn velocity_scale(model: &Model) -> f64 {
    let mass = lightest(model);
    if model.temperature > 0.0 {
        (model.temperature / mass).sqrt()
    } else {
        model.units.momentum * 2_f64.powi(24) / mass
    }
}

/// A typical component of the acceleration, the largest of all species: √(kT/m) √(ω² + min(2Γ/dt, 4/dt²)), where the
/// repulsion of evenly spread neighbours makes a frequency ω, ω² = Σ aρV(rc)/(d rc m), and their friction a rate
/// Γ = Σ γρ\[ω\]/(d m), whose noise no more than turns a velocity round in a step. Without a temperature it is that
/// of the strongest contact.
fn acceleration_scale(model: &Model) -> f64 {
    let Some(force) = model.pair_force() else { return 1.0 };
    let dimension = model.units.dimension as f64;
    let (cutoff, exponent) = (force.cutoff, force.weight_exponent);
    let (sphere, weight) = if model.units.dimension == 2 {
        (PI * cutoff.powi(2), 2.0 * PI * cutoff.powi(2) / ((exponent + 1.0) * (exponent + 2.0)))
    } else {
        let weight = 8.0 * PI * cutoff.powi(3) / ((exponent + 1.0) * (exponent + 2.0) * (exponent + 3.0));
        (4.0 / 3.0 * PI * cutoff.powi(3), weight)
    };
    let step = model.time_step;
    let squares = model.species.iter().enumerate().filter(|(_, species)| species.count > 0).map(|(a, species)| {
        let sum = |coefficient: &dyn Fn(usize) -> f64| -> f64 {
            let others = model.species.iter().enumerate();
            others.map(|(b, other)| coefficient(b) * other.count as f64 / model.units.volume()).sum()
        };
        let frequency = sum(&|b| force.stiffness(a, b)) * sphere / (dimension * cutoff * species.mass);
        let rate = sum(&|b| force.friction(a, b)) * weight / (dimension * species.mass);
        model.temperature / species.mass * (frequency + (2.0 * rate / step).min(4.0 / (step * step)))
    });
    let square = squares.fold(0.0, f64::max);
    if square > 0.0 {
        return square.sqrt();
    }
    let contact = force.largest_repulsion() / lightest(model);
    if contact > 0.0 { contact } else { 1.0 }
}

/// What distinguishes one sampler of sums from another.
struct SumSampler {
    id: AnalysisId,
    entry: Entry,
    choices: Choices,
    constants: Vec<(&'static str, f64)>,
    renamed: Vec<(&'static str, &'static str)>,
    before: Vec<usize>,
    sums: &'static str,
    samples: &'static str,
    quantities: usize,
    every: u64,
    window: Option<Window>,
}

struct Builder<'a> {
    plan: &'a mut Plan,
    reported: &'a Reported<'a>,
    /// The kernels that find the centre of mass, once there is a need for them.
    centre: Option<Vec<usize>>,
}

impl Builder<'_> {
    /// Workgroups with a lane for every particle.
    fn groups(&self) -> u64 {
        self.plan.particles.div_ceil(self.reported.workgroup).max(1)
    }

    /// How the velocity of a particle is read.
    fn velocity(&self) -> Sampled {
        if self.reported.momenta.is_some() { Sampled::Momentum } else { Sampled::Velocity }
    }

    /// Where the variables of particles, momenta and forces are found, and these.
    fn renamed(&self, more: &[(&'static str, &'static str)]) -> Vec<(&'static str, &'static str)> {
        let here = [("particles", self.reported.particles), ("reported_forces", self.reported.forces)];
        let momenta = self.reported.momenta.map(|buffer| ("reported_momenta", buffer));
        here.into_iter()
            .chain(momenta)
            .chain(more.iter().copied())
            .filter(|(variable, buffer)| variable != buffer)
            .collect()
    }

    /// A sampler whose kernel reads the particles by id and leaves its sums to `record_sample`.
    fn sums(&mut self, sampler: &SumSampler) {
        let groups = self.groups();
        let renamed = [&[("partial_sums", sampler.sums), ("samples", sampler.samples)][..], &sampler.renamed].concat();
        let sums = self.plan.add_kernel(
            Kernel::new(sampler.id.name(), sampler.entry, self.reported.choices.clone().and(&sampler.choices), groups)
                .with([&sampler.constants[..], &[("QUANTITIES", sampler.quantities as f64)]].concat())
                .renamed(self.renamed(&renamed)),
        );
        let recorded = record_sums("record_sample", sampler.quantities as u64, groups);
        let record =
            self.plan.add_kernel(recorded.renamed(vec![("partial_sums", sampler.sums), ("samples", sampler.samples)]));
        self.plan.add_buffer(sampler.sums, "sums of each workgroup", 8 * sampler.quantities as u64 * groups);
        let row = 8 * (1 + sampler.quantities as u64);
        self.plan.add_buffer(sampler.samples, "rows of sums waiting to be read", 8 + SAMPLE_ROWS * row);
        self.plan.samplers.push(Sampler {
            id: SamplerId::Analysis(sampler.id),
            first: self.reported.equilibration,
            every: sampler.every,
            kernels: [&sampler.before[..], &[sums, record]].concat(),
            samples: sampler.samples,
            quantities: sampler.quantities,
            capacity: SAMPLE_ROWS,
            needs_report: true,
            window: sampler.window,
        });
    }

    fn diffusion(&mut self, asked: &Diffusion) {
        let unit = self.reported.model.units.momentum;
        let quanta = self.plan.quanta;
        self.plan.add_buffer("trackers", "each particle's way since the window began", 64 * self.plan.particles);
        self.sums(&SumSampler {
            id: AnalysisId::Diffusion,
            entry: Entry::TrackParticles,
            choices: Choices::new(),
            constants: vec![
                ("WINDOW", asked.window as f64),
                ("DISPLACEMENT", 1.0 / quanta.length_squared),
                ("VELOCITY", unit * unit / quanta.velocity_squared),
            ],
            renamed: Vec::new(),
            before: Vec::new(),
            sums: "diffusion_sums",
            samples: "diffusion_samples",
            quantities: 2,
            every: asked.every,
            window: Some(Window { buffer: "trackers", samples: asked.window.max(1) }),
        });
    }

    fn viscosity(&mut self, asked: &Viscosity) {
        let dimension = self.reported.model.units.dimension;
        self.sums(&SumSampler {
            id: AnalysisId::Viscosity,
            entry: Entry::SumTransverseModes,
            choices: Choices::new(),
            constants: Vec::new(),
            renamed: Vec::new(),
            before: Vec::new(),
            sums: "mode_sums",
            samples: "mode_samples",
            quantities: 2 * dimension * (dimension - 1),
            every: asked.every,
            window: None,
        });
    }

    fn chain_sizes(&mut self, asked: &ChainSizes) {
        let groups = self.reported.model.chain_groups();
        let chains: u64 = groups.iter().map(|group| u64::from(group.chains)).sum();
        let quantities = 2 * groups.len();
        self.plan.add_long_table("chain_starts", "where each chain begins", Table::Chains(groups.to_vec()));
        self.sums(&SumSampler {
            id: AnalysisId::ChainSizes,
            entry: Entry::MeasureChains,
            choices: Choices::new(),
            constants: vec![("CHAINS", chains as f64), ("CHAIN_LENGTH", 1.0 / self.plan.quanta.length_squared)],
            renamed: Vec::new(),
            before: Vec::new(),
            sums: "chain_sums",
            samples: "chain_samples",
            quantities,
            every: asked.every,
            window: None,
        });
    }

    /// Velocities in their frame, and the kernels that have to run before they can be read.
    fn velocities(&mut self, asked: Option<Frame>) -> (Choices, Vec<usize>) {
        let velocity = Choices::new().with(self.velocity());
        let model = self.reported.model;
        let natural = if model.conserves_momentum() { Frame::Box } else { Frame::CentreOfMass };
        if asked.unwrap_or(natural) == Frame::Box {
            return (velocity, Vec::new());
        }
        if let Some(kernels) = &self.centre {
            return (velocity.with(CentreFrame::CentreOfMass), kernels.clone());
        }
        let groups = self.groups();
        let mass: f64 = model.species.iter().map(|species| species.mass * species.count as f64).sum();
        let sums = self.plan.add_kernel(
            Kernel::new("sum_momenta", Entry::SumMomenta, self.reported.choices.clone(), groups)
                .with(vec![("QUANTITIES", 3.0)])
                .renamed(self.renamed(&[("partial_sums", "momentum_sums")])),
        );
        let find = self.plan.add_kernel(
            Kernel::new("find_centre", Entry::FindCentre, Choices::new(), 1)
                .with(vec![
                    ("GROUPS", groups as f64),
                    ("INVERSE_TOTAL_MASS", if mass > 0.0 { 1.0 / mass } else { 0.0 }),
                ])
                .renamed(vec![("partial_sums", "momentum_sums")]),
        );
        self.plan.add_buffer("momentum_sums", "sums of each workgroup", 24 * groups);
        self.plan.add_buffer("centre", "velocity of the centre of mass", 16);
        self.centre = Some(vec![sums, find]);
        (velocity.with(CentreFrame::CentreOfMass), vec![sums, find])
    }

    fn autocorrelation(&mut self, asked: &Autocorrelation) {
        let unit = match asked.quantity {
            CorrelatedQuantity::Velocity => self.reported.model.units.momentum,
            CorrelatedQuantity::Force => self.reported.force_unit,
        };
        let quantum = correlation_quantum(self.plan, asked.quantity);
        let (choices, before, [origins, sums, samples]) = match asked.quantity {
            CorrelatedQuantity::Velocity => {
                let (velocities, before) = self.velocities(asked.frame);
                let names = ["velocity_origins", "velocity_products", "velocity_product_samples"];
                (velocities, before, names)
            }
            CorrelatedQuantity::Force => {
                let names = ["force_origins", "force_products", "force_product_samples"];
                (Choices::new().with(Sampled::Force), Vec::new(), names)
            }
        };
        self.plan.add_buffer(origins, "each particle's vector when the window began", 16 * self.plan.particles);
        self.sums(&SumSampler {
            id: AnalysisId::Autocorrelation(asked.quantity),
            entry: Entry::CorrelateVectors,
            choices,
            constants: vec![("WINDOW", asked.window as f64), ("PRODUCT", unit * unit / quantum)],
            renamed: vec![("origins", origins)],
            before,
            sums,
            samples,
            quantities: 1,
            every: asked.every,
            window: Some(Window { buffer: origins, samples: asked.window.max(1) }),
        });
    }

    fn histogram(&mut self, asked: &Histogram) {
        let model = self.reported.model;
        let (unit, choices, before, [counts, samples]) = match asked.quantity {
            CountedQuantity::Velocity | CountedQuantity::Speed => {
                let (velocities, before) = self.velocities(asked.frame);
                let names = if asked.quantity == CountedQuantity::Velocity {
                    ["velocity_counts", "velocity_count_samples"]
                } else {
                    ["speed_counts", "speed_count_samples"]
                };
                (model.units.momentum, velocities, before, names)
            }
            CountedQuantity::Acceleration => {
                let names = ["acceleration_counts", "acceleration_count_samples"];
                (self.reported.force_unit, Choices::new().with(Sampled::Acceleration), Vec::new(), names)
            }
        };
        let magnitude = asked.quantity == CountedQuantity::Speed;
        let range = histogram_range(model, asked);
        let bins = u64::from(asked.bins);
        let groups = self.groups().min(HISTOGRAM_GROUPS);
        let axes = match asked.axis {
            Some(axis) => [axis as usize, axis as usize + 1],
            None => [0, model.units.dimension],
        };
        let mut constants = vec![
            ("BINS", bins as f64),
            ("COUNTS", (bins + HISTOGRAM_EXTRA as u64) as f64),
            // From minus to plus the range there are twice as many half bins as from zero.
            ("HALF_BINS", if magnitude { 2.0 } else { 1.0 } * bins as f64 * unit / range),
            ("HALF_BELOW", if magnitude { 0.0 } else { bins as f64 }),
            ("FRACTION", unit / range),
            ("MOMENT", 1.0 / moment_quantum(self.plan.particles)),
            ("GROUPS", groups as f64),
        ];
        let counted = if magnitude {
            Counted::Magnitude
        } else {
            constants.extend([("FIRST_AXIS", axes[0] as f64), ("END_AXIS", axes[1] as f64)]);
            Counted::Components
        };
        let choices = self.reported.choices.clone().and(&choices).with(counted);
        let id = AnalysisId::Histogram(asked.quantity);
        let count = self.plan.add_kernel(
            Kernel::new(id.name(), Entry::CountHistogram, choices, groups)
                .with(constants)
                .renamed(self.renamed(&[("histogram", counts)])),
        );
        let entries = bins + (HISTOGRAM_EXTRA + HISTOGRAM_MOMENTS) as u64;
        let record = record_histogram(entries).renamed(vec![("histogram", counts), ("samples", samples)]);
        let record = self.plan.add_kernel(record);
        // About a mebibyte.
        let capacity = ((1 << 17) / (1 + entries)).clamp(16, SAMPLE_ROWS);
        self.plan.add_buffer(counts, "counts of each bin and sums of powers", 8 * entries);
        self.plan.add_buffer(samples, "histograms waiting to be read", 8 * (1 + capacity * (1 + entries)));
        self.plan.samplers.push(Sampler {
            id: SamplerId::Analysis(id),
            first: self.reported.equilibration,
            every: asked.every,
            kernels: [&before[..], &[count, record]].concat(),
            samples,
            quantities: entries as usize,
            capacity,
            needs_report: true,
            window: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_powers_fit_64_bits_however_many_particles() {
        for particles in [1, 1000, u64::from(u32::MAX)] {
            let largest = 3.0 * particles as f64 * HISTOGRAM_FARTHEST.powi(4) / moment_quantum(particles);
            assert!(largest <= 2_f64.powi(62), "{particles}: {largest}");
            // And a fourth power at a sixth of the range is still many units.
            assert!(6_f64.powi(-4) / moment_quantum(particles) > 10.0, "{particles}");
        }
    }
}
