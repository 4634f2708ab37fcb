//! Friction and noise on every particle by itself: Langevin dynamics and the generalised Langevin equation, a bath
//! coupled to every coordinate of every particle, h = x.

pub(crate) mod plan;
pub(crate) mod reference;
mod scene;

use super::Term;
use crate::families::particles::KeptArray;
use crate::families::{BathStep, Model};
use crate::noise::{self, stream};
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// A heat bath on every coordinate of every particle.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionBath {
    /// Temperature kT of the bath.
    pub temperature: f64,
    /// Bath step of a coordinate, for each species.
    pub steps: Vec<BathStep>,
    /// True if the bath has memory.
    pub memory: bool,
    /// Friction is relative to the mean flow of a sheared box, not to the box.
    pub peculiar: bool,
}

impl Term for PositionBath {
    fn has_memory(&self) -> bool {
        self.memory
    }

    fn is_tied_to_space(&self) -> bool {
        true
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn baths(&self, _: &Model) -> Vec<(BathStep, f64)> {
        self.steps.iter().map(|step| (*step, self.temperature)).collect()
    }

    fn momentum_source(&self) -> Option<&'static str> {
        Some("friction and noise act on every particle by itself")
    }

    fn keeps(&self, model: &Model) -> Option<KeptArray> {
        self.memory.then(|| KeptArray::new(Array::PositionBaths, StateArray::PositionBaths, model.particle_count()))
    }

    /// Draws the bath variables of all coordinates from their law at rest.
    fn complete_start(&self, state: &mut State, model: &Model) {
        if !self.memory {
            return;
        }
        let key = noise::step_key(model.seed, stream::PARTICLE, 0);
        let draw = |id: usize, axis: usize| {
            let width = self.steps[state.species[id] as usize].deviation(self.temperature);
            let words = noise::words(model.generator, key, [id as u32, axis as u32]);
            if axis < model.units.dimension { (width * noise::gaussian(words)) as f32 } else { 0.0 }
        };
        let all = (0..state.len()).map(|id| std::array::from_fn(|axis| draw(id, axis).to_bits()));
        state.position_baths = all.collect();
    }
}
