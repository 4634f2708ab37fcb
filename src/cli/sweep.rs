//! `mesoscope sweep`: runs of one scene that differ in a few values.

use std::path::PathBuf;

use mesoscope::run::RunError;
use mesoscope::sweep::{Look, Sweep, SweepError, SweepOutcome, SweepRun};

use super::sweep_report::{self, Reporter};
use super::{Failure, RunArguments, print, report, whole_number};

/// Run variants of a scene, and compare them in one table and one plot per quantity
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope sweep dpd-fluid --vary interactions.0.friction=1,4.5,20
  mesoscope sweep dpd-fluid --vary time.step=0.02,0.04 --vary integrator.type=splitting,groot-warren
  mesoscope sweep dpd-fluid --vary 'space.box=[8,8,8],[10,10,10]' --steps 500 --plot pressure --out boxes
  mesoscope sweep dpd-fluid --vary interactions.0.friction=1,4.5 --also interactions.0.friction=0,temperature=0
  mesoscope sweep --resume dpd-fluid-sweep               finish a sweep that was interrupted
  mesoscope sweep --resume dpd-fluid-sweep --relative    the same plots, every quantity over its first value

Every variant has a directory of its own, `friction=4.5`, which `mesoscope resume` and `mesoscope plot` understand.
A variant that becomes unstable does not stop the others; the exit code is then 4.")]
pub struct Arguments {
    /// A scene file, or the name of a built-in scene (see `mesoscope scenes`)
    #[arg(required_unless_present = "resume")]
    scene: Option<String>,

    /// A key of the scene and the values to try. Repeated, every combination is run. A value is JSON, or else text;
    /// the path is as in `--set`
    #[arg(long, value_name = "PATH=VALUE,…", required_unless_present = "resume")]
    vary: Vec<String>,

    /// One more variant besides the combinations, with settings of its own; may be repeated
    #[arg(long, value_name = "PATH=VALUE,…")]
    also: Vec<String>,

    /// Change one value in all variants, as for `mesoscope run`; may be repeated
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,

    /// Number of steps of all variants, as for `mesoscope run`
    #[arg(long, value_name = "N", value_parser = whole_number, allow_negative_numbers = true)]
    steps: Option<u64>,

    /// Seed of the random numbers of all variants; short for `--set seed=N`
    #[arg(long, value_name = "N")]
    seed: Option<u64>,

    /// Directory for all variants [default: the scene's name and `-sweep`, in the working directory]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Finish the sweep in this directory: run the variants that are missing, draw the plots again
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "vary", "also", "set", "steps", "seed", "out", "force"])]
    resume: Option<PathBuf>,

    /// Plot every quantity divided by its own first value
    #[arg(long)]
    relative: bool,

    /// Plot these columns of the tables of energies; may be repeated [default: all that change]
    #[arg(long, value_name = "QUANTITY,…", value_delimiter = ',')]
    plot: Vec<String>,

    /// Variants to run at once [default: 2 on a software adapter where a step is short, as of fewer than 18,000 particles
    /// of a DPD fluid or 280,000 of shallow water, which is 1.1 to 1.5 times as fast; otherwise 1]. Results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,

    #[command(flatten)]
    how: RunArguments,
}

/// Runs the variants.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let look = Look { relative: arguments.relative, quantities: arguments.plot.clone() };
    let (run, directory) = if let Some(directory) = &arguments.resume {
        let look = (look != Look::default()).then_some(look);
        (SweepRun::resume(directory, look)?, directory.clone())
    } else {
        // The scene is there, or the command line would have been refused.
        let scene = arguments.scene.as_deref().unwrap_or_default();
        let seed = arguments.seed.map(|seed| format!("seed={seed}"));
        let set: Vec<String> = arguments.set.iter().cloned().chain(seed).collect();
        let sweep = Sweep::load(scene, &set, arguments.steps, &arguments.vary, &arguments.also)?;
        let directory = arguments.out.clone().unwrap_or_else(|| format!("{}-sweep", report::stem(scene)).into());
        (SweepRun::start(sweep, &directory, look, arguments.how.force), directory)
    };
    let choice = arguments.how.adapter.choice();
    let jobs = arguments.jobs.map(usize::from);
    let run = run.until(&super::interruption::interrupt());
    let outcome = if arguments.how.quiet {
        run.execute(&choice, jobs, &mut |_| {})?
    } else {
        let mut reporter = Reporter::new(run.sweep().clone());
        reporter.warn();
        let executed = run.execute(&choice, jobs, &mut |event| reporter.show(event));
        reporter.clear();
        let outcome = executed?;
        reporter.warn_of_results(&outcome);
        print(&sweep_report::results(&outcome, &directory.display().to_string()))?;
        outcome
    };
    failures(&outcome)
}

/// What failed, with the exit code of the worst.
fn failures(outcome: &SweepOutcome) -> Result<(), Failure> {
    if outcome.failures.is_empty() {
        return Ok(());
    }
    let (failed, all) = (outcome.failures.len(), outcome.summary.variants.len());
    let messages = outcome.failures.iter().map(|(variant, error)| {
        let name = &outcome.summary.variants[*variant].name;
        format!("\n`{name}`: {error}")
    });
    let mut text = format!("{failed} of {all} variants failed:{}", messages.collect::<String>());
    if outcome.failures.iter().any(|(_, error)| matches!(error, RunError::Output(_) | RunError::Checkpoint(_))) {
        text.push_str("\nhint: `mesoscope sweep --resume` runs a variant again once its directory is removed");
    }
    // Instability says something about the scene; anything else, about the machine, and comes first.
    let others = outcome
        .failures
        .iter()
        .find(|(_, error)| !matches!(error, RunError::Unstable { .. } | RunError::GaveUp { .. }));
    Err(others.map_or_else(|| Failure::unstable(&text), |(_, error)| Failure::of_run(error, &text)))
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Scene(error) => error.into(),
            SweepError::Gpu(error) => error.into(),
            SweepError::Run(error) => error.into(),
            SweepError::Interrupted { .. } => Self::interrupted(error.to_string()),
            SweepError::Variants { .. } => Self::usage(format!(
                "{error}\nhint: `mesoscope schema` prints every key with its meaning; nothing has been run"
            )),
            SweepError::Arguments { .. } | SweepError::Quantity { .. } => Self::usage(error.to_string()),
            SweepError::Output(mesoscope::output::OutputError::ResultExists { .. }) => Self::input_output(format!(
                "{error}\nhint: `mesoscope sweep --resume DIR` finishes an interrupted sweep"
            )),
            _ => Self::input_output(error.to_string()),
        }
    }
}
