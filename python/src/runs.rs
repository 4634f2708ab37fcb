//! Runs and studies that write directories, and what can be said before one.

use crate::errors;
use mesoscope::families;
use mesoscope::gpu::{AdapterChoice, list_adapters};
use mesoscope::output::OutputError;
use mesoscope::plan::{Hardware, Options};
use mesoscope::run::{self, Event, Interrupt, Run, RunError};
use mesoscope::scene::{self, Checked, SceneError, WrittenScene};
use mesoscope::stability::{Request as StabilityRequest, StabilityRun, StabilitySummary};
use mesoscope::study::{Kind, Observer, Record, StudyError, StudyEvent, StudyRun};
use mesoscope::sweep::{Sweep, SweepRun, SweepSummary};
use mesoscope::tradeoff::{Length, References, Request as TradeoffRequest, Target, TradeoffRun, TradeoffSummary};
use pyo3::prelude::*;
use serde_json::json;
use std::fmt::Display;
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// How often a signal is looked for while the library works.
pub const GLANCE: Duration = Duration::from_millis(30);

/// Refuses work on devices in a process that was forked after one was opened.
pub fn check_fork(py: Python<'_>) -> PyResult<()> {
    use std::sync::atomic::{AtomicU32, Ordering};
    static OPENED_BY: AtomicU32 = AtomicU32::new(0);
    let own = std::process::id();
    match OPENED_BY.compare_exchange(0, own, Ordering::SeqCst, Ordering::SeqCst) {
        Err(other) if other != own => Err(errors::of(
            py,
            "AdapterError",
            "this process was forked after a graphics device was opened, which no driver survives: start processes with \
             multiprocessing.get_context(\"spawn\")",
        )),
        _ => Ok(()),
    }
}

/// The adapter of a name, a number, or `software`; the best of none.
pub fn choice(adapter: Option<&str>) -> AdapterChoice {
    AdapterChoice::parse(adapter)
}

/// A scene from its text, or that of a file or a name where there is none, with settings.
pub fn checked(
    name: &str,
    text: Option<String>,
    settings: &[String],
    steps: Option<u64>,
) -> Result<Checked, SceneError> {
    let written = match text {
        Some(text) => WrittenScene::new(name, text),
        None => WrittenScene::read(name)?,
    };
    written.with(settings).for_steps(steps).check()
}

/// Works in another thread while this one looks for signals, and passes on what the work says of its progress.
fn watched<T: Send>(
    py: Python<'_>,
    report: Option<&Py<PyAny>>,
    work: impl FnOnce(&Interrupt, Sender<String>) -> T + Send,
) -> (T, PyResult<()>) {
    let interrupt = Interrupt::default();
    let mut ended = Ok(());
    let result = py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = channel::<String>();
            let (own, interrupt) = (&interrupt, &interrupt);
            let thread = scope.spawn(move || work(own, sender));
            loop {
                let said = receiver.recv_timeout(GLANCE);
                if matches!(said, Err(RecvTimeoutError::Disconnected)) {
                    break;
                }
                let heard: PyResult<()> = Python::attach(|py| {
                    py.check_signals()?;
                    if let (Ok(line), Some(report)) = (said, report) {
                        report.call1(py, (line,))?;
                    }
                    Ok(())
                });
                if let (Err(error), true) = (heard, ended.is_ok()) {
                    interrupt.ask();
                    ended = Err(error);
                }
            }
            thread.join()
        })
    });
    match result {
        Ok(result) => (result, ended),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// A line of progress, as `--progress json` writes it.
fn line(event: &Event<'_>) -> Option<String> {
    let value = match event {
        Event::Started { adapter, first_step, last_step } => {
            json!({"event": "started", "adapter": adapter.name, "step": first_step, "last_step": last_step})
        }
        Event::Compiling { kernels } => json!({"event": "compiling", "kernels": kernels}),
        Event::Warned { warning } => json!({"event": "warning", "text": warning}),
        Event::Advanced(progress) => json!({
            "event": "progress",
            "step": progress.step,
            "last_step": progress.last_step,
            "temperature": progress.temperature,
            "particle_steps_per_second": progress.particle_steps_per_second,
            "remaining_seconds": progress.remaining.map(|left| left.as_secs_f64()),
        }),
        Event::Repeating { from, reason, with } => {
            json!({"event": "repeating", "step": from, "text": format!("{reason}: again from step {from} with {with}")})
        }
        Event::Finishing => json!({"event": "finishing"}),
        _ => return None,
    };
    Some(value.to_string())
}

fn execute(py: Python<'_>, run: Run, adapter: Option<&str>, report: Option<&Py<PyAny>>) -> PyResult<()> {
    check_fork(py)?;
    let choice = choice(adapter);
    let (ended, heard) = watched(py, report, move |interrupt, sender| {
        let mut observer = |event: Event<'_>| {
            if let Some(line) = line(&event) {
                drop(sender.send(line));
            }
        };
        run.until(interrupt).execute(&choice, &mut observer).map(drop)
    });
    match ended {
        Err(RunError::Interrupted { .. } | RunError::NotBegun) if heard.is_err() => heard,
        Err(error) => Err(errors::of_run(py, &error)),
        Ok(()) => heard,
    }
}

