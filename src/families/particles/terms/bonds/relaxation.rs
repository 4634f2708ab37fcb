//! Baths without memory along bonds, in the O of a split step: a kernel for each round of bonds that share no particle.

use super::plan::first_relaxed;
use crate::families::particles::plan::step::{Builder, Masks};
use crate::plan::{Need, Traversal};
use crate::shaders::{Array, Choices, Constant, Entry, pairs};

impl Builder<'_> {
    /// The kernels that relax the velocities along bonds with friction, if there are any. They add their part of the
    /// forces to what baths on particles have left, where an analysis needs them.
    pub(crate) fn relax_bonds(&mut self) -> Vec<usize> {
        let particles = self.model.particles();
        let Some(bonds) = particles.bonds.as_ref().filter(|_| particles.relaxes_bonds()) else {
            return Vec::new();
        };
        let mut kernels = Vec::new();
        if self.measured.needs(Need::Forces) && !self.relaxes_particles() && !self.reports_own_forces() {
            let pass = Choices::new().with(pairs::Pass::ForgetForces);
            kernels.push(self.traversal("forget_forces", Traversal::Alone, Masks::Unkept, &pass));
        }
        let longest = self.longest_bond();
        let mut first = first_relaxed(self.model, bonds);
        for round in bonds.rounds() {
            let count = round.len() as u64;
            let kernel = self.kernel("relax_bonds", Entry::RelaxBonds, self.choices(), count);
            let own = [(Constant::FirstRelaxed, first as f64), (Constant::Relaxed, count as f64)];
            self.plan.kernels[kernel].constants.extend(own.into_iter().chain(longest));
            self.adds_forces(kernel, true);
            kernels.push(kernel);
            first += count;
            self.plan.operations_per_particle += 120.0 * count as f64 / self.particles.max(1) as f64;
        }
        self.plan.add_buffer(Array::BondImpulses, 4 * bonds.count());
        kernels
    }
}
