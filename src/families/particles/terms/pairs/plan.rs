//! Pairs on the device beside the passes over them: pairs from the list, with or without memory, local densities, on
//! which the many-body repulsion depends, and the stress.

use super::PairForce;
use crate::document::Bath;
use crate::families::BathStep;
use crate::families::particles::plan::step::{Builder, GatheringKernels, Masks, stages};
use crate::families::particles::plan::stress;
use crate::families::particles::space::shear::plan as shear;
use crate::families::particles::terms::PlannedTerm;
use crate::plan::Traversal;
use crate::shaders::{Array, Choices, Constant, Entry, baths, couplings, pairs};

/// Arithmetic of a pair in the list, and of one within the cutoff with and without memory.
const LISTED: f64 = 12.0;
const WITH_MEMORY: f64 = 160.0;
const WITHOUT_MEMORY: f64 = 75.0;

impl PlannedTerm for PairForce {
    fn gather(&self, builder: &mut Builder<'_>, rows: &mut u32, kernels: &mut GatheringKernels) {
        builder.listed_pairs(rows, kernels);
    }
}

impl Builder<'_> {
    /// Adds the kernels of listed pairs, if there is a list; that of a report raises the number of rows.
    fn listed_pairs(&mut self, rows: &mut u32, kernels: &mut GatheringKernels) {
        if !self.lists_pairs() {
            return;
        }
        self.memory_constants();
        let memory = self.force.remembers();
        let law = self.choices().with(if memory { baths::Pairs::Memory } else { baths::Pairs::White });
        let law = law.and(&shear::of_visits(self.model));
        let observed = law.clone().with_if(memory, baths::PairReport::Observed);
        let gathered = law.and(&self.kicks());
        kernels.kicks.push(self.kernel("pairs", Entry::VisitListedPairs, gathered.clone(), self.particles));
        let seen = gathered.and(&observed).with(couplings::PairReport::Observed);
        let report = self.kernel("report_pairs", Entry::VisitListedPairs, seen, self.particles);
        let once = self.scales().once(&[Constant::PairEnergy, Constant::PairVirial, Constant::Laplacian]);
        self.leaves_rows(report, rows);
        self.plan.kernels[report].constants.extend(once);
        kernels.report.push(report);
        if stress::is_needed(self.measured) {
            let stressed = observed.with(couplings::PairReport::Stress);
            kernels.stress.push(self.kernel("stress", Entry::VisitListedPairs, stressed, self.particles));
        }
        let (density, range) = (self.model.density_around(), self.force.cutoff + self.force.skin);
        // Half of the particles in a sphere, for every pair is listed once.
        let around = |radius: f64| match self.model.units.dimension {
            1 => density * radius,
            2 => 1.57 * density * radius.powi(2),
            _ => 2.09 * density * radius.powi(3),
        };
        let met = if memory { WITH_MEMORY } else { WITHOUT_MEMORY };
        self.plan.operations_per_particle += LISTED * around(range) + met * around(self.force.cutoff);
    }

    /// True if some listed pairs are excluded from their repulsion.
    pub(crate) fn leaves_pairs_out(&self) -> bool {
        self.model.particles().bonds.as_ref().is_some_and(|bonds| bonds.kinds.iter().any(|kind| kind.exclude_repulsion))
            && self.force.largest_repulsion() > 0.0
    }

    fn memory_constants(&mut self) {
        let Bath::Memory { rate, scheme, .. } = self.force.bath else { return };
        // All pairs of species have the rate in common, and with it all but the size of their baths.
        let step = BathStep::with_memory(scheme, 1.0, rate, self.model.time_step);
        let persistence = step.persistence;
        self.scales().add_bath_impulse(&mut self.plan);
        self.plan.constants.extend([
            (Constant::Persistence, persistence),
            (Constant::Loss, 1.0 - persistence),
            (Constant::Decay, persistence.abs().ln().max(-100.0)),
            (Constant::Spread, (1.0 - persistence * persistence).max(0.0).sqrt()),
            (Constant::BathEnergy, 0.5 * step.response() / self.plan.quanta.pair_energy),
        ]);
    }
}

/// Units of a density that another particle in the same place adds: shaders/pairs/density.wgsl.
const UNITS: f64 = 1_048_576.0;

/// Kernels that find densities, if there are any.
#[derive(Debug, Default)]
pub(crate) struct DensityKernels {
    /// At every step.
    pub step: Vec<usize>,
    /// Kernels of the configuration at a report, with their part of its curvature.
    pub report: Vec<usize>,
}

impl Builder<'_> {
    /// Adds the constants of the many-body repulsion, if there is one.
    pub(crate) fn density_constants(&mut self) {
        let Some(many_body) = self.force.many_body else { return };
        let strength = many_body.repulsion * many_body.contact_density();
        let impulse = 0.5 * self.model.time_step / self.model.units.momentum;
        let curvature = 2.0 * strength / (many_body.cutoff * self.plan.quanta.curvature);
        self.plan.constants.extend([
            (Constant::DensityStretch, self.force.cutoff / many_body.cutoff),
            (Constant::DensityImpulse, strength * impulse / UNITS),
            (Constant::DensityCurvature, curvature / (UNITS * UNITS)),
        ]);
    }

    /// Makes the kernels of densities. That of a report leaves rows of sums after the given number of rows, which it
    /// raises.
    pub(crate) fn densities(&mut self, masks: Masks, rows: &mut u32) -> DensityKernels {
        if self.force.many_body.is_none() {
            return DensityKernels::default();
        }
        self.plan.add_buffer(Array::Densities, 4 * self.particles);
        let step = self.traversal("densities", self.traversal, masks, &Choices::new().with(pairs::Pass::SumDensities));
        if masks == Masks::Keep {
            self.plan.kernels[step].renamed.push((Array::KeptMasks, Array::Particles));
        }
        let pass = Choices::new().with(pairs::Pass::ObserveDensities);
        let report = self.observation("report_densities", *rows, pass);
        *rows += self.plan.kernels[report].workgroups;
        DensityKernels { step: vec![step], report: vec![report] }
    }
}

impl Builder<'_> {
    /// The kernels that leave the stress of pairs, from what the report of the motion finds; none where no analysis
    /// needs it. Those of the second of two stages of friction come first.
    pub(crate) fn stress(&mut self) -> Vec<usize> {
        if !stress::is_needed(self.measured) {
            return Vec::new();
        }
        let mut kernels = vec![stress::begin(self.model, self.options.workgroup(), &mut self.plan)];
        if self.traversal == Traversal::Alone {
            return kernels;
        }
        if !self.splits() {
            kernels.push(self.stress_of_pairs("stress", pairs::Pass::LeapfrogStress));
            return kernels;
        }
        let whole = self.stress_of_pairs("stress", pairs::Pass::SplitStress);
        kernels.push(whole);
        if self.relaxes_in_two_stages() {
            let first = self.stress_of_pairs("stress_of_first_stage", pairs::Pass::FirstStageStress);
            let [first_stage, second_stage] = stages();
            self.plan.kernels[first].constants.extend(first_stage);
            self.plan.kernels[whole].constants.extend(second_stage);
            let staged = self.staged();
            self.plan.kernels[whole].renamed.push(staged);
            kernels.push(first);
        }
        kernels
    }

    fn stress_of_pairs(&mut self, name: &'static str, pass: pairs::Pass) -> usize {
        self.traversal(name, self.traversal_of_reports(), Masks::Unkept, &Choices::new().with(pass))
    }
}
