//! One scene of a map: run until it is plain what becomes of it.

use super::request::Arguments;
use super::verdict::{Verdict, verdict};
use crate::engine::EngineError;
use crate::families::Checked;
use crate::gpu::AdapterChoice;
use crate::measure::equilibration::transient;
use crate::run::{self, Interrupt, RunError, Sight, Simulation, Stop};
use crate::scene::SceneError;
use crate::table::Table;
use crate::tradeoff::{self, Deviation, Measured, References, errors_in_words};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::panic::resume_unwind;
use std::thread;

/// Parts of the averaged time after which a verdict that is certain ends a run.
const PARTS: [f64; 3] = [0.25, 0.5, 1.0];

/// Particles below which a measure may have no number for no other reason: a single one that keeps its momentum has no temperature, and two
/// that do not meet have no forces.
const FEW: u64 = 3;

/// What became of one scene of a map.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Cell {
    /// The value of the key along its row.
    pub value: f64,
    /// What became of it.
    pub verdict: Verdict,
    /// Whether its errors are certain enough for that.
    pub is_certain: bool,
    /// Steps that it ran.
    pub steps: u64,
    /// Its time step; none where it was refused.
    pub time_step: Option<f64>,
    /// How far measures are off.
    pub errors: Vec<Deviation>,
    /// Why it was refused, or became unstable.
    pub reason: Option<String>,
    /// Measures that are still on their way to equilibrium: their errors say little.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unequilibrated: Vec<String>,
    /// Measures that so few particles do not have.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undefined: Vec<String>,
}

impl Cell {
    /// A scene that is none.
    pub(super) fn refused(value: f64, reason: String) -> Self {
        Self { value, verdict: Verdict::Refused, is_certain: true, reason: Some(reason), ..Self::default() }
    }

    /// Why it was refused, or became unstable, in a line.
    pub(super) fn reason_in_a_line(&self) -> Option<String> {
        let mut lines = self.reason.as_deref()?.lines();
        let first = lines.next()?.to_owned();
        // A heading has the mistakes below it.
        Some(if first.ends_with(':') { format!("{first} {}", lines.next().unwrap_or_default().trim()) } else { first })
    }

    /// What so few particles do not have, in words.
    pub(super) fn lacks(&self) -> Option<String> {
        (!self.undefined.is_empty()).then(|| format!("so few particles have no {}", listed(&self.undefined)))
    }

    /// Whether it has an error of all of these measures.
    pub(super) fn is_compared(&self, measures: &[String]) -> bool {
        measures.iter().all(|measure| self.error(measure).is_some())
    }

    /// The error of a measure.
    #[must_use]
    pub fn error(&self, measure: &str) -> Option<&Deviation> {
        self.errors.iter().find(|error| error.measure == measure)
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let nothing_is_known = self.verdict == Verdict::Right && self.errors.is_empty() && !self.undefined.is_empty();
        let verdict = if nothing_is_known { "ran to its end".to_owned() } else { self.verdict.to_string() };
        formatter.write_str(&verdict)?;
        let what = match self.verdict {
            _ if nothing_is_known => self.lacks().unwrap_or_default(),
            Verdict::Right | Verdict::Biased if self.reason.is_none() => errors_in_words(&self.errors),
            _ => self.reason_in_a_line().unwrap_or_default(),
        };
        if what.is_empty() { Ok(()) } else { write!(formatter, ": {what}") }
    }
}

/// True if an error says that there can be no such run here.
pub(super) fn is_of_the_scene(error: &RunError) -> bool {
    match error {
        RunError::Scene(error) => !matches!(error, SceneError::StateChanged { .. }),
        error => error.exceeds_adapter(),
    }
}

