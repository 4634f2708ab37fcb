//! One of the ranks of a run: does what the first rank tells.

use super::Channel;
use super::message::{Answer, Command, Introduction, Problem, read, written};
use crate::engine::Engine;

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
    (Answer::of(samples, ended.as_ref().copied(), engine.traffic()), words)
}

/// Introduces itself, and does what the first rank tells until there is nothing more to do.
///
/// # Errors
/// That the first rank is lost, in words.
pub fn serve(engine: &mut Engine<'_>, introduction: Introduction, channel: &mut dyn Channel) -> Result<(), String> {
    let (mut failed, mut introduction) = (None, Some(introduction));
    while let Some((command, particles)) = heard(channel)? {
        let (mut answer, words) = match &failed {
            None => execute(engine, command, &particles),
            Some(problem) => (Answer { problem: Some(Problem::clone(problem)), ..Answer::default() }, Vec::new()),
        };
        if answer.problem.is_some() && failed.is_none() {
            // Peers that wait for particles learn of it.
            engine.leave();
            failed.clone_from(&answer.problem);
        }
        answer.introduction = introduction.take();
        channel.answer(&written(&answer, &words)?)?;
    }
    Ok(())
}

/// Answers whatever the first rank tells with the reason why this rank cannot take part.
///
/// # Errors
/// That the first rank is lost, in words.
pub fn decline(channel: &mut dyn Channel, reason: String) -> Result<(), String> {
    let answer = Answer { problem: Some(Problem::Other { reason }), ..Answer::default() };
    while heard(channel)?.is_some() {
        channel.answer(&written(&answer, &[])?)?;
    }
    Ok(())
}

/// The next command; nothing if it is to end, which nobody answers.
fn heard(channel: &mut dyn Channel) -> Result<Option<(Command, Vec<u32>)>, String> {
    let told: (Command, Vec<u32>) = read(&channel.listen()?)?;
    Ok((told.0 != Command::End).then_some(told))
}
