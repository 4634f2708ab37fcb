//! Bonds and angles beside pairs: their kernels add impulses by sorted particle, which the passes over pairs take up.

use super::Builder;
use crate::families::particles::plan::bonded::{self, Bonded, Observed};
use crate::families::particles::plan::{shear, stress};
use crate::shaders::{Array, Choices, Constant, couplings};

/// Kernels of bonds and angles.
#[derive(Debug, Default)]
pub(super) struct BondedKernels {
    /// They add the impulses of a step.
    pub kicks: Vec<usize>,
    /// Their report; of a split step the part that belongs to the motion.
    pub report: Vec<usize>,
    /// The configuration at the report of a split step, with the impulses there.
    pub configuration: Vec<usize>,
    /// They add the stress, where an analysis needs it.
    pub stress: Vec<usize>,
}

impl Builder<'_> {
    /// Whether there are bonds or angles.
    pub(super) fn is_bonded(&self) -> bool {
        self.model.particles().are_bonded()
    }

    /// Makes the kernels of bonds and angles. Those of a report leave rows of sums after the given number of rows, which they raise.
    pub(super) fn bonded(&mut self, rows: &mut u32) -> BondedKernels {
        let scales = self.scales();
        let splits = self.splits();
        let mut kernels = BondedKernels::default();
        let excluded = bonded::excluded(&scales, &mut self.plan);
        for bonded in bonded::all(&scales).into_iter().chain(excluded) {
            self.plan.constants.extend(bonded.constants.iter().copied());
            let kicks = bonded::kicks(self.model.units.dimension);
            kernels.kicks.push(self.bonded_kernel(bonded.name, &bonded, &bonded.choices.clone().and(&kicks)));
            let mut report = |name, observed: &Observed, kicks: &Choices| {
                let kernel = self.bonded_kernel(name, &bonded, &observed.choices.clone().and(kicks));
                let first = (Constant::FirstGroup, f64::from(*rows));
                self.plan.kernels[kernel].constants.extend([first].into_iter().chain(scales.once(observed.scales)));
                *rows += self.plan.kernels[kernel].workgroups;
                kernel
            };
            let [whole, between] = bonded.reports;
            if splits {
                kernels.report.extend(bonded.motion.as_ref().map(|motion| report(whole, motion, &Choices::new())));
                let kernel = report(between, &bonded.configuration, &kicks);
                kernels.configuration.push(kernel);
                if self.is_sheared() {
                    self.plan.kernels[kernel].constants.push(shear::moment(1));
                }
            } else {
                kernels.report.push(report(whole, &bonded.observed, &Choices::new()));
            }
            if stress::is_needed(self.measured) {
                let (name, choices) = &bonded.stress;
                kernels.stress.push(self.bonded_kernel(name, &bonded, choices));
            }
            self.plan.operations_per_particle += bonded.operations * bonded.count as f64 / self.particles.max(1) as f64;
        }
        self.tethers(rows, &mut kernels);
        if self.is_bonded() {
            bonded::add_tables(&scales, &mut self.plan);
            self.plan.add_buffer(Array::Slots, 4 * self.particles);
        }
        if self.gathers() {
            self.plan.add_buffer(Array::Kicks, 16 * (self.slots + self.frame_capacity()));
        }
        kernels
    }

    fn bonded_kernel(&mut self, name: &'static str, bonded: &Bonded, choices: &Choices) -> usize {
        let choices = self.choices().with(couplings::Places::Sorted).and(choices);
        self.kernel(name, bonded.entry, choices, bonded.count)
    }
}
