//! What a step costs: all choices timed in turns, round by round, in one process.

use crate::engine::{Engine, EngineError};
use crate::families::Model;
use crate::gpu::{AdapterChoice, Gpu, Requirements};
use crate::plan::{Hardware, Options, Plan};
use crate::run::{self, RunError};
use crate::scene::Scene;
use crate::state::State;
use crate::study::StudyError;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Rounds in which every choice has its turn.
const ROUNDS: usize = 7;
/// Seconds of a turn: long enough for a clock, short enough for a machine that speeds up and slows down.
const TURN: f64 = 0.12;
/// Choices share the memory of the adapter as long as all of them take no more than this, in bytes; else each is made again for its
/// turn.
const SHARED: u64 = 1 << 30;

/// What a choice costs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Seconds of steps a unit of simulated time: the median of all rounds.
    pub seconds_per_time: f64,
    /// The fastest round.
    pub fastest: f64,
    /// The slowest round.
    pub slowest: f64,
    /// Particles times steps a second, at the median.
    pub particle_steps_per_second: f64,
    /// Bytes of buffers and textures on the device, a particle.
    pub bytes_per_particle: f64,
}

/// A choice to be timed: its name, its scene, and a state that it has come to.
pub(super) struct Timed<'a> {
    pub name: &'a str,
    pub scene: &'a Scene,
    pub state: &'a State,
}

/// An engine of steps without reports, and how many of them fill a turn.
struct Runner<'a> {
    engine: Engine<'a>,
    steps: u64,
}

/// The cost of every choice; none where its steps end in instability before they are timed.
///
/// # Errors
/// No adapter, or one that fails.
pub(super) fn measure(
    choices: &[Timed<'_>],
    adapter: &AdapterChoice,
    proceed: &dyn Fn() -> Result<(), StudyError>,
) -> Result<Vec<Option<Cost>>, StudyError> {
    let plans = |hardware: Hardware| choices.iter().map(move |choice| steps_of(choice, hardware, Options::default()));
    let mut requirements = Requirements::default();
    for plan in plans(Hardware::default()) {
        requirements.largest_buffer = requirements.largest_buffer.max(plan.largest_buffer());
        requirements.storage_buffers = requirements.storage_buffers.max(plan.storage_buffers);
    }
    let gpu = Gpu::open(adapter, requirements)?;
    let bytes: Vec<u64> = plans(Hardware::from(&gpu)).map(|plan| plan.bytes()).collect();
    let shares = bytes.iter().sum::<u64>() <= SHARED;
    let mut runners: Vec<Option<Runner<'_>>> = choices.iter().map(|_| None).collect();
    let mut steps: Vec<Option<u64>> = vec![None; choices.len()];
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); choices.len()];
    let mut ended = vec![false; choices.len()];
    let mut options = vec![Options::default(); choices.len()];
    for round in 0..ROUNDS {
        // There and back, so that no choice is always the first.
        let order: Vec<usize> =
            if round % 2 == 0 { (0..choices.len()).collect() } else { (0..choices.len()).rev().collect() };
        for index in order.into_iter().filter(|index| !ended[*index]).collect::<Vec<_>>() {
            proceed()?;
            let choice = &choices[index];
            let wrong = |source: EngineError| StudyError::of_run(choice.name, source);
            let mut runner = match runners[index].take() {
                Some(runner) => runner,
                None => match open(&gpu, choice, steps[index], &mut options[index]) {
                    Ok(runner) => runner,
                    Err(error) if is_a_result(&error) => {
                        ended[index] = true;
                        continue;
                    }
                    Err(error) => return Err(wrong(error)),
                },
            };
            steps[index] = Some(runner.steps);
            let start = Instant::now();
            match runner.engine.advance(runner.steps, runner.steps).and_then(|()| runner.engine.finish()) {
                Ok(_) => {
                    let seconds = start.elapsed().as_secs_f64();
                    times[index].push(seconds / (runner.steps as f64 * choice.scene.time.step));
                }
                Err(error) if is_a_result(&error) => {
                    ended[index] = true;
                    continue;
                }
                // The next turn begins with more room, as a run does.
                Err(EngineError::Crowded { .. }) if options[index].has_room_left() => {
                    options[index] = options[index].with_room(choice.state.len() as u64);
                    continue;
                }
                Err(error) => return Err(wrong(error)),
            }
            if shares {
                runners[index] = Some(runner);
            }
        }
    }
    let cost = |index: usize| {
        let mut sorted = times[index].clone();
        sorted.sort_by(f64::total_cmp);
        let particles = choices[index].state.len() as f64;
        let median = *sorted.get(sorted.len() / 2)?;
        Some(Cost {
            seconds_per_time: median,
            fastest: sorted[0],
            slowest: sorted[sorted.len() - 1],
            particle_steps_per_second: particles / (median * choices[index].scene.time.step),
            bytes_per_particle: bytes[index] as f64 / particles.max(1.0),
        })
    };
    Ok((0..choices.len()).map(cost).collect())
}

/// Whether an error says something about the choice, not about the machine.
fn is_a_result(error: &EngineError) -> bool {
    matches!(error, EngineError::Unstable(_) | EngineError::GaveUp { .. })
}

/// Whether a run ended because of what it simulates.
pub(super) fn is_unstable(error: &RunError) -> bool {
    match error {
        RunError::Unstable { .. } | RunError::UnstableTrial(_) | RunError::GaveUp { .. } => true,
        RunError::Engine(error) => is_a_result(error),
        _ => false,
    }
}

fn steps_of(choice: &Timed<'_>, hardware: Hardware, options: Options) -> Plan {
    let scene = choice.scene;
    run::plan(&Model::new(scene), scene.time.equilibration, &scene.output, hardware, options).without_reports()
}

/// Makes an engine for a turn, and finds how many steps fill one where that is not known.
fn open<'a>(
    gpu: &'a Gpu,
    choice: &Timed<'_>,
    steps: Option<u64>,
    options: &mut Options,
) -> Result<Runner<'a>, EngineError> {
    loop {
        match try_to_open(gpu, choice, steps, *options) {
            // As a run does.
            Err(EngineError::Crowded { .. }) if options.has_room_left() => {
                *options = options.with_room(choice.state.len() as u64);
            }
            opened => return opened,
        }
    }
}

fn try_to_open<'a>(
    gpu: &'a Gpu,
    choice: &Timed<'_>,
    steps: Option<u64>,
    options: Options,
) -> Result<Runner<'a>, EngineError> {
    let mut engine = Engine::new(gpu, steps_of(choice, Hardware::from(gpu), options), choice.state)?;
    // The first steps touch memory for the first time.
    engine.advance(4, 4)?;
    engine.finish()?;
    if let Some(steps) = steps {
        return Ok(Runner { engine, steps });
    }
    let mut steps = 1;
    loop {
        let start = Instant::now();
        engine.advance(steps, steps)?;
        engine.finish()?;
        let seconds = start.elapsed().as_secs_f64();
        if seconds >= 0.5 * TURN {
            let fit = steps as f64 * TURN / seconds;
            return Ok(Runner { engine, steps: (fit as u64).max(1) });
        }
        steps *= 2;
    }
}
