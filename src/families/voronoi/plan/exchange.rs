//! What crosses the faces: momentum, mass and energy, as each part of a step asks for.

use super::Builder;
use crate::shaders::{Array, Choices, Constant, Entry, exchange, voronoi};

/// What a part of a step exchanges, in which time, and how fast cells are then taken to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Pressure and mass, in half a step.
    Pressure,
    /// Friction and heat in a whole step, with the velocities that the solver has found.
    Friction,
    /// Heat alone, in a whole step.
    Heat,
    /// Everything, in a whole step, from what there is at its beginning.
    Everything,
}

impl Builder<'_> {
    /// Kernels that compute a part of a step and leave it in a buffer.
    pub(super) fn exchange(&mut self, part: Part, into: Array) -> Vec<usize> {
        let pressure = matches!(part, Part::Pressure | Part::Everything);
        let predicted = pressure && self.cells.keeps_energy();
        let mut kernels = Vec::new();
        if predicted {
            kernels.push(self.predict(part));
        }
        let heat = part != Part::Pressure && self.conducts();
        let limits = heat || (pressure && self.has_limits());
        let choices = self
            .forces(part, heat)
            .with(voronoi::Visit::Exchange)
            .with(match part {
                _ if predicted => exchange::Side::Predicted,
                Part::Pressure | Part::Everything => exchange::Side::Start,
                Part::Friction => exchange::Side::Solved,
                Part::Heat => exchange::Side::Warm,
            })
            .with_if(limits, exchange::Limit::Counted)
            .with_if(heat, exchange::Conduction::Heat)
            .with_if(self.cells.keeps_energy(), exchange::Energy::Kept)
            .with(match (part, pressure && self.cells.exchanges_mass(), self.cells.keeps_energy()) {
                (Part::Heat, _, _) => exchange::Moved::Heat,
                (_, false, false) => exchange::Moved::Momentum,
                (_, true, false) => exchange::Moved::Mass,
                (_, false, true) => exchange::Moved::Energy,
                (_, true, true) => exchange::Moved::All,
            });
        let exchange = self.face_kernel("exchange", Entry::ExchangeThroughFaces, &choices, part);
        if into != Array::Exchanges {
            self.plan.kernels[exchange].renamed = vec![(Array::Exchanges, into)];
        }
        kernels.push(exchange);
        kernels
    }

    /// The kernel that looks ahead, so that energies are exchanged at the velocities in the middle of a part.
    fn predict(&mut self, part: Part) -> usize {
        if !self.plan.has_buffer(Array::Predictions) {
            self.plan.add_buffer(Array::Predictions, 16 * self.particles);
        }
        let choices = self
            .forces(part, false)
            .with(voronoi::Visit::Prediction)
            .with(exchange::Side::Start)
            .with_if(part == Part::Everything, exchange::Middle::Start);
        self.face_kernel("predict", Entry::PredictExchange, &choices, part)
    }

    /// The forces of a part, with the random words they and heat need.
    fn forces(&self, part: Part, heat: bool) -> Choices {
        let (rubs, presses) = match part {
            Part::Pressure => (false, true),
            Part::Heat => (false, false),
            Part::Friction => (self.rubs(), false),
            Part::Everything => (self.rubs(), true),
        };
        let choices = if presses { self.form() } else { Choices::new() };
        let choices = if rubs { choices.and(&self.rubbing()) } else { choices };
        choices.with_if(heat || (rubs && self.rubs_at_random()), voronoi::NoiseKey::Step)
    }

    /// Friction and its noise.
    pub(super) fn rubbing(&self) -> Choices {
        Choices::new().with(exchange::Rubbing::Viscous).with_if(self.rubs_at_random(), exchange::RandomImpulse::Thermal)
    }

    /// A kernel over the faces of cells.
    fn face_kernel(&mut self, name: &'static str, entry: Entry, choices: &Choices, part: Part) -> usize {
        let step = self.model.time_step * if part == Part::Pressure { 0.5 } else { 1.0 };
        let groups = self.groups(self.particles);
        let kernel = self.kernel(name, entry, choices, groups);
        self.plan.kernels[kernel].constants = vec![(Constant::Step, step)];
        kernel
    }
}
