//! What the device counts from the upload of a state on, carried over from checkpoint to checkpoint.

use super::RunError;
use super::sections::{Sections, bytes};
use crate::engine::{EngineError, Stepper};
use crate::families::{Counted, Model};
use crate::measure::Observables;
use crate::output::checkpoint::CheckpointError;

/// Numbers at the state that a run began with; none of a family that has nothing counted.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Carried {
    step: u64,
    numbers: Vec<f64>,
}

impl Carried {
    /// The numbers at a step, from the sections of its checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError::Content`] where there are no such numbers.
    pub(super) fn new(model: &Model, sections: &Sections<'_>) -> Result<Self, CheckpointError> {
        let numbers = match model.physics().tally() {
            Some(tally) => sections.numbers(tally.section(), tally.length())?.unwrap_or_default(),
            None => Vec::new(),
        };
        Ok(Self { step: sections.step, numbers })
    }

    /// Completes what was measured.
    pub(super) fn complete(&self, model: &Model, observables: &mut Observables) {
        if let Some(tally) = model.physics().tally() {
            tally.complete(&self.numbers, observables.step == self.step, observables);
        }
    }

    /// The numbers at the current step, for an engine that begins there.
    pub(super) fn advanced(&self, model: &Model, engine: &mut dyn Stepper) -> Result<Self, EngineError> {
        let numbers = self.numbers_at(model, engine)?.map_or_else(Vec::new, |(_, numbers)| numbers);
        Ok(Self { step: engine.step(), numbers })
    }

    /// What a checkpoint of the current step has to keep, if anything.
    pub(super) fn section(
        &self,
        model: &Model,
        engine: &mut dyn Stepper,
    ) -> Result<Option<(String, Vec<u8>)>, RunError> {
        let found = self.numbers_at(model, engine)?;
        Ok(found.map(|(section, numbers)| (section.to_owned(), bytes(numbers.into_iter()))))
    }

    /// The section of the numbers at the current step, and these.
    fn numbers_at(
        &self,
        model: &Model,
        engine: &mut dyn Stepper,
    ) -> Result<Option<(&'static str, Vec<f64>)>, EngineError> {
        let Some(tally) = model.physics().tally() else { return Ok(None) };
        let limited = engine.limited_exchanges()?;
        let words = match tally.array(model) {
            _ if engine.step() == self.step => None,
            Some(array) => Some(engine.words(array)?),
            None => Some(Vec::new()),
        };
        Ok(Some((tally.section(), tally.after(&self.numbers, &Counted { limited, words }))))
    }
}
