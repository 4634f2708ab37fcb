//! Electrostatics on the device: charges to nodes, a Fourier transform forth and back, differences, and impulses; or wave by wave.

use super::mesh::{Stencil, Waves};
use super::{Electrostatics, exclusions};
use crate::document::CHARGE_PARTS;
use crate::families::fourier::{self, Fourier};
use crate::families::particles::plan::step::{Builder, GatheringKernels};
use crate::families::particles::plan::stress;
use crate::families::particles::terms::PlannedTerm;
use crate::plan::{Beyond, Kernel, SharedSum, Traversal, Words};
use crate::shaders::smoothing::{Load, Store};
use crate::shaders::{Array, Choices, Constant, Entry, charges};
use std::f64::consts::TAU;

/// Bits of a unit of charge on a node: what is rounded is no more than the error of a fine mesh, and all charges together fit one node
/// down to the second.
const MOST_BITS: i32 = 20;
const FEWEST_BITS: i32 = 16;
/// The largest weight of a node: of splines of four points.
const LARGEST_WEIGHT: f64 = 0.3;
/// Units of potential in that of the largest charge at its centre.
const POTENTIAL_UNITS: f64 = 262_144.0;
/// Workgroups that add up waves.
const GROUPS: u64 = 256;

impl Electrostatics {
    /// Units of charge on a node in an elementary charge.
    fn charge_units(&self) -> f64 {
        let all = self.charged.sum(f64::abs).max(1.0);
        let bits = ((2_f64.powi(31) / (LARGEST_WEIGHT * all)).log2().floor() as i32).clamp(FEWEST_BITS, MOST_BITS);
        2_f64.powi(bits)
    }

    /// The potential of one unit, in energy per elementary charge.
    fn potential_unit(&self) -> f64 {
        self.contact() * self.charged.largest() / POTENTIAL_UNITS
    }

    fn nodes(&self) -> u64 {
        self.mesh.iter().map(|nodes| u64::from(*nodes)).product()
    }

    fn fourier(&self, builder: &Builder<'_>) -> Fourier {
        Fourier {
            mesh: self.mesh,
            names: ["charge_rows", "charge_columns"],
            workgroup: builder.workgroup_size(),
            by_lanes: builder.options.butterflies_by_lanes != Some(false),
            load: Load::Charges,
            store: Store::Potentials,
        }
    }

    /// Layers of a cloud that an invocation works on: all where invocations are few at a time and would find the same weights again.
    fn layers_of_invocation(&self, builder: &Builder<'_>) -> u32 {
        if builder.traversal == Traversal::Clusters { self.order } else { 1 }
    }

    fn add_numbers_of_mesh(&self, builder: &mut Builder<'_>) {
        let lengths = builder.model.units.lengths;
        let Stencil { weights, divisor } = Stencil::new(self.order);
        let impulse = |axis: usize| {
            let spacing = lengths[axis] / f64::from(self.mesh[axis]);
            // Three weights are in 2⁻²⁴.
            builder.scales().impulse() * self.potential_unit() * 2_f64.powi(-72) / (divisor * spacing)
        };
        let impulses = [impulse(0), impulse(1), impulse(2)];
        builder.plan.constants.extend([
            (Constant::ChargeNodesX, f64::from(self.mesh[0])),
            (Constant::ChargeNodesY, f64::from(self.mesh[1])),
            (Constant::ChargeNodesZ, f64::from(self.mesh[2])),
            (Constant::CloudShare, f64::from(self.layers_of_invocation(builder))),
            (Constant::ChargeUnit, self.charge_units() * 2_f64.powi(-72)),
            (Constant::DifferenceOne, weights[0]),
            (Constant::DifferenceTwo, weights[1]),
            (Constant::DifferenceThree, weights[2]),
            (Constant::ChargeImpulseX, impulses[0]),
            (Constant::ChargeImpulseY, impulses[1]),
            (Constant::ChargeImpulseZ, impulses[2]),
        ]);
    }

    /// Numbers of reports, for waves with an energy per square of their amplitude and weight.
    fn add_numbers(&self, energy: f64, builder: &mut Builder<'_>) {
        let lengths = builder.model.units.lengths;
        let quanta = builder.scales().quanta;
        let [width, decrease] = self.cloud.slope();
        let mobile = Self::mobile_part(&builder.model.species);
        builder.plan.constants.extend([
            (Constant::Charged, self.charged.count() as f64),
            (Constant::ChargeEnergy, energy / quanta.pair_energy),
            (Constant::ChargeCurvature, 2.0 * mobile * quanta.pair_energy / quanta.curvature),
            (Constant::ChargeWidth, width),
            (Constant::ChargeDecrease, decrease),
            (Constant::WaveX, TAU / lengths[0]),
            (Constant::WaveY, TAU / lengths[1]),
            (Constant::WaveZ, TAU / lengths[2]),
        ]);
    }

