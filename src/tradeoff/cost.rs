//! What a step costs: all choices timed in turns, round by round, in one process.

use crate::engine::{Engine, EngineError};
use crate::families::Checked;
use crate::gpu::{AdapterChoice, Gpu, Requirements};
use crate::plan::{Hardware, Options, Plan};
use crate::run::{self, RunError};
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
    pub scene: &'a Checked,
    pub state: State,
}

/// A choice that has its turns.
struct Runner<'a> {
    choice: &'a Timed<'a>,
    options: Options,
    /// An engine of steps without reports, between turns only where all of them fit into memory.
    engine: Option<Engine<'a>>,
    /// How many steps fill a turn, once that is known.
    steps: Option<u64>,
    /// Seconds of steps a unit of simulated time, turn by turn.
    times: Vec<f64>,
    has_ended: bool,
}

impl<'a> Runner<'a> {
    /// Times steps, with more room where that is wanted, as a run does.
    fn take_turn(&mut self, gpu: &'a Gpu) -> Result<(), EngineError> {
        let Err(error) = self.advance(gpu) else { return Ok(()) };
        if is_a_result(&error) {
            self.has_ended = true;
            return Ok(());
        }
        self.options = error.roomier(self.options, self.choice.state.len() as u64).ok_or(error)?;
        self.take_turn(gpu)
    }

    fn advance(&mut self, gpu: &'a Gpu) -> Result<(), EngineError> {
        let mut engine = if let Some(engine) = self.engine.take() {
            engine
        } else {
            let plan = steps_of(self.choice, Hardware::from(gpu), self.options);
            let mut engine = Engine::new(gpu, plan, &self.choice.state)?;
            // The first steps touch memory for the first time.
            seconds_of(&mut engine, 4)?;
            engine
        };
        let steps = self.steps.map_or_else(|| steps_of_a_turn(&mut engine), Ok)?;
        self.steps = Some(steps);
        let seconds = seconds_of(&mut engine, steps)?;
        self.times.push(seconds / (steps as f64 * self.choice.scene.time.step));
        self.engine = Some(engine);
        Ok(())
    }

    /// The cost, with the room that it has come to; none where there was no turn.
    fn cost(mut self, gpu: &Gpu) -> Option<Cost> {
        self.times.sort_by(f64::total_cmp);
        let particles = self.choice.state.len() as f64;
        let bytes = steps_of(self.choice, Hardware::from(gpu), self.options).bytes();
        let median = *self.times.get(self.times.len() / 2)?;
        Some(Cost {
            seconds_per_time: median,
            fastest: self.times[0],
            slowest: self.times[self.times.len() - 1],
            particle_steps_per_second: particles / (median * self.choice.scene.time.step),
            bytes_per_particle: bytes as f64 / particles.max(1.0),
        })
    }
}

/// Seconds that steps take.
fn seconds_of(engine: &mut Engine<'_>, steps: u64) -> Result<f64, EngineError> {
    let start = Instant::now();
    engine.advance(steps, steps)?;
    engine.finish()?;
    Ok(start.elapsed().as_secs_f64())
}

/// How many steps fill a turn.
fn steps_of_a_turn(engine: &mut Engine<'_>) -> Result<u64, EngineError> {
    let mut steps = 1;
    loop {
        let seconds = seconds_of(engine, steps)?;
        if seconds >= 0.5 * TURN {
            return Ok(((steps as f64 * TURN / seconds) as u64).max(1));
        }
        steps *= 2;
    }
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
    let shares = plans(Hardware::from(&gpu)).map(|plan| plan.bytes()).sum::<u64>() <= SHARED;
    let runner = |choice| {
        let options = Options::default();
        Runner { choice, options, engine: None, steps: None, times: Vec::new(), has_ended: false }
    };
    let mut runners: Vec<Runner<'_>> = choices.iter().map(runner).collect();
    for round in 0..ROUNDS {
        for place in 0..runners.len() {
            // There and back, so that no choice is always the first.
            let index = if round % 2 == 0 { place } else { runners.len() - 1 - place };
            let runner = &mut runners[index];
            if runner.has_ended {
                continue;
            }
            proceed()?;
            runner.take_turn(&gpu).map_err(|source| StudyError::of_run(runner.choice.name, source))?;
            if !shares {
                runner.engine = None;
            }
        }
    }
    Ok(runners.into_iter().map(|runner| runner.cost(&gpu)).collect())
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
    run::plan(scene, hardware, options).without_reports()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{families, scene};

    /// All particles lie in the first cells along x, for which the plan of a fluid that fills the box has no room.
    #[test]
    fn a_crowded_choice_is_timed_with_more_room_which_it_costs() {
        let set = [
            "space.box=[16,8,8]",
            r#"particles=[{"species":"A","count":3000}]"#,
            r#"integrator={"type":"groot-warren"}"#,
            "interactions.0.repulsion=0.01",
            "temperature=0.01",
            "time.step=0.002",
        ];
        let scene = scene::load("dpd-fluid", &set.map(str::to_owned)).unwrap();
        let mut state = families::initial_state(&scene);
        for position in &mut state.positions {
            position[0] = (position[0] >> 6).wrapping_sub(1 << 25);
        }
        let choice = Timed { name: "crowd", scene: &scene, state };
        let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default()).unwrap();
        let usual = steps_of(&choice, Hardware::from(&gpu), Options::default()).bytes();
        let cost = measure(&[choice], &AdapterChoice::Best, &|| Ok(())).unwrap()[0].unwrap();
        assert!(3000.0 * cost.bytes_per_particle > usual as f64, "{cost:?}: {usual}");
    }
}
