//! How particles lie in buffers: of pairs alone, and of all couplings.

mod coupled;
mod list;

pub use coupled::CoupledLayout;
pub use list::ListLayout;

use crate::plan::{Length, Misfit, Places, StateLayout, content};
use crate::prediction;
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// Bytes of a particle.
pub(super) const PARTICLE: u64 = 32;

/// Words of a particle.
const WORDS: usize = PARTICLE as usize / 4;

/// One array `particles` of position and id, momentum and species, with what a predicted
/// momentum adds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParticleLayout {
    /// Number of dimensions.
    pub dimension: usize,
    /// Whether particles carry predicted momenta.
    pub predicted: bool,
}

impl StateLayout for ParticleLayout {
    fn buffers(&self) -> Vec<Array> {
        vec![Array::Particles]
    }

    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        if self.predicted && state.step > 0 && state.predicted.len() != state.len() {
            return Err("predicted momenta are".into());
        }
        let mut words: Vec<u32> = Vec::with_capacity(WORDS * state.len());
        for &id in order {
            words.extend(state.positions[id]);
            words.push(id as u32);
            words.extend(state.momenta[id].map(|unit| unit as u32));
            let prediction = match state.predicted.get(id) {
                Some(seen) if self.predicted => {
                    prediction::packed(prediction::shifted(*seen, state.momenta[id].map(i32::wrapping_neg)))
                }
                _ => 0,
            };
            words.push(state.species[id] | (prediction << 8));
        }
        Ok(vec![words])
    }

    fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = State {
            step,
            positions: vec![[0; 3]; count],
            momenta: vec![[0; 3]; count],
            species: vec![0; count],
            predicted: vec![[0; 3]; if self.predicted { count } else { 0 }],
            ..State::default()
        };
        let mut places = Places::of(count);
        for particle in content(contents, 0).chunks_exact(WORDS).take(count) {
            let id = places.take(particle[3])?;
            state.positions[id] = [particle[0], particle[1], if self.dimension == 3 { particle[2] } else { 0 }];
            state.momenta[id] = [particle[4] as i32, particle[5] as i32, particle[6] as i32];
            state.species[id] = particle[7] & 255;
            if self.predicted {
                let shift = prediction::unpacked(particle[7] >> 8);
                state.predicted[id] = prediction::shifted(state.momenta[id], shift);
            }
        }
        Ok(state)
    }

    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        vec![(StateArray::Predicted, Length::AfterFirstStep(if self.predicted { count } else { 0 }))]
    }
}
