//! Couplings that gather impulses for the passes over particles: listed pairs, bonds, angles and tethers.

use super::{Builder, Order};
use crate::families::Bonds;
use crate::families::particles::plan::bonded::{self, Bonded, Observed};
use crate::families::particles::plan::stress;
use crate::families::particles::space::shear::plan as shear;
use crate::shaders::{Array, Choices, Constant, Entry, couplings};

/// Conservative impulses are gathered beside those of all forces.
const APART: f64 = 2.0;

/// Kernels of couplings.
#[derive(Debug, Default)]
pub(crate) struct GatheringKernels {
    /// They add the impulses of a step.
    pub kicks: Vec<usize>,
    /// Their report, with the impulses there; of a split step the part that belongs to the motion.
    pub report: Vec<usize>,
    /// The configuration at the report of a split step, with the impulses there.
    pub configuration: Vec<usize>,
    /// They add the stress, where an analysis needs it.
    pub stress: Vec<usize>,
}

impl Builder<'_> {
    /// Bonds have baths that remember: a report observes them before a step advances them.
    pub(super) fn bonds_remember(&self) -> bool {
        self.model.particles().bonds.as_ref().is_some_and(Bonds::have_memory)
    }

    /// Whether there are bonds or angles.
    pub(super) fn is_bonded(&self) -> bool {
        self.model.particles().are_bonded()
    }

    /// True if kernels find particles by number: the ends of bonds and angles, and charges.
    pub(super) fn keeps_slots(&self) -> bool {
        self.is_bonded() || self.model.particles().electrostatics.is_some()
    }

    /// Whether impulses wait in an array for the passes over particles.
    pub(super) fn gathers(&self) -> bool {
        let left = self.splits() && self.model.particles().acts_on_particles();
        self.is_bonded()
            || self.model.particles().tethers.is_some()
            || self.model.particles().electrostatics.is_some()
            || self.order == Order::WithList
            || self.visits_once()
            || left
    }

    /// Whether some of these impulses are of friction, which a report has to tell from the conservative ones.
    fn gathers_friction(&self) -> bool {
        let listed = self.order == Order::WithList && (self.force.has_friction() || self.force.remembers());
        let bonds = self.model.particles().bonds.as_ref();
        !self.splits() && (listed || bonds.is_some_and(Bonds::have_friction))
    }

    /// The constant that says how a report tells the conservative part of gathered impulses: `shaders/couplings/kicks.wgsl`.
    pub(super) fn conservative_gathered(&self) -> f64 {
        match (self.gathers_friction(), self.model.physics().has_potential()) {
            (true, false) => 0.0,
            (false, _) => 1.0,
            (true, true) => APART,
        }
    }

    /// Adds impulses to particles in any order.
    pub(crate) fn kicks(&self) -> Choices {
        bonded::kicks(self.model.units.dimension)
    }

    /// Makes the kernels of couplings. Those of a report leave rows of sums after the given number of rows, which they
    /// raise.
    pub(super) fn gathering(&mut self, rows: &mut u32) -> GatheringKernels {
        let mut kernels = GatheringKernels::default();
        for term in self.model.particles().terms() {
            term.gather(self, rows, &mut kernels);
        }
        self.gathering_buffers();
        kernels
    }

    /// True if pairs are found in a list.
    pub(crate) fn lists_pairs(&self) -> bool {
        self.order == Order::WithList
    }

    /// Adds the kernels of bonds, angles or excluded pairs.
    pub(crate) fn couple(&mut self, bonded: &Bonded, rows: &mut u32, kernels: &mut GatheringKernels) {
        self.plan.constants.extend(bonded.constants.iter().copied());
        let kicks = self.kicks();
        let kick = self.bonded_kernel(bonded.name, bonded, &bonded.choices.clone().and(&kicks));
        kernels.kicks.push(kick);
        let [whole, between] = bonded.reports;
        if self.splits() {
            if let Some(motion) = &bonded.motion {
                kernels.report.push(self.report_of(whole, bonded, motion, &Choices::new(), rows));
            }
            let kernel = self.report_of(between, bonded, &bonded.configuration, &kicks, rows);
            kernels.configuration.push(kernel);
            if self.is_sheared() {
                self.plan.kernels[kernel].constants.push(shear::moment(1));
            }
        } else {
            kernels.report.push(self.report_of(whole, bonded, &bonded.observed, &kicks, rows));
        }
        if stress::is_needed(self.measured) {
            let (name, choices) = &bonded.stress;
            kernels.stress.push(self.bonded_kernel(name, bonded, choices));
        }
        let remembers = bonded.entry == Entry::PullBonds && self.bonds_remember();
        if self.splits() && remembers && !self.model.particles().walls.is_empty() {
            // Between walls whole drifts are followed back, in their two halves.
            let last = [kernels.report.last(), kernels.stress.last()].into_iter().flatten().copied();
            for kernel in [kick].into_iter().chain(last) {
                self.plan.kernels[kernel].constants.push((Constant::Halves, 2.0));
            }
        }
        self.plan.operations_per_particle += bonded.operations * bonded.count as f64 / self.particles.max(1) as f64;
    }

    fn report_of(
        &mut self,
        name: &'static str,
        bonded: &Bonded,
        observed: &Observed,
        gathered: &Choices,
        rows: &mut u32,
    ) -> usize {
        let kernel = self.bonded_kernel(name, bonded, &observed.choices.clone().and(gathered));
        let once = self.scales().once(observed.scales);
        self.leaves_rows(kernel, rows);
        self.plan.kernels[kernel].constants.extend(once);
        kernel
    }

    /// A kernel of a report leaves rows of sums after the given number of rows, which it raises.
    pub(crate) fn leaves_rows(&mut self, kernel: usize, rows: &mut u32) {
        self.plan.kernels[kernel].constants.push((Constant::FirstGroup, f64::from(*rows)));
        *rows += self.plan.kernels[kernel].workgroups;
    }

    fn bonded_kernel(&mut self, name: &'static str, bonded: &Bonded, choices: &Choices) -> usize {
        let choices = self.choices().and(choices);
        self.kernel(name, bonded.entry, choices, bonded.count)
    }

    fn gathering_buffers(&mut self) {
        if self.keeps_slots() {
            self.plan.add_buffer(Array::Slots, 4 * self.particles);
        }
        let places = self.slots + self.frame_capacity();
        if self.gathers() {
            self.plan.add_buffer(Array::Kicks, 16 * places);
        }
        if self.conservative_gathered() == APART {
            self.plan.add_buffer(Array::Forces, 16 * places);
        }
    }

    /// Where each particle is stored, for bonds and angles: noted when the state is there, and by lists whenever they
    /// are made.
    pub(super) fn take_stock(&mut self) -> usize {
        let choices = self.choices().with_if(self.keeps_slots(), couplings::Slots::Kept);
        self.kernel("take_stock", Entry::TakeStock, choices, self.particles)
    }
}
