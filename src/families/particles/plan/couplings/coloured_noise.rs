//! A random force on every particle that is constant for random times.

use super::Builder;
use crate::document::NoiseProcess;
use crate::noise::{self, stream};
use crate::shaders::{Array, Choices, Constant, baths};

/// Largest time that a constant takes, in half steps: above it every force outlasts any run.
const LONGEST_TIME: f64 = 1e30;

impl Builder<'_> {
    /// The random force, if there is one.
    pub(super) fn held_noise(&self) -> Choices {
        let Some(noise) = self.model.particles().coloured_noise.as_ref() else { return Choices::new() };
        Choices::new().with(baths::ColouredNoise::Held).with(match noise.process {
            NoiseProcess::Kangaroo => baths::Jump::Kangaroo,
            NoiseProcess::KangarooExponential => baths::Jump::KangarooExponential,
            NoiseProcess::Short => baths::Jump::Short,
            NoiseProcess::Literal => baths::Jump::Literal,
        })
    }

    /// Constants and state of the random force.
    pub(super) fn coloured_noise(&mut self) {
        let Some(noise) = self.model.particles().coloured_noise.as_ref() else { return };
        let half_step = 0.5 * self.model.time_step;
        let key = noise::seed_key(self.model.seed, stream::JUMP);
        self.plan.constants.extend([
            (Constant::HoldImpulse, self.impulse()),
            (Constant::HoldForce, noise.strength.sqrt()),
            (Constant::HoldTime, (noise.time / half_step).min(LONGEST_TIME)),
            (Constant::JumpStreamX, f64::from(key[0])),
            (Constant::JumpStreamY, f64::from(key[1])),
        ]);
        if noise.process == NoiseProcess::Literal {
            self.plan.constants.push((Constant::HoldTurns, 1.0 / (std::f64::consts::TAU * noise.time.sqrt())));
        }
        // Words and jumps of the particles whose force ends in a step are few unless forces are short.
        let jumps = self.model.time_step / noise.time;
        let bytes = size_of::<crate::state::Hold>() as u64;
        self.plan.add_buffer(Array::Holds, bytes * self.particles);
        self.plan.operations_per_particle += 30.0 + 120.0 * jumps;
    }
}
