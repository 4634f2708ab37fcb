//! What advances a state step by step: an engine, or several that share a run.

use super::{Engine, EngineError, Sample, Shown, Traffic};
use crate::plan::Plan;
use crate::shaders::Array;
use crate::state::{Reported, State};

/// One of several ranks that share a state.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
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
pub trait Stepper {
    fn plan(&self) -> &Plan;
    fn step(&self) -> u64;
    fn advance(&mut self, steps: u64, batch: u64) -> Result<(), EngineError>;
    fn finish(&mut self) -> Result<Vec<Sample>, EngineError>;
    fn take_samples(&mut self) -> Vec<Sample>;
    fn state(&mut self) -> Result<State, EngineError>;
    fn reported(&mut self) -> Result<Reported, EngineError>;
    fn frame(&mut self) -> Result<Reported, EngineError>;

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

    /// The words of an array, of what lies on one device.
    fn words(&mut self, array: Array) -> Result<Vec<u32>, EngineError> {
        let reason = format!("`{}` lies on several devices", array.name());
        Err(EngineError::State { reason })
    }

    /// Continues a window of samples, of what lies on one device.
    fn continue_window(&mut self, _: usize, _: u64, _: &[u32]) -> Result<(), EngineError> {
        Err(EngineError::State { reason: "windows of samples lie on several devices".to_owned() })
    }
}

impl Stepper for Engine<'_> {
    fn plan(&self) -> &Plan {
        self.plan()
    }

    fn step(&self) -> u64 {
        self.step()
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

    fn frame(&mut self) -> Result<Reported, EngineError> {
        self.frame()
    }

    fn limited_exchanges(&mut self) -> Result<u64, EngineError> {
        self.limited_exchanges()
    }

    fn words(&mut self, array: Array) -> Result<Vec<u32>, EngineError> {
        self.words(array)
    }

    fn continue_window(&mut self, sampler: usize, taken: u64, words: &[u32]) -> Result<(), EngineError> {
        self.continue_window(sampler, taken, words)
    }
}
