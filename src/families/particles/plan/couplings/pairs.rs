//! Pairs from the list: repulsion, friction and noise with or without memory.

use super::Builder;
use crate::document::{Bath, Integrator};
use crate::families::BathStep;
use crate::families::particles::plan::law::{law, ranges};
use crate::families::particles::plan::own;
use crate::families::particles::plan::species::Species;
use crate::families::particles::plan::stress;
use crate::shaders::{Choices, Constant, Entry, baths, couplings, pairs};

impl Builder<'_> {
    pub(super) fn pairs(&mut self) {
        if !self.visits_pairs() {
            return;
        }
        self.pair_constants();
        let groups = self.groups(self.particles);
        let memory = self.force.remembers();
        let law = self.law();
        let seen = law
            .clone()
            .with(couplings::PairReport::Observed)
            .with_any(self.forces())
            .with_if(memory, baths::PairReport::Observed);
        let advance = self.kernel("pairs", Entry::VisitListedPairs, &law, groups);
        self.plan.advance.push(advance);
        self.report_kernel("report_pairs", Entry::VisitListedPairs, &seen, groups);
        if stress::is_needed(self.measured) {
            let stressed = law.with(couplings::PairReport::Stress).with_if(memory, baths::PairReport::Observed);
            self.stress_kernel("stress", Entry::VisitListedPairs, &stressed, groups);
        }
        let density = self.model.density_around();
        let (listed, met) = match self.model.units.dimension {
            1 => (density * (self.force.cutoff + self.force.skin), density * self.force.cutoff),
            2 => (
                1.57 * density * (self.force.cutoff + self.force.skin).powi(2),
                1.57 * density * self.force.cutoff.powi(2),
            ),
            _ => (
                2.09 * density * (self.force.cutoff + self.force.skin).powi(3),
                2.09 * density * self.force.cutoff.powi(3),
            ),
        };
        self.plan.operations_per_particle += 12.0 * listed + if memory { 160.0 } else { 75.0 } * met;
    }

    /// The pair force.
    fn law(&self) -> Choices {
        let force = self.force;
        let thermal = force.has_friction() && force.temperature > 0.0;
        let memory = force.remembers();
        let friction = match self.model.integrator {
            Integrator::GrootWarren { .. } => pairs::Friction::Velocity,
            _ => pairs::Friction::DiscreteGradient,
        };
        law(force)
            .with_if(self.spares(), couplings::Exclusions::Listed)
            .with(if memory { baths::Pairs::Memory } else { baths::Pairs::White })
            .with_if(memory && thermal, baths::PairNoise::Thermal)
            .with_if(!memory && force.has_friction(), friction)
            .with_if(!memory && thermal, pairs::Random::Thermal)
            .with_if(thermal, self.pair_noise())
    }

    /// Whether some listed pairs are spared their repulsion.
    pub(super) fn spares(&self) -> bool {
        self.model.particles().bonds.as_ref().is_some_and(|bonds| bonds.kinds.iter().any(|kind| kind.exclude_repulsion))
            && self.force.largest_repulsion() > 0.0
    }

    fn pair_constants(&mut self) {
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

    /// What a kernel needs of a pair of species: impulse of half a step by the repulsion at contact, and without memory the
    /// impulses of friction (per unit velocity; of one mass, momentum) and noise, with memory the response of the bath to
    /// its coupling function and its deviation at rest.
    pub(super) fn pair_impulses(&self, a: usize, b: usize) -> [f64; 3] {
        if self.model.species.is_empty() {
            return [0.0; 3];
        }
        let repulsion = self.force.repulsion(a, b) * self.impulse();
        let step = self.force.bath_step(a, b, self.model.time_step);
        if self.force.remembers() {
            return [repulsion, step.response(), step.deviation(self.force.temperature)];
        }
        let friction = 0.5 * self.model.time_step * self.force.friction(a, b) / self.species.mass();
        [repulsion, friction, step.noise(self.force.temperature) * self.impulse()]
    }

    /// The table of coefficients where there are several species: for every pair of species what [`Self::pair_impulses`]
    /// gives and the inverse mass of the second, then for every species the position bath, then what pairs have of their own.
    pub(super) fn coefficient_table(&self) -> Vec<f32> {
        let count = self.model.species.len();
        let mut table = Vec::with_capacity(4 * count * (count + 1));
        for a in 0..count {
            for b in 0..count {
                table.extend(self.pair_impulses(a, b).map(|value| value as f32));
                table.push(Species::inverse_mass(&self.model.species[b]) as f32);
            }
        }
        for species in 0..count {
            table.extend(own::coefficients(&self.scales(), species).map(|value| value as f32));
            table.push(0.0);
        }
        table.extend(ranges(self.force, count));
        table
    }
}