/// Runs a scene into a directory.
#[pyfunction]
#[pyo3(signature = (name, text, settings, out, *, steps=None, force=false, pictures=true, adapter=None, report=None))]
#[allow(clippy::too_many_arguments)]
pub fn run_scene(
    py: Python<'_>,
    name: &str,
    text: Option<String>,
    settings: Vec<String>,
    out: PathBuf,
    steps: Option<u64>,
    force: bool,
    pictures: bool,
    adapter: Option<&str>,
    report: Option<Py<PyAny>>,
) -> PyResult<()> {
    let scene = checked(name, text, &settings, steps).map_err(|error| errors::of_scene(py, &error))?;
    // A run in the directory of a study would hide behind it.
    if let Some(kind) = Kind::of(&out).filter(|_| !force) {
        return Err(errors::of_run(py, &OutputError::ResultExists { path: out.join(kind.summary) }.into()));
    }
    let run = if force { Run::replace(scene, out) } else { Run::start(scene, out) };
    let run = if pictures { run } else { run.without_pictures() };
    execute(py, run, adapter, report.as_ref())
}

/// Goes on with the run in a directory, in a new stage where numbers change.
#[pyfunction]
#[pyo3(signature = (directory, settings, *, steps=None, adapter=None, report=None))]
pub fn resume(
    py: Python<'_>,
    directory: PathBuf,
    settings: Vec<String>,
    steps: Option<u64>,
    adapter: Option<&str>,
    report: Option<Py<PyAny>>,
) -> PyResult<()> {
    let run = Run::resume(directory, steps)
        .and_then(|run| if settings.is_empty() { Ok(run) } else { run.in_new_stage(&settings) });
    let run = run.map_err(|error| errors::of_run(py, &error))?;
    if run.is_finished() {
        return Ok(());
    }
    execute(py, run, adapter, report.as_ref())
}

/// Requirements of a scene as JSON text: the scene with every default, its particles, memory, warnings, and the seconds
/// that it is expected to take on an adapter, where a few steps are to be timed.
#[pyfunction]
#[pyo3(signature = (name, text, settings, *, steps=None, adapter=None, time=false))]
pub fn check(
    py: Python<'_>,
    name: &str,
    text: Option<String>,
    settings: Vec<String>,
    steps: Option<u64>,
    adapter: Option<&str>,
    time: bool,
) -> PyResult<String> {
    let scene = checked(name, text, &settings, steps).map_err(|error| errors::of_scene(py, &error))?;
    let warnings: Vec<String> =
        scene.notices().iter().chain(&families::warnings(&scene)).map(ToString::to_string).collect();
    let plan = run::plan(&scene, Hardware::default(), Options::default());
    let mut found = json!({
        "scene": &*scene,
        "particles": scene.model().particle_count(),
        "memory_bytes": plan.bytes(),
        "warnings": warnings,
    });
    if time {
        check_fork(py)?;
        let choice = choice(adapter);
        let expected = py.detach(|| {
            let gpu = run::adapter_for(&scene, &choice)?;
            let expected = run::expected_time(&scene, &gpu)?;
            Ok((gpu.description().name.clone(), expected.seconds + expected.drawing))
        });
        let (adapter, seconds) = expected.map_err(|error: RunError| errors::of_run(py, &error))?;
        (found["adapter"], found["seconds"]) = (adapter.into(), seconds.into());
    }
    Ok(found.to_string())
}

