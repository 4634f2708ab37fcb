//! The parts of a step, in order.

use super::Builder;
use super::exchange::Part;
use super::tessellation::Occasion;
use crate::shaders::exchange::{Change, EnergyCheck};
use crate::shaders::{Array, Choices, Constant, Entry, voronoi};

/// Which way cells go once they have received what crossed their faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Drift {
    None,
    /// Half a step, with the velocity after.
    Half,
    /// A whole step, with the velocity before.
    Explicit,
}

impl Builder<'_> {
    /// The kernels of a step, and those that go before its report.
    pub(super) fn steps(&mut self) {
        self.plan.sort = vec![self.kernel("tick", Entry::BeginPlainStep, &Choices::new(), 1)];
        let geometry = self.geometry();
        if self.is_explicit() {
            self.plan.before_report = geometry;
            self.plan.advance = self.explicit_step();
        } else {
            self.plan.report = geometry;
            self.plan.advance = self.split_step();
        }
        self.plan.finish_report.clone_from(&self.plan.advance);
        self.report();
        self.plan.operations_per_particle = self.operations();
    }

    /// Some thirty candidates and a dozen cuts of a cell; three owned faces in every exchange, twice as many in those that
    /// look ahead; and six faces in each of some five iterations of the solver.
    fn operations(&self) -> f64 {
        let count = |entry: Entry| {
            let kernels = self.plan.advance.iter().filter(|kernel| self.plan.kernels[**kernel].entry == entry);
            kernels.count() as f64
        };
        let solver = if self.rubs() && !self.is_explicit() { 5.0 * 6.0 * 25.0 } else { 0.0 };
        let exchanges = count(Entry::ExchangeThroughFaces) + 2.0 * count(Entry::PredictExchange);
        30.0 * 60.0 + 12.0 * 250.0 + 3.0 * 100.0 * exchanges + solver
    }

    /// Everything from what there is at the beginning of the step, as printed.
    fn explicit_step(&mut self) -> Vec<usize> {
        self.exchange_buffer(Array::Exchanges);
        let mut kernels = self.exchange(Part::Everything, Array::Exchanges);
        kernels.push(self.apply(Change::Taken, Drift::Explicit));
        kernels
    }

    /// A half drift, half a push, friction and heat, half a push, a half drift.
    fn split_step(&mut self) -> Vec<usize> {
        let groups = self.groups(self.particles);
        let drift = self.kernel("drift", Entry::DriftCells, &Choices::new(), groups);
        self.plan.kernels[drift].constants = self.drift_constants(0.5);
        let mut kernels = vec![drift];
        kernels.extend(self.geometry_for(Occasion::Midway));
        let between = if self.rubs() { Some(Part::Friction) } else { self.conducts().then_some(Part::Heat) };
        // Constant masses at a constant temperature push as they did before friction.
        if !self.cells.exchanges_mass() && !self.cells.keeps_energy() {
            self.exchange_buffer(Array::Pushes);
            kernels.extend(self.exchange(Part::Pressure, Array::Pushes));
            if let Some(part) = between {
                self.exchange_buffer(Array::Exchanges);
                kernels.push(self.apply(Change::Kept, Drift::None));
                kernels.extend(self.between(part));
                kernels.push(self.apply(Change::Again, Drift::Half));
            } else {
                kernels.push(self.apply(Change::Twice, Drift::Half));
            }
            return kernels;
        }
        self.exchange_buffer(Array::Exchanges);
        let push = self.exchange(Part::Pressure, Array::Exchanges);
        let apply = self.apply(Change::Taken, Drift::None);
        kernels.extend(&push);
        kernels.push(apply);
        if let Some(part) = between {
            kernels.extend(self.between(part));
            kernels.push(apply);
        }
        kernels.extend(&push);
        kernels.push(self.apply(Change::Taken, Drift::Half));
        kernels
    }

    /// What comes between the two halves of a push.
    fn between(&mut self, part: Part) -> Vec<usize> {
        let mut kernels = if part == Part::Friction { self.solve_friction() } else { Vec::new() };
        kernels.extend(self.exchange(part, Array::Exchanges));
        kernels
    }

    fn exchange_buffer(&mut self, array: Array) {
        self.plan.add_buffer(array, 16 * self.particles);
    }

    /// The kernel that adds to the cells what came through their faces.
    fn apply(&mut self, change: Change, drift: Drift) -> usize {
        let choices =
            Choices::new().with(change).with_if(self.cells.keeps_energy(), EnergyCheck::Kept).with_any(match drift {
                Drift::None => None,
                Drift::Half => Some(voronoi::Motion::After),
                Drift::Explicit => Some(voronoi::Motion::Before),
            });
        let groups = self.groups(self.particles);
        let kernel = self.kernel("apply", Entry::ApplyExchange, &choices, groups);
        if drift != Drift::None {
            self.plan.kernels[kernel].constants = self.drift_constants(if drift == Drift::Half { 0.5 } else { 1.0 });
        }
        kernel
    }

    fn drift_constants(&self, part: f64) -> Vec<(Constant, f64)> {
        vec![(Constant::DriftStep, part * self.model.time_step)]
    }
}