/// Runs a scene, with each seed, of which the device advances up to `together` at once, and compares measures with what they should be; none if
/// it was asked to stop.
///
/// # Errors
/// [`RunError`], also for what says something about the scene.
pub(super) fn evaluate(
    value: f64,
    scenes: &[Checked],
    measures: &[String],
    arguments: &Arguments,
    together: usize,
    adapter: &AdapterChoice,
    interrupt: &Interrupt,
) -> Result<Option<Cell>, RunError> {
    let Some(scene) = scenes.first() else { return Ok(None) };
    let gpu = run::adapter_for(scene, adapter)?;
    let trials = Simulation::side_by_side(Sight::EnergiesAlone, &gpu, scenes, together)?.into_iter();
    let mut trials: Vec<Simulation> = trials.map(|trial| trial.until(interrupt)).collect();
    let (equilibration, every) = (scene.time.equilibration, scene.output.energies.every.max(1));
    let averaged = scene.time.steps.saturating_sub(equilibration);
    let mut cell = Cell { value, time_step: Some(scene.time.step), ..Cell::default() };
    for part in PARTS {
        let more = ((part * averaged as f64 / every as f64).ceil() as u64).saturating_mul(every);
        let last = equilibration.saturating_add(more);
        let mut ended = advance_together(&mut trials, last, together).into_iter();
        for trial in &mut trials {
            let ended = ended.next().unwrap_or_else(|| trial.advance_to(last, None));
            cell.steps = trial.step();
            match ended {
                Ok(Stop::Reached) => {}
                Ok(Stop::Interrupted) => return Ok(None),
                Err(error) => {
                    let Some(reason) = reason_of_instability(&error) else { return Err(error) };
                    let seed =
                        if scenes.len() > 1 { format!(" with the seed {}", trial.scene().seed) } else { String::new() };
                    (cell.verdict, cell.is_certain, cell.reason) = (Verdict::Unstable, true, Some(reason + &seed));
                    cell.errors.clear();
                    return Ok(Some(cell));
                }
            }
        }
        let (errors, lost) = compare(&trials, scene, measures, &arguments.references);
        cell.errors = errors;
        (cell.verdict, cell.is_certain) = verdict(&cell.errors, arguments.tolerance);
        if scene.model().particle_count() < FEW {
            cell.undefined = lost;
        } else if !lost.is_empty() {
            (cell.verdict, cell.is_certain) = (Verdict::Biased, true);
            let has = if lost.len() == 1 { "has" } else { "have" };
            cell.reason = Some(format!("{} {has} no number", listed(&lost)));
        }
        cell.unequilibrated = unequilibrated(&trials, &cell.errors);
        cell.is_certain &= cell.unequilibrated.is_empty();
        // Of what no law applies to here, as of a temperature without friction, nothing is known.
        cell.is_certain &= cell.reason.is_some() || cell.is_compared(measures);
        if cell.is_certain && !measures.is_empty() {
            break;
        }
    }
    Ok(Some(cell))
}

/// Advances simulations that wait for each other, if the device advances several together; none of those that it advances in turns, so
/// that no other need follow one that fails.
fn advance_together(trials: &mut [Simulation], last: u64, together: usize) -> Vec<Result<Stop, RunError>> {
    if together < 2 || trials.len() < 2 {
        return Vec::new();
    }
    thread::scope(|scope| {
        let advanced: Vec<_> =
            trials.iter_mut().map(|trial| scope.spawn(move || trial.advance_to(last, None))).collect();
        advanced.into_iter().map(|ended| ended.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    })
}

/// Why a simulation became unstable, if it did.
fn reason_of_instability(error: &RunError) -> Option<String> {
    match error {
        RunError::UnstableTrial(reason) => Some(format!("{} at step {}", reason.quantity, reason.step)),
        RunError::Engine(error @ EngineError::GaveUp { .. }) => Some(error.to_string()),
        _ => None,
    }
}

/// Names of measures in a sentence.
pub(super) fn listed<'m>(measures: impl IntoIterator<Item = &'m String>) -> String {
    measures.into_iter().map(|measure| format!("`{measure}`")).collect::<Vec<_>>().join(", ")
}

/// How far measures are off in the means over all runs of a scene, and which are not numbers.
fn compare(
    trials: &[Simulation],
    scene: &Checked,
    measures: &[String],
    given: &References,
) -> (Vec<Deviation>, Vec<String>) {
    let measured = |trial: &Simulation| -> Vec<Measured> {
        let means = trial.means().into_iter().filter_map(|(name, mean)| {
            let mean = mean?;
            Some(Measured::mean(name.to_owned(), mean.value, mean.error, mean.few))
        });
        tradeoff::of_table(&trial.energies(), scene).into_iter().chain(means).collect()
    };
    let all: Vec<Vec<Measured>> = trials.iter().map(measured).collect();
    let all = tradeoff::over_seeds(&all.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let (mut errors, mut lost) = (Vec::new(), Vec::new());
    for measure in measures {
        let Some(reference) = given.known(measure, scene) else { continue };
        let measured = all.iter().find(|found| found.measure == *measure);
        match measured.map(|measured| Deviation::new(measured, &reference)).filter(|found| found.error.is_finite()) {
            Some(error) => errors.push(error),
            None => lost.push(measure.clone()),
        }
    }
    (errors, lost)
}

/// Measures whose rows after equilibration begin with a transient in some run.
fn unequilibrated(trials: &[Simulation], errors: &[Deviation]) -> Vec<String> {
    let settled: Vec<Table> = trials.iter().map(Simulation::settled).collect();
    let begins = |error: &&Deviation| {
        let mut rows = settled.iter().filter_map(|settled| settled.column(&error.measure));
        rows.any(|rows| transient(&rows).is_some())
    };
    errors.iter().filter(begins).map(|error| error.measure.clone()).collect()
}