/// A line of progress of a study.
fn line_of_study<E: Display, P: Display>(event: &StudyEvent<'_, E, P>) -> Option<String> {
    let value = match event {
        StudyEvent::Started { adapter, runs, at_once, .. } => {
            json!({"event": "started", "adapter": adapter.name, "runs": runs, "at_once": at_once})
        }
        StudyEvent::Ended { run, ended } => json!({"event": "ended", "run": run, "text": ended.to_string()}),
        StudyEvent::Phase { phase, runs } => json!({"event": "phase", "text": phase.to_string(), "runs": runs}),
        StudyEvent::Finishing => json!({"event": "finishing"}),
        _ => return None,
    };
    Some(value.to_string())
}

/// The arguments that all studies have.
#[derive(FromPyObject)]
pub struct Study {
    /// The scene by name, and its text where it is no file and no built-in one.
    name: String,
    text: Option<String>,
    settings: Vec<String>,
    vary: Vec<String>,
    also: Vec<String>,
    steps: Option<u64>,
    seeds: Option<u32>,
    out: PathBuf,
    force: bool,
    jobs: Option<usize>,
    replicas: Option<usize>,
    adapter: Option<String>,
    report: Option<Py<PyAny>>,
}

/// Runs a study.
fn execute_study<R, T>(
    py: Python<'_>,
    study: &Study,
    request: impl FnOnce(&str) -> Result<R::Request, StudyError>,
    execute: impl FnOnce(StudyRun<R>, &AdapterChoice, &mut Observer<'_, R>) -> Result<T, StudyError> + Send,
) -> PyResult<T>
where
    R: Record + Send,
    R::Request: Send,
    T: Send,
{
    check_fork(py)?;
    // A study reads its scene from a file or by name.
    let written = study.text.as_ref().map(|text| written(py, &study.name, text)).transpose()?;
    let source = written.as_ref().map_or_else(|| study.name.clone(), |(_, path)| path.display().to_string());
    let request = request(&source).map_err(|error| errors::of_study(py, &error))?;
    let (choice, out, force) = (choice(study.adapter.as_deref()), study.out.clone(), study.force);
    let (jobs, replicas) = (study.jobs, study.replicas);
    let (ended, heard) = watched(py, study.report.as_ref(), move |interrupt, sender| {
        let run = if force { StudyRun::<R>::replace(request, out) } else { StudyRun::start(request, out) };
        let run = run.until(interrupt).with_jobs(jobs).with_replicas(replicas);
        execute(run, &choice, &mut |event| {
            if let Some(line) = line_of_study(&event) {
                drop(sender.send(line));
            }
        })
    });
    match (ended, heard) {
        (Err(StudyError::Interrupted { .. }), Err(error)) => Err(error),
        (Err(error), _) => Err(errors::of_study(py, &error)),
        (Ok(outcome), heard) => heard.map(|()| outcome),
    }
}

/// Runs variants of a scene into a directory: names of those that failed, and why.
#[pyfunction]
pub fn sweep(py: Python<'_>, study: Study) -> PyResult<Vec<(String, String)>> {
    let Study { settings, vary, also, steps, seeds, .. } = &study;
    let request = |source: &str| match seeds {
        Some(seeds) => Sweep::load_seeded(source, settings, *steps, vary, also, *seeds),
        None => Sweep::load(source, settings, *steps, vary, also),
    };
    let outcome = execute_study::<SweepSummary, _>(py, &study, request, SweepRun::execute)?;
    let name = |number: usize| outcome.summary.variants[number].name.clone();
    Ok(outcome.failures.iter().map(|(number, error)| (name(*number), error.to_string())).collect())
}

/// Measures what accuracy costs, and gives the advice in words with the chosen scene as text.
#[pyfunction]
#[pyo3(signature = (study, *, error=None, budget=None, measures=Vec::new(), references=Vec::new(), targets=Vec::new(), finer=None))]
#[allow(clippy::too_many_arguments)]
pub fn tradeoff(
    py: Python<'_>,
    study: Study,
    error: Option<f64>,
    budget: Option<f64>,
    measures: Vec<String>,
    references: Vec<String>,
    targets: Vec<String>,
    finer: Option<String>,
) -> PyResult<(String, Option<String>)> {
    let Study { settings, vary, also, steps, .. } = &study;
    let request = |source: &str| {
        let references = References::parse(&references).map_err(|mistakes| StudyError::Arguments { mistakes })?;
        let target = |argument: &String| {
            let mistake = |message| StudyError::Arguments { mistakes: vec![format!("`{argument}`: {message}")] };
            Target::parse(argument).map_err(mistake)
        };
        TradeoffRequest::load(source, settings, *steps, vary, also)?
            .with_length(Length { error, budget })
            .with_measures(&measures)?
            .with_references(references)?
            .with_targets(targets.iter().map(target).collect::<Result<_, _>>()?)?
            .with_seeds(study.seeds.unwrap_or(1))?
            .with_finer(finer.as_deref(), None)
    };
    let outcome = execute_study::<TradeoffSummary, _>(py, &study, request, TradeoffRun::execute)?;
    let chosen = outcome.summary.chosen_scene().map_err(|error| errors::of_study(py, &error))?;
    Ok((outcome.summary.advice(), chosen))
}

/// Measures how far a scene may go: the results of its rows in words, and what else was found.
#[pyfunction]
#[pyo3(signature = (study, *, tolerance=0.05, bisections=3, measures=Vec::new(), references=Vec::new()))]
pub fn stability(
    py: Python<'_>,
    study: Study,
    tolerance: f64,
    bisections: u32,
    measures: Vec<String>,
    references: Vec<String>,
) -> PyResult<(Vec<[String; 4]>, Vec<String>)> {
    let Study { settings, vary, steps, .. } = &study;
    let request = |source: &str| {
        let references = References::parse(&references).map_err(|mistakes| StudyError::Arguments { mistakes })?;
        StabilityRequest::load(source, settings, *steps, vary)?
            .with_tolerance(tolerance)?
            .with_bisections(bisections)
            .with_seeds(study.seeds.unwrap_or(1))?
            .with_measures(&measures, references)
    };
    let outcome = execute_study::<StabilitySummary, _>(py, &study, request, StabilityRun::execute)?;
    Ok((outcome.summary.in_words(), outcome.summary.findings()))
}

/// The text of a scene as a file, which lasts as long as the first value.
fn written(py: Python<'_>, name: &str, text: &str) -> PyResult<(Py<PyAny>, PathBuf)> {
    let directory = py.import("tempfile")?.call_method0("TemporaryDirectory")?;
    let path = PathBuf::from(directory.getattr("name")?.extract::<String>()?).join(format!("{name}.json"));
    std::fs::write(&path, text)?;
    Ok((directory.unbind(), path))
}

/// The names of the built-in scenes with their texts.
#[pyfunction]
pub fn scenes() -> Vec<(&'static str, &'static str)> {
    scene::builtin().iter().map(|scene| (scene.name, scene.text)).collect()
}

/// The schema of scenes, as JSON text.
#[pyfunction]
pub fn schema() -> String {
    scene::schema().to_string()
}

/// The adapters, the best first: name, driver, kind.
#[pyfunction]
pub fn adapters(py: Python<'_>) -> PyResult<Vec<(String, String, String)>> {
    check_fork(py)?;
    let all = py.detach(list_adapters);
    Ok(all.into_iter().map(|found| (found.name, found.driver, format!("{:?}", found.kind).to_lowercase())).collect())
}

/// Environment variables that drivers need and that are not set.
#[pyfunction]
pub fn driver_environment() -> Vec<(&'static str, String)> {
    mesoscope::gpu::driver_environment(1)
}
