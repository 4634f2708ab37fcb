//! How particles lie in buffers, alone and with what baths, lists and tethers remember.

mod coupled;
mod list;

pub use coupled::{CoupledLayout, KeptArray};
pub use list::ListLayout;

use crate::plan::{Length, Misfit, Places, StateLayout, content};
use crate::prediction;
use crate::shaders::Array;
use crate::state::{Account, State, StateArray};

/// Bytes of a particle.
pub(super) const PARTICLE: u64 = 32;

/// Words of a particle.
const WORDS: usize = PARTICLE as usize / 4;

/// One array `particles` of position and id, momentum and species, with what a predicted
/// momentum adds; and the account of body forces and the momentum that walls have absorbed, where there are any.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParticleLayout {
    /// Number of dimensions.
    pub dimension: usize,
    /// Whether particles carry predicted momenta.
    pub predicted: bool,
    /// Rows of the account of body forces; none without any.
    pub account: usize,
    /// Number of walls.
    pub walls: usize,
}

impl ParticleLayout {
    /// Number of its buffers.
    fn buffer_count(&self) -> usize {
        1 + usize::from(self.account > 0) + usize::from(self.walls > 0)
    }
}

/// Words of a row of the account: see `shaders/external/body_force.wgsl`.
const ACCOUNT: usize = 16;

/// The sums of all rows of an account, with the opening half of the last step.
fn total_account(rows: &[u32]) -> Account {
    let mut sums = [0_i64; 4];
    for row in rows.chunks_exact(ACCOUNT) {
        let word = |index: usize| (u64::from(row[2 * index + 1]) << 32 | u64::from(row[2 * index])).cast_signed();
        for (index, sum) in sums.iter_mut().enumerate() {
            let opening = if index < 3 { word(4 + index) } else { 0 };
            *sum = sum.wrapping_add(word(index)).wrapping_add(opening);
        }
    }
    let [x, y, z, work] = sums;
    Account::new([x, y, z], work)
}

impl StateLayout for ParticleLayout {
    fn buffers(&self) -> Vec<Array> {
        std::iter::once(Array::Particles)
            .chain((self.account > 0).then_some(Array::Account))
            .chain((self.walls > 0).then_some(Array::WallImpulses))
            .collect()
    }

    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        if self.predicted && state.step > 0 && state.predicted.len() != state.len() {
            return Err("predicted momenta are".into());
        }
        let mut words: Vec<u32> = Vec::with_capacity(WORDS * order.len());
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
        let mut contents = vec![words];
        if self.account > 0 {
            // All in the first row, of which the second half is empty as all others are.
            let mut account = state.words(StateArray::Account).to_vec();
            if account.len() != StateArray::Account.width() {
                return Err("the account of body forces is".into());
            }
            account.resize(ACCOUNT * self.account, 0);
            contents.push(account);
        }
        if self.walls > 0 {
            if state.walls.len() != self.walls {
                return Err("what walls have absorbed is".into());
            }
            contents.push(state.words(StateArray::Walls).to_vec());
        }
        Ok(contents)
    }

    fn divides(&self) -> bool {
        true
    }

    fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = self.begin(step, contents, count)?;
        let particles = content(contents, 0);
        self.place(&particles[..particles.len().min(WORDS * count)], &mut Places::of(count), &mut state)?;
        Ok(state)
    }

    fn begin(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = State {
            step,
            positions: vec![[0; 3]; count],
            momenta: vec![[0; 3]; count],
            species: vec![0; count],
            predicted: vec![[0; 3]; if self.predicted { count } else { 0 }],
            ..State::default()
        };
        if self.account > 0 {
            state.account = vec![total_account(content(contents, 1))];
        }
        if self.walls > 0 {
            let words = content(contents, 1 + usize::from(self.account > 0));
            state.set_words(StateArray::Walls, words.get(..StateArray::Walls.width() * self.walls).unwrap_or(words))?;
        }
        Ok(state)
    }

    fn place(&self, particles: &[u32], places: &mut Places, state: &mut State) -> Result<(), String> {
        for particle in particles.chunks_exact(WORDS) {
            let id = places.take(particle[3])?;
            state.positions[id] = [particle[0], particle[1], if self.dimension == 3 { particle[2] } else { 0 }];
            state.momenta[id] = [particle[4] as i32, particle[5] as i32, particle[6] as i32];
            state.species[id] = particle[7] & 255;
            if self.predicted {
                let shift = prediction::unpacked(particle[7] >> 8);
                state.predicted[id] = prediction::shifted(state.momenta[id], shift);
            }
        }
        Ok(())
    }

    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        vec![
            (StateArray::Predicted, Length::AfterFirstStep(if self.predicted { count } else { 0 })),
            (StateArray::Account, Length::Exactly(usize::from(self.account > 0))),
            (StateArray::Walls, Length::Exactly(self.walls)),
        ]
    }
}
