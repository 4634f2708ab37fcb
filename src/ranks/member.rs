//! One of the ranks of a run: does what the first rank tells.

use super::Channel;
use super::message::{Answer, Command, Contents, Introduction, Problem, read, written};
use crate::engine::Engine;

/// Does what a command says; what it gives, and the arrays that go with it.
pub(super) fn execute(engine: &mut Engine<'_>, command: Command, contents: &[Vec<u32>]) -> (Answer, Contents) {
    let mut samples = Vec::new();
    let done = match command {
        Command::Upload { step } => engine.upload_part(step, contents).map(|()| Vec::new()),
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
    let (ended, contents) = match done {
        Ok(contents) => (Ok(()), contents),
        Err(error) => (Err(error), Vec::new()),
    };
    (Answer::of(samples, ended.as_ref().copied(), engine.traffic()), contents)
}

/// Introduces itself, and does what the first rank tells until there is nothing more to do.
///
/// # Errors
/// That the first rank is lost, in words.
pub fn serve(engine: &mut Engine<'_>, introduction: Introduction, channel: &mut dyn Channel) -> Result<(), String> {
    let (mut failed, mut introduction) = (None, Some(introduction));
    while let Some((command, contents)) = heard(channel)? {
        let (mut answer, gives) = match &failed {
            None => execute(engine, command, &contents),
            Some(problem) => (Answer { problem: Some(Problem::clone(problem)), ..Answer::default() }, Vec::new()),
        };
        if answer.problem.is_some() && failed.is_none() {
            // Peers that wait for particles learn of it.
            engine.leave();
            failed.clone_from(&answer.problem);
        }
        answer.introduction = introduction.take();
        channel.answer(&written(&answer, &gives)?)?;
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
fn heard(channel: &mut dyn Channel) -> Result<Option<(Command, Contents)>, String> {
    let told: (Command, Contents) = read(&channel.listen()?)?;
    Ok((told.0 != Command::End).then_some(told))
}
