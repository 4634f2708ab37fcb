//! `mesoscope sweep`: runs of one scene that differ in a few values.

use mesoscope::numbers::counted;
use mesoscope::printable;
use mesoscope::run::RunError;
use mesoscope::sweep::{Look, Shard, Sweep, SweepOutcome, SweepRun, Variant};

use super::{Failure, StudyArguments, VariantArguments, heading, launcher, print, sweep_report};

/// Run variants of a scene, and compare them in one table and one plot per quantity
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope sweep dpd-fluid --vary interactions.0.friction=1,4.5,20
  mesoscope sweep dpd-fluid --vary time.step=0.02,0.04 --vary integrator.type=splitting,groot-warren
  mesoscope sweep dpd-fluid --vary 'space.box=[8,8,8],[10,10,10]' --steps 500 --plot pressure --out boxes
  mesoscope sweep dpd-fluid --vary interactions.0.friction=1,4.5 --also interactions.0.friction=0,temperature=0
  mesoscope sweep dpd-fluid --vary interactions.0.friction=1,4.5 --seeds 8     eight runs each, and their means with errors
  mesoscope sweep --resume dpd-fluid-sweep               finish a sweep that was interrupted
  mesoscope sweep --resume dpd-fluid-sweep --relative    the same plots, every quantity over its first value
  mesoscope sweep dpd-fluid --vary seed=1,2,3,4 --shard 1/2    its first half: seeds 1 and 3; 2/2 is the other

Every variant has a directory of its own, `friction=4.5`, which `mesoscope resume` and `mesoscope plot` understand.
A variant that becomes unstable does not stop the others; the exit code is then 4. Shards run at the same time, on several \
machines if they share the directory; `mesoscope sweep --resume DIR` gathers what they left, and runs what is missing.")]
pub struct Arguments {
    #[command(flatten)]
    variants: VariantArguments,

    /// Seed of the random numbers of all variants; short for `--set seed=N`
    #[arg(long, help_heading = heading::SCENE, value_name = "N", conflicts_with = "resume")]
    seed: Option<u64>,

    /// Plot every quantity divided by its own first value
    #[arg(long, help_heading = heading::OUTPUT)]
    relative: bool,

    /// Plot these columns of the tables of energies; may be repeated [default: all that change]
    #[arg(long, help_heading = heading::OUTPUT, value_name = "QUANTITY,…", value_delimiter = ',')]
    plot: Vec<String>,

    /// Run one of several parts of the variants: of 16 shards, 3/16 has variants 3, 19, 35, … in their order, counted from 1.
    /// `auto` takes the numbers from Slurm, Grid Engine or a launcher of MPI. Shards leave no table and no plots
    #[arg(long, help_heading = heading::SEVERAL, value_name = "I/N|auto", value_parser = shard, conflicts_with_all = ["resume", "force"])]
    pub shard: Option<ShardArgument>,

    #[command(flatten)]
    study: StudyArguments,
}

impl Arguments {
    /// Independent runs of one scene.
    pub fn of_seeds(seed: Option<u64>, study: StudyArguments) -> Self {
        let variants = VariantArguments { vary: Vec::new(), also: Vec::new() };
        Self { variants, seed, relative: false, plot: Vec::new(), shard: None, study }
    }
}

/// Which shard.
#[derive(Debug, Clone, Copy)]
pub enum ShardArgument {
    /// This one.
    Given(Shard),
    /// The one that the environment says.
    Auto,
}

fn shard(text: &str) -> Result<ShardArgument, String> {
    match text {
        "auto" => Ok(ShardArgument::Auto),
        text => Shard::parse(text).map(ShardArgument::Given).map_err(|accepted| format!("{accepted}, or `auto`")),
    }
}

/// Runs the variants.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let shard = match arguments.shard {
        None => None,
        Some(ShardArgument::Given(shard)) => Some(shard),
        Some(ShardArgument::Auto) => Some(launcher::shard()?),
    };
    let Arguments { variants: VariantArguments { vary, also }, study, .. } = arguments;
    let mut run: SweepRun = study.study(|scene| {
        let seed = arguments.seed.map(|seed| format!("seed={seed}"));
        let set: Vec<String> = study.set.iter().cloned().chain(seed).collect();
        Ok(match study.seeds {
            Some(seeds) => Sweep::load_seeded(scene, &set, study.steps, vary, also, seeds)?,
            None => Sweep::load(scene, &set, study.steps, vary, also)?,
        })
    })?;
    let look = Look { relative: arguments.relative, quantities: arguments.plot.clone() };
    if look != Look::default() {
        run = run.with_look(look);
    }
    let (sweep, directory, quiet) = (run.request().clone(), printable::path(run.directory()), study.how.quiet);
    let is_own = |place: usize| shard.is_none_or(|shard| shard.has(place));
    let variants: Vec<&Variant> =
        sweep.variants().iter().enumerate().filter(|(place, _)| is_own(*place)).map(|(_, variant)| variant).collect();
    if !quiet {
        sweep_report::warn(&variants);
    }
    let title = sweep.variants().first().map_or("", |variant| &variant.scene.title);
    let in_words = |waiting| in_words(&sweep, shard, variants.len(), waiting);
    let outcome = study.execute(run, title, in_words, |run, adapter, observer| match shard {
        None => run.execute(adapter, observer),
        Some(shard) => run.execute_shard(shard, adapter, observer),
    })?;
    if !quiet {
        sweep_report::warn_of_results(&variants, &outcome);
        print(&sweep_report::results(&outcome, &directory))?;
    }
    failures(&outcome)
}

/// How many variants there are, and of what.
fn in_words(sweep: &Sweep, shard: Option<Shard>, all: usize, waiting: usize) -> String {
    let keys: Vec<&str> = sweep.variations().iter().map(|variation| variation.key.as_str()).collect();
    let count =
        if waiting == all { counted(all as u64, "variant") } else { format!("{waiting} of {all} variants left") };
    let part = shard.map_or_else(String::new, |shard| format!(", shard {shard}"));
    format!("{count} of {}{part}", keys.join(", "))
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
    let is_of_scene = |error: &RunError| matches!(error, RunError::Unstable { .. } | RunError::GaveUp { .. });
    let others = outcome.failures.iter().find(|(_, error)| !is_of_scene(error));
    Err(others.map_or_else(|| Failure::unstable(&text), |(_, error)| Failure::of_run(error, &text)))
}
