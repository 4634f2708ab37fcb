//! Pairs from the list: repulsion, friction and noise with or without memory.

use super::PairForce;
use crate::document::Bath;
use crate::families::BathStep;
use crate::families::particles::plan::step::{Builder, GatheringKernels};
use crate::families::particles::plan::stress;
use crate::families::particles::space::shear::plan as shear;
use crate::families::particles::terms::PlannedTerm;
use crate::shaders::{Choices, Constant, Entry, baths, couplings};

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
        let law = self.choices().and(&self.law_of_listed()).and(&shear::of_visits(self.model));
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

    /// The pair force.
    fn law_of_listed(&self) -> Choices {
        let force = self.force;
        let memory = force.remembers();
        Choices::new().with(if memory { baths::Pairs::Memory } else { baths::Pairs::White })
    }

    /// Whether some listed pairs are excluded from their repulsion.
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
