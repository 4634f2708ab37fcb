//! `mesoscope sweep`: runs of one scene that differ in a few values.

use mesoscope::printable;
use mesoscope::run::RunError;
use mesoscope::sweep::{Look, Sweep, SweepOutcome, SweepRun};

use super::{Failure, StudyArguments, VariantArguments, print, sweep_report, whole_number};

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
    #[command(flatten)]
    variants: VariantArguments,

    /// Number of steps of all variants, as for `mesoscope run`
    #[arg(long, value_name = "N", value_parser = whole_number, allow_negative_numbers = true, conflicts_with = "resume")]
    steps: Option<u64>,

    /// Seed of the random numbers of all variants; short for `--set seed=N`
    #[arg(long, value_name = "N", conflicts_with = "resume")]
    seed: Option<u64>,

    /// Plot every quantity divided by its own first value
    #[arg(long)]
    relative: bool,

    /// Plot these columns of the tables of energies; may be repeated [default: all that change]
    #[arg(long, value_name = "QUANTITY,…", value_delimiter = ',')]
    plot: Vec<String>,

    #[command(flatten)]
    study: StudyArguments,
}

/// Runs the variants.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { variants: VariantArguments { vary, also }, study, .. } = arguments;
    let mut run: SweepRun = study.study(|scene| {
        let seed = arguments.seed.map(|seed| format!("seed={seed}"));
        let set: Vec<String> = study.set.iter().cloned().chain(seed).collect();
        Ok(Sweep::load(scene, &set, arguments.steps, vary, also)?)
    })?;
    let look = Look { relative: arguments.relative, quantities: arguments.plot.clone() };
    if look != Look::default() {
        run = run.with_look(look);
    }
    let (sweep, directory, quiet) = (run.request().clone(), printable::path(run.directory()), study.how.quiet);
    if !quiet {
        sweep_report::warn(&sweep);
    }
    let title = sweep.variants().first().map_or("", |variant| &variant.scene.title);
    let outcome = study.execute(run, title, |waiting| in_words(&sweep, waiting), SweepRun::execute)?;
    if !quiet {
        sweep_report::warn_of_results(&sweep, &outcome);
        print(&sweep_report::results(&outcome, &directory))?;
    }
    failures(&outcome)
}

/// How many variants there are, and of what.
fn in_words(sweep: &Sweep, waiting: usize) -> String {
    let keys: Vec<&str> = sweep.variations().iter().map(|variation| variation.key.as_str()).collect();
    let all = sweep.variants().len();
    let count = if waiting == all {
        format!("{all} variant{}", if all == 1 { "" } else { "s" })
    } else {
        format!("{waiting} of {all} variants left")
    };
    format!("{count} of {}", keys.join(", "))
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
