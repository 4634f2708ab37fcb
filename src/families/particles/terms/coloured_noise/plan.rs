//! Coloured noise on the device: a part of the kicks of a step.

use super::ColouredNoise;
use crate::document::NoiseProcess;
use crate::families::particles::plan::bonded::Scales;
use crate::families::particles::terms::PlannedTerm;
use crate::noise::{self, stream};
use crate::plan::Plan;
use crate::shaders::Constant;

/// Largest time that a constant takes, in half steps: above it every force outlasts any run.
const LONGEST_TIME: f64 = 1e30;

impl PlannedTerm for ColouredNoise {
    fn add_constants(&self, scales: &Scales<'_>, plan: &mut Plan) {
        let model = scales.model;
        let half_step = 0.5 * model.time_step;
        let key = noise::seed_key(model.seed, stream::JUMP);
        let process = match self.process {
            NoiseProcess::Kangaroo => 0.0,
            NoiseProcess::KangarooExponential => 1.0,
            NoiseProcess::Short => 2.0,
            NoiseProcess::Literal => 3.0,
        };
        plan.constants.extend([
            (Constant::ColouredNoise, 1.0),
            (Constant::HoldProcess, process),
            (Constant::HoldImpulse, scales.impulse()),
            (Constant::HoldForce, self.strength.sqrt()),
            (Constant::HoldTime, (self.time / half_step).min(LONGEST_TIME)),
            (Constant::JumpStreamX, f64::from(key[0])),
            (Constant::JumpStreamY, f64::from(key[1])),
        ]);
        if self.process == NoiseProcess::Literal {
            plan.constants.push((Constant::HoldTurns, 1.0 / (std::f64::consts::TAU * self.time.sqrt())));
        }
        // Words and jumps of the particles whose force ends in a step are few unless forces are short.
        let jumps = model.time_step / self.time;
        plan.operations_per_particle += 30.0 + 120.0 * jumps;
    }
}
