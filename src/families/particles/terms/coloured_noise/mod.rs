//! A random force on every particle that is constant for random times.
//!
//! The force of Borreguero, Ellero and Adams, "Investigation of dissipative particle dynamics with colored noise" (2019),
//! equations (8) and (9), and processes with a stationary law in its place. C(t) = ⟨F(0)·F(t)⟩ below is that of the whole
//! vector: each of d components has a part C(t)/d, but in [`NoiseProcess::Literal`].

mod plan;
mod reference;
mod scene;

use super::Term;
use crate::document::NoiseProcess;
use crate::families::Model;
use crate::families::particles::KeptArray;
use crate::noise::{self, stream};
use crate::shaders::Array;
use crate::state::{Hold, State, StateArray};
use std::f64::consts::TAU;

/// A random force on every particle that is constant for random times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColouredNoise {
    /// Mean square α of the force.
    pub strength: f64,
    /// Time ε or τ of the process.
    pub time: f64,
    /// The process.
    pub process: NoiseProcess,
}

/// What a jump draws: the force that follows and for how long it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// The force.
    pub force: [f64; 3],
    /// How long it holds.
    pub time: f64,
}

impl Term for ColouredNoise {
    fn energy_source(&self) -> Option<&'static str> {
        Some("added by the coloured noise")
    }

    fn momentum_source(&self) -> Option<&'static str> {
        Some(if self.process == NoiseProcess::Literal {
            "the coloured noise pushes every particle by itself, with a mean force that is not zero, so that the centre \
             of mass is driven"
        } else {
            "the coloured noise pushes every particle by itself, so that the velocity of the centre of mass wanders"
        })
    }

    fn keeps(&self, model: &Model) -> Option<KeptArray> {
        Some(KeptArray::new(Array::Holds, StateArray::Holds, model.particle_count()))
    }

    fn complete_start(&self, state: &mut State, model: &Model) {
        state.holds = self.first_holds(model, state.len());
    }
}

impl ColouredNoise {
    /// A jump from four uniform numbers in (0, 1).
    ///
    /// With φ = √U the holding time ε/φ is that of equation (9) for φ of density 2φ. In stationary state φ is uniform, since
    /// that density is weighted with the mean holding time, and a time t is survived by max(0, 1 - tφ/ε) of the holds:
    /// C(t) = α(1 - t/2ε) up to ε and αε/2t beyond; C(t) = α(ε/t)(1 - exp(-t/ε)) with exponential holding times.
    #[must_use]
    pub fn jump(&self, dimension: usize, uniform: [f64; 4]) -> Jump {
        let time = match self.process {
            NoiseProcess::Kangaroo => self.time / uniform[0].sqrt(),
            NoiseProcess::KangarooExponential => -uniform[2].ln() * self.time / uniform[0].sqrt(),
            NoiseProcess::Short => -uniform[2].ln() * self.time,
            NoiseProcess::Literal => return self.literal(uniform),
        };
        Jump { force: self.force(dimension, uniform), time }
    }

    /// The first force: that of the stationary law with the rest of its holding time, where there is such a law.
    #[must_use]
    pub fn start(&self, dimension: usize, uniform: [f64; 4]) -> Jump {
        let time = match self.process {
            // What is left of a fixed time that has begun is uniform.
            NoiseProcess::Kangaroo => uniform[2] * self.time / uniform[0],
            // What is left of an exponential time does not depend on when it began.
            NoiseProcess::KangarooExponential => -uniform[2].ln() * self.time / uniform[0],
            NoiseProcess::Short => -uniform[2].ln() * self.time,
            NoiseProcess::Literal => return self.literal(uniform),
        };
        Jump { force: self.force(dimension, uniform), time }
    }

    /// √α in a uniformly distributed direction.
    fn force(&self, dimension: usize, uniform: [f64; 4]) -> [f64; 3] {
        let strength = self.strength.sqrt();
        let direction = match dimension {
            1 => [if uniform[1] < 0.5 { -1.0 } else { 1.0 }, 0.0, 0.0],
            2 => {
                let (sine, cosine) = (TAU * uniform[1]).sin_cos();
                [cosine, sine, 0.0]
            }
            _ => {
                let cosine = 2.0 * uniform[1] - 1.0;
                let sine = (1.0 - cosine * cosine).sqrt();
                let azimuth = TAU * uniform[3];
                [sine * azimuth.cos(), sine * azimuth.sin(), cosine]
            }
        };
        direction.map(|component| strength * component)
    }

    /// Equations (8) and (9) as they are printed.
    fn literal(&self, uniform: [f64; 4]) -> Jump {
        let (sine, cosine) = (uniform[0] / self.time.sqrt()).sin_cos();
        let strength = self.strength.sqrt();
        Jump { force: [strength * cosine, strength * sine, 0.0], time: self.time / uniform[0] }
    }

    /// The uniform numbers of jump `jump` of particle `id`. The start is jump 0.
    #[must_use]
    pub fn uniform_numbers(model: &Model, id: u32, jump: u32) -> [f64; 4] {
        let key = noise::seed_key(model.seed, stream::JUMP);
        let words = |part: u32| noise::words(model.generator, key, [id, jump.wrapping_mul(2).wrapping_add(part)]);
        let ([a, b], [c, d]) = (words(0), words(1));
        [a, b, c, d].map(|word| noise::centred_uniform(word) + 0.5)
    }

    /// The stored form of a force after which `jumps` were drawn in all, with a time left in units of half a step.
    pub(crate) fn hold(force: [f64; 3], half_steps: f64, jumps: u32) -> Hold {
        let mut halves = half_steps.floor();
        let mut fraction = (half_steps - halves) as f32;
        if fraction >= 1.0 {
            fraction = 0.0;
            halves += 1.0;
        }
        Hold {
            force: force.map(|component| (component as f32).to_bits()),
            fraction: fraction.to_bits(),
            // A saturating conversion: longer than any run.
            halves: halves as u32,
            jump: jumps,
        }
    }

    /// The forces of all particles at step 0.
    pub(crate) fn first_holds(&self, model: &Model, particles: usize) -> Vec<Hold> {
        let first = |id: usize| {
            let jump = self.start(model.units.dimension, Self::uniform_numbers(model, id as u32, 0));
            Self::hold(jump.force, jump.time / (0.5 * model.time_step), 1)
        };
        (0..particles).map(first).collect()
    }
}