    fn add_buffers(&self, fourier: &Fourier, builder: &mut Builder<'_>) {
        let lengths = builder.model.units.lengths;
        let scale = 1.0 / (lengths.iter().product::<f64>() * self.charge_units() * self.potential_unit());
        // A field comes back twice its nodes' number times as large, and the potential is a sum over waves.
        let scale = scale * self.nodes() as f64 / fourier.gain();
        builder.plan.buffers.extend(fourier.buffers());
        for (array, scale, for_energies) in [(Array::Symbols, scale, false), (Array::ChargeEnergies, 1.0, true)] {
            let electrostatics = self.clone();
            builder.plan.add_long_table(array, WaveTable { electrostatics, lengths, scale, for_energies });
        }
        builder.plan.add_buffer(Array::NodeCharges, 4 * self.nodes());
        builder.plan.add_buffer(Array::NodePotentials, 4 * self.nodes());
    }
}

/// The kernels by which waves are summed, and how those of reports find the waves.
pub(super) struct Summed {
    /// From charges to impulses.
    pub kicks: Vec<usize>,
    /// From charges to waves.
    pub forth: Vec<usize>,
    /// From waves to impulses, with the conservative forces that a report observes.
    pub back: Vec<usize>,
    /// Variants and numbers by which reports find a wave.
    pub choices: Choices,
    pub constants: Vec<(Constant, f64)>,
    pub renamed: Vec<(Array, Array)>,
    /// Number of waves.
    pub waves: u64,
    /// Energy of a wave per square of its amplitude and weight.
    pub energy: f64,
    /// Arithmetic of a step.
    pub operations: f64,
}

impl Electrostatics {
    /// The kernels that gather impulses: one of some parts of every charge, and the one that takes back what rounding gave all.
    pub(super) fn pulls(
        &self,
        name: &'static str,
        entry: Entry,
        parts: u64,
        choices: &Choices,
        builder: &mut Builder<'_>,
    ) -> [usize; 2] {
        let count = self.charged.count();
        let pull = builder.kernel(name, entry, choices.clone(), parts * count);
        if let Some(part) = &mut builder.plan.part {
            let division = part.part.division;
            part.sums.push(SharedSum::everywhere(Array::ChargeImpulses, Beyond::Wrapped, 3, pull, &division));
        }
        [pull, builder.kernel("balance_charges", Entry::BalanceCharges, choices.clone(), count)]
    }

    /// By a mesh.
    fn through_mesh(&self, builder: &mut Builder<'_>) -> Summed {
        let fourier = self.fourier(builder);
        self.add_numbers_of_mesh(builder);
        self.add_buffers(&fourier, builder);
        let spline = if self.order == 4 { charges::Spline::Four } else { charges::Spline::Six };
        let choices = builder.choices().with(spline).and(&builder.kicks());
        let layers = u64::from(self.order / self.layers_of_invocation(builder));
        let spread =
            builder.kernel("spread_charges", Entry::SpreadCharges, choices.clone(), layers * self.charged.count());
        let passes: Vec<usize> = fourier.kernels().into_iter().map(|kernel| builder.plan.add_kernel(kernel)).collect();
        if let Some(part) = &mut builder.plan.part {
            let division = part.part.division;
            part.sums.push(SharedSum::everywhere(Array::NodeCharges, Beyond::Marked, self.nodes(), spread, &division));
        }
        let mut pulls = |choices: &Choices| self.pulls("pull_charges", Entry::PullCharges, layers, choices, builder);
        let pull = pulls(&choices);
        let pulled = pulls(&choices.clone().with(charges::Report::Observed));
        let (turn, spectrum) = fourier.spectrum();
        let spectrum = builder.plan.add_kernel(Kernel { name: "charge_spectrum", ..spectrum });
        let [_, height, depth] = self.mesh;
        // Rows that went through as one come apart twice as large.
        let amplitude = 0.5 / self.charge_units();
        Summed {
            kicks: [&[spread], &passes[..], &pull].concat(),
            forth: [&[spread], &passes[..turn], &[spectrum]].concat(),
            back: [&passes[turn..], &pulled].concat(),
            choices: choices.with(charges::Wave::OfMesh),
            constants: vec![
                (Constant::WaveColumns, f64::from(fourier.columns())),
                (Constant::MeshHeight, f64::from(height)),
                (Constant::MeshDepth, f64::from(depth)),
            ],
            renamed: if turn.is_multiple_of(2) { Vec::new() } else { vec![(Array::Waves, Array::WavesNext)] },
            waves: u64::from(fourier.columns()) * u64::from(height) * u64::from(depth),
            energy: 0.5 * amplitude.powi(2) / builder.model.units.lengths.iter().product::<f64>(),
            operations: 12.0 * f64::from(self.order).powi(3) * self.charged.count() as f64 + 40.0 * self.nodes() as f64,
        }
    }
}

