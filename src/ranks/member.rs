//! One of the ranks of a run: does what the first rank tells.

use super::Channel;
use super::message::{Answer, Command, Problem, read, written};
use crate::engine::{Engine, EngineError};

/// Does what a command says; what it gives, and the words that go with it.
pub(super) fn execute(engine: &mut Engine<'_>, command: Command, particles: &[u32]) -> (Answer, Vec<u32>) {
    let mut samples = Vec::new();
    let done = match command {
        Command::Upload { step } => engine.upload_part(step, particles).map(|()| Vec::new()),
        Command::Advance { steps, batch } => engine.advance(steps, batch).map(|()| Vec::new()),
        Command::Finish => engine.finish().map(|finished| {
            samples = finished;
            Vec::new()
        }),
        Command::State => engine.own_state(),
        Command::Report => engine.own_reported(),
        Command::End => Ok(Vec::new()),
    };
    samples.extend(engine.take_samples());
    let (ended, words) = match done {
        Ok(words) => (Ok(()), words),
        Err(error) => (Err(error), Vec::new()),
    };
    let mut answer = Answer::of(samples, ended.as_ref().map(|()| ()), engine.traffic());
    if matches!(command, Command::Upload { .. }) {
        engine.adapter().clone_into(&mut answer.adapter);
    }
    (answer, words)
}

/// Does what the first rank tells until there is nothing more to do.
///
/// # Errors
/// [`EngineError::Ranks`] if the first rank is lost.
pub fn serve(engine: &mut Engine<'_>, channel: &mut dyn Channel) -> Result<(), EngineError> {
    let lost = |reason| EngineError::Ranks { reason };
    loop {
        let message = channel.listen().map_err(lost)?;
        let (command, particles) = read(&message).map_err(lost)?;
        let (answer, words) = execute(engine, command, &particles);
        let failed = answer.problem.is_some();
        if failed {
            // Peers that wait for particles learn of it.
            engine.leave();
        }
        channel.answer(&written(&answer, &words).map_err(lost)?).map_err(lost)?;
        if failed || command == Command::End {
            return Ok(());
        }
    }
}

/// Answers the first thing that the first rank tells with the reason why this rank cannot take part.
///
/// # Errors
/// That the first rank is lost, in words.
pub fn decline(channel: &mut dyn Channel, reason: String) -> Result<(), String> {
    channel.listen()?;
    let answer = Answer { problem: Some(Problem::Other { reason }), ..Answer::default() };
    channel.answer(&written(&answer, &[])?)
}
