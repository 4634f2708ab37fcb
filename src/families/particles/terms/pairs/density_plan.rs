//! Local densities, on which the many-body repulsion depends: a pass over pairs before the others.

use crate::families::particles::plan::step::{Builder, Masks};
use crate::shaders::{Array, Choices, Constant, pairs};

/// Units of a density that another particle in the same place adds: shaders/pairs/density.wgsl.
const UNITS: f64 = 1_048_576.0;

/// Kernels that find densities, if there are any.
#[derive(Debug, Default)]
pub(crate) struct DensityKernels {
    /// At every step.
    pub step: Vec<usize>,
    /// Of the configuration at a report, with their part of its curvature.
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

    /// Makes the kernels of densities. That of a report leaves rows of sums after the given number of rows, which it raises.
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
