//! One of the ranks of a run: does what the first rank tells.

use super::Channel;
use super::message::{Answer, Command, Contents, Problem, read, written};
use crate::engine::{Engine, EngineError, RankReport, Sampling};
use crate::plan::{ParticleWords, Plan, PlannedPart};
use std::collections::VecDeque;

/// Particles that pass from rank to rank in several messages.
#[derive(Debug, Default)]
pub(super) struct Portions {
    /// Those that have been taken, of a state that is to begin.
    taken: Vec<u32>,
    /// Those that have not been given yet, by message.
    left: VecDeque<Vec<u32>>,
}

impl Portions {
    /// Divides the particles of a state and gives the first, with the arrays that go with them.
    fn divide(&mut self, part: Option<&PlannedPart>, mut contents: Contents) -> Contents {
        let (Some(part), Some(particles)) = (part, contents.first_mut()) else { return contents };
        let count = part.portions().count();
        if count == 1 {
            return contents;
        }
        let portion_of = |particle: &[u32]| (u64::from(particle[part.particle.number]) / part.portion.max(1)) as usize;
        let all = std::mem::take(particles);
        let mut sizes = vec![0; count];
        let each = || all.chunks_exact(part.particle.count);
        for particle in each() {
            if let Some(size) = sizes.get_mut(portion_of(particle)) {
                *size += particle.len();
            }
        }
        let mut portions: Vec<Vec<u32>> = sizes.into_iter().map(Vec::with_capacity).collect();
        for particle in each() {
            if let Some(portion) = portions.get_mut(portion_of(particle)) {
                portion.extend(particle);
            }
        }
        self.left = portions.into();
        contents[0] = self.next();
        contents
    }

    /// Those of the next message.
    fn next(&mut self) -> Vec<u32> {
        self.left.pop_front().unwrap_or_default()
    }

    /// Takes of some particles those that a rank needs.
    fn take(&mut self, engine: &Engine<'_>, contents: &[Vec<u32>]) -> Result<(), EngineError> {
        self.taken.extend(engine.needed(contents.first().map_or(&[], Vec::as_slice))?);
        Ok(())
    }
}

/// A state of whose particles only some are left.
fn sampled(part: Option<&PlannedPart>, sampling: Sampling, mut contents: Contents) -> Contents {
    if let (Some(part), Some(particles)) = (part, contents.first_mut()) {
        let ParticleWords { count, number, .. } = part.particle;
        let shown = particles.chunks_exact(count).filter(|particle| sampling.holds(particle[number]));
        *particles = shown.flatten().copied().collect();
    }
    contents
}

/// Does what a command says; what it gives, and the arrays that go with it.
pub(super) fn execute(
    engine: &mut Engine<'_>,
    portions: &mut Portions,
    command: Command,
    contents: &[Vec<u32>],
) -> (Answer, Contents) {
    let mut samples = Vec::new();
    let nothing = |()| Vec::new();
    let done = match command {
        Command::Take => portions.take(engine, contents).map(nothing),
        Command::Upload { step } => {
            let taken = portions.take(engine, contents);
            let particles = std::mem::take(&mut portions.taken);
            taken
                .and_then(|()| engine.upload_part(step, &particles, contents.get(1..).unwrap_or_default()))
                .map(nothing)
        }
        Command::Advance { steps, batch } => engine.advance(steps, batch).map(nothing),
        Command::Finish => engine.finish().map(|finished| {
            samples = finished;
            Vec::new()
        }),
        Command::Wait => engine.wait_all().map(nothing),
        Command::Measure { samplers } => {
            engine.take_measurements(&samplers).and_then(|()| engine.wait_all()).map(nothing)
        }
        Command::State => engine.own_state().map(|own| portions.divide(engine.plan().part.as_ref(), own)),
        Command::Report => engine.own_reported().map(|own| portions.divide(engine.plan().part.as_ref(), own)),
        Command::Show { sample } => engine.own_reported().map(|own| {
            let part = engine.plan().part.as_ref();
            portions.divide(part, sampled(part, sample, own))
        }),
        Command::Momenta => engine.own_momenta(),
        Command::Next => Ok(vec![portions.next()]),
        // The first rank has loaded its numbers; the others do so in `serve`.
        Command::Renumber { .. } | Command::End => Ok(Vec::new()),
    };
    samples.extend(engine.take_samples());
    let (problem, contents) = match done {
        Ok(contents) => (None, contents),
        Err(error) => (Some(Problem::of(&error)), Vec::new()),
    };
    (Answer { samples, problem, traffic: engine.traffic(), introduction: None }, contents)
}

/// The plan of this rank for a scene in JSON.
type Replan<'p> = dyn Fn(&str) -> Result<Plan, String> + 'p;

/// Introduces itself, and does what the first rank tells until there is nothing more to do.
///
/// # Errors
/// That the first rank is lost, in words.
pub fn serve(
    engine: &mut Engine<'_>,
    introduction: RankReport,
    channel: &mut dyn Channel,
    replan: &Replan<'_>,
) -> Result<(), String> {
    let (mut failed, mut introduction, mut portions) = (None, Some(introduction), Portions::default());
    while let Some((command, contents)) = heard(channel)? {
        let (mut answer, gives) = match &failed {
            None => match command {
                Command::Renumber { scene } => renumber(engine, replan, &scene),
                command => execute(engine, &mut portions, command, &contents),
            },
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

/// Loads the numbers of a scene; its one word is 1 if they are all that differs.
fn renumber(engine: &mut Engine<'_>, replan: &Replan<'_>, scene: &str) -> (Answer, Contents) {
    match replan(scene).map(|plan| engine.load_numbers(&plan)) {
        Ok(Ok(loaded)) => (Answer { traffic: engine.traffic(), ..Answer::default() }, vec![vec![u32::from(loaded)]]),
        Ok(Err(error)) => (Answer { problem: Some(Problem::of(&error)), ..Answer::default() }, Vec::new()),
        Err(reason) => (Answer { problem: Some(Problem::Other { reason }), ..Answer::default() }, Vec::new()),
    }
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
