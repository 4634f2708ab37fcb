//! What advances a state step by step: an engine, or several that share a run.

use super::{Control, Engine, EngineError, Sample, Shown, Traffic};
use crate::plan::Plan;
use crate::shaders::Array;
use crate::state::{Reported, State};
use serde::{Deserialize, Serialize};
use std::mem::offset_of;

/// One of several ranks that share a state.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RankReport {
    /// The machine.
    pub host: String,
    /// The adapter and its driver.
    pub adapter: String,
    /// Adapters that the ranks on its machine get by turns.
    pub adapters: u32,
    /// A checksum of what it computes from a state that all ranks know: ranks that round alike have the same.
    pub arithmetic: u32,
    /// What it has exchanged.
    pub traffic: Traffic,
}

/// What advances a state and samples it; [`Engine`] says what each of these does.
#[allow(missing_docs, clippy::missing_errors_doc)]
pub trait Stepper: Send {
    fn plan(&self) -> &Plan;
    fn step(&self) -> u64;
    fn upload(&mut self, state: &State) -> Result<(), EngineError>;
    fn advance(&mut self, steps: u64, batch: u64) -> Result<(), EngineError>;
    fn finish(&mut self) -> Result<Vec<Sample>, EngineError>;
    fn take_samples(&mut self) -> Vec<Sample>;
    fn state(&mut self) -> Result<State, EngineError>;
    fn reported(&mut self) -> Result<Reported, EngineError>;

    /// Waits until the device has taken all steps.
    fn wait(&mut self) -> Result<(), EngineError>;

    /// The particles as a report of this step finds them, whose state is known.
    fn report_of(&mut self, state: &State) -> Result<Reported, EngineError>;

    /// Samples of this step by some samplers, due or not: samples at the steps at which they are due do not depend on
    /// it. Samplers of gathered particles are not among them.
    fn measure(&mut self, samplers: &[usize]) -> Result<Vec<Sample>, EngineError>;

    /// Goes on from a state by another plan, which differs in numbers only: in constants that kernels load from
    /// buffers, and in tables. Other ranks make their plans of the scene in JSON. False if a plan differs in more: the
    /// engine has to be replaced then.
    fn renumber(&mut self, plan: &Plan, scene: &str, state: &State) -> Result<bool, EngineError>;

    /// The particles where the forces of the current step are evaluated, with their momenta there, as the table of
    /// energies sees them: what a run that starts from them takes for its step 0. Only where the state may be read, and
    /// of a scene with a trajectory.
    fn frame(&mut self) -> Result<Reported, EngineError> {
        if !self.plan().has_buffer(Array::ReportedMomenta) {
            return self.reported();
        }
        let before = self.state()?;
        self.report_of(&before)
    }

    /// The particles of a report that a picture shows: about so many, if there are more.
    fn shown(&mut self, most: u64) -> Result<Shown, EngineError> {
        Ok(Shown::of(self.reported()?, most))
    }

    /// Each rank, of several.
    fn ranks(&self) -> &[RankReport] {
        &[]
    }

    /// Lets other ranks know that this one is at work while it tells them nothing for long.
    fn keep_alive(&self) {}

    /// Exchanges that a limit has cut, of what has any.
    fn limited_exchanges(&mut self) -> Result<u64, EngineError> {
        Ok(0)
    }

    /// The words of a buffer or texture of the plan, as they are once the device is done; of several ranks those that all have alike.
    fn words(&mut self, array: Array) -> Result<Vec<u32>, EngineError>;

    /// Continues a window of a sampler that was open when the state was saved: this many of its samples had been taken, and its buffer held
    /// these words. Only directly after an upload.
    ///
    /// # Errors
    /// [`EngineError::State`] if the sampler has no window of more samples, or its buffer another number of words.
    fn continue_window(&mut self, sampler: usize, taken: u64, words: &[u32]) -> Result<(), EngineError>;
}

impl Stepper for Engine<'_> {
    fn plan(&self) -> &Plan {
        self.plan()
    }

    fn step(&self) -> u64 {
        self.step()
    }

    fn upload(&mut self, state: &State) -> Result<(), EngineError> {
        self.upload(state)
    }

    fn advance(&mut self, steps: u64, batch: u64) -> Result<(), EngineError> {
        self.advance(steps, batch)
    }

    fn finish(&mut self) -> Result<Vec<Sample>, EngineError> {
        self.finish()
    }

    fn take_samples(&mut self) -> Vec<Sample> {
        self.take_samples()
    }

    fn state(&mut self) -> Result<State, EngineError> {
        self.state()
    }

    fn reported(&mut self) -> Result<Reported, EngineError> {
        self.reported()
    }

    fn wait(&mut self) -> Result<(), EngineError> {
        self.wait_all()
    }

    fn report_of(&mut self, state: &State) -> Result<Reported, EngineError> {
        self.report_of(state)
    }

    fn measure(&mut self, samplers: &[usize]) -> Result<Vec<Sample>, EngineError> {
        self.take_measurements(samplers)?;
        self.wait_all()?;
        Ok(self.take_samples())
    }

    fn renumber(&mut self, plan: &Plan, _: &str, state: &State) -> Result<bool, EngineError> {
        if !self.load_numbers(plan)? {
            return Ok(false);
        }
        self.upload(state)?;
        Ok(true)
    }

    fn limited_exchanges(&mut self) -> Result<u64, EngineError> {
        let control = self.words(Array::Control)?;
        let word = |offset: usize| u64::from(control.get(offset / size_of::<u32>()).copied().unwrap_or(0));
        Ok(word(offset_of!(Control, limited_high)) << 32 | word(offset_of!(Control, limited)))
    }

    fn words(&mut self, array: Array) -> Result<Vec<u32>, EngineError> {
        self.words(array)
    }

    fn continue_window(&mut self, sampler: usize, taken: u64, words: &[u32]) -> Result<(), EngineError> {
        let refuse = |reason: &str| EngineError::State { reason: reason.to_owned() };
        let planned = self.plan.samplers.get(sampler).ok_or_else(|| refuse("there is no such sampler"))?;
        let window = planned.window.filter(|window| taken < window.samples);
        let window = window.ok_or_else(|| refuse("the sampler has no window of so many samples"))?;
        let buffer = &self.buffers[&window.buffer];
        if buffer.bytes() != 4 * words.len() as u64 {
            return Err(refuse("the window has another number of particles"));
        }
        buffer.write(&self.gpu, 0, bytemuck::cast_slice(words))?;
        // The second word counts the samples since the upload; the place in the window follows from it.
        Ok(self.buffers[&planned.samples].write(&self.gpu, 4, bytemuck::bytes_of(&(taken as u32)))?)
    }
}