impl PlannedTerm for Electrostatics {
    fn gather(&self, builder: &mut Builder<'_>, rows: &mut u32, kernels: &mut GatheringKernels) {
        builder.plan.add_long_table(Array::Charged, ChargedTable { electrostatics: self.clone() });
        builder.plan.add_buffer(Array::ChargeImpulses, 12);
        let Summed { kicks, forth, back, choices, constants, renamed, waves, energy, operations } =
            match self.largest_wave {
                Some(largest) => self.one_by_one(largest, builder),
                None => self.through_mesh(builder),
            };
        self.add_numbers(energy, builder);
        kernels.kicks.extend(kicks);
        // Every rank has all waves; the first reports them.
        let reports = builder.options.part.is_none_or(|part| part.rank == 0);
        let splits = builder.splits();
        let groups = waves.div_ceil(builder.workgroup_size()).min(GROUPS);
        let over_waves = |name, entry, more| {
            let own = [
                more,
                (Constant::ChargeWaves, if reports { waves as f64 } else { 0.0 }),
                (Constant::Groups, groups as f64),
            ];
            let own = [&own[..], &constants].concat();
            Kernel::new(name, entry, choices.clone(), groups).with(own).renamed(renamed.clone())
        };
        let stress = stress::is_needed(builder.measured).then(|| {
            builder.plan.add_buffer(Array::ChargeStresses, 8 * 6 * groups);
            builder.plan.constants.push((Constant::ChargeRows, groups as f64));
            let mut kernel = over_waves("stress_charges", Entry::StressCharges, (Constant::Quantities, 6.0));
            kernel.constants.push((Constant::ChargeStress, energy / stress::unit(builder.model)));
            kernel.renamed.push((Array::PartialSums, Array::ChargeStresses));
            builder.plan.add_kernel(kernel)
        });
        let mut report = |name, sums: f64| {
            let kernel = over_waves(name, Entry::ReportCharges, (Constant::ChargeSums, sums));
            let kernel = builder.plan.add_kernel(kernel);
            builder.leaves_rows(kernel, rows);
            kernel
        };
        if splits {
            let motion = report("report_charges", 1.0);
            kernels.report.extend(forth.iter().copied().chain([motion]).chain(stress));
            let between = report("report_charges_between", 2.0);
            kernels.configuration.extend([&forth[..], &[between], &back].concat());
        } else {
            let report = report("report_charges", 0.0);
            kernels.report.extend(forth.into_iter().chain([report]).chain(stress).chain(back));
        }
        if let Some(bonds) = exclusions::excluding(builder.model) {
            exclusions::add_table(self, bonds, &mut builder.plan);
            let scales = builder.scales();
            let bonded = exclusions::bonded(self, bonds, &scales);
            builder.couple(&bonded, rows, kernels);
        }
        builder.plan.operations_per_particle += operations / builder.particles.max(1) as f64;
    }
}

/// The weights of waves up to the middle of every axis.
#[derive(Debug, Clone, PartialEq)]
struct WaveTable {
    electrostatics: Electrostatics,
    lengths: [f64; 3],
    scale: f64,
    for_energies: bool,
}

impl Words for WaveTable {
    fn count(&self) -> u64 {
        self.electrostatics.mesh.map(|nodes| u64::from(nodes / 2 + 1)).iter().product()
    }

    fn words(&self) -> Vec<u32> {
        let waves = Waves::new(&self.electrostatics, self.lengths);
        let weight = |wave: [u32; 3]| {
            let wave = waves.wave(wave);
            ((self.scale * if self.for_energies { wave.energy } else { wave.potential }) as f32).to_bits()
        };
        fourier::waves(self.electrostatics.mesh).map(weight).collect()
    }
}

/// Number and charge of every particle with a charge.
#[derive(Debug, Clone, PartialEq)]
struct ChargedTable {
    electrostatics: Electrostatics,
}

impl Words for ChargedTable {
    fn count(&self) -> u64 {
        2 * self.electrostatics.charged.count()
    }

    fn words(&self) -> Vec<u32> {
        let of =
            |(particle, charge): (u64, i32)| [particle as u32, ((f64::from(charge) / CHARGE_PARTS) as f32).to_bits()];
        self.electrostatics.charged.iter().flat_map(of).collect()
    }
}
