//! `mesoscope run`: simulate a scene.

use std::path::PathBuf;

use mesoscope::printable;
use mesoscope::ranks::Processes;
use mesoscope::run::Run;
use mesoscope::study::Kind;

use super::event_lines::WritingArguments;
use super::report;
use super::{Failure, RanksArgument, RunArguments, SceneArguments, StudyArguments, heading, processes, sweep};

/// Simulate a scene and write energies, plots and snapshots
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope run dpd-fluid
  mesoscope run my-scene.json --out results --steps 10000
  mesoscope run dpd-fluid --steps 200 --seed 7           a short try with other random numbers
  mesoscope run dpd-fluid --set time.step=0.02 --set integrator.type=groot-warren
  mesoscope run dpd-fluid --adapter software
  mesoscope run my-scene.json --ranks auto               on all graphics cards of this machine
  mesoscope run dpd-fluid --seeds 8                      eight independent runs, and their means with errors

Ctrl-C saves a checkpoint and stops; `mesoscope resume` continues from there.")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Directory for everything the run writes [default: the scene's name in the working directory]
    #[arg(long, help_heading = heading::OUTPUT, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Independent runs, with the seed of the scene and those that follow, as `mesoscope sweep --seeds` makes them:
    /// tables and plots of their means, with errors from their scatter
    #[arg(long, help_heading = heading::SEVERAL, value_name = "N", conflicts_with_all = ["ranks", "mixed", "no_pictures", "progress"])]
    pub seeds: Option<u32>,

    #[command(flatten)]
    ranks: RanksArgument,

    #[command(flatten)]
    writing: WritingArguments,

    #[command(flatten)]
    how: RunArguments,
}

impl Arguments {
    /// The directory for everything that is written.
    fn directory(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| report::stem(&self.scene.scene).into())
    }
}

/// Simulates the scene, with all copies of the program that a launcher has started.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, ranks, how, .. } = arguments;
    if let Some(seeds) = arguments.seeds {
        let study = StudyArguments::of_seeds(seeds, scene, arguments.directory(), &ranks.adapter, how);
        return sweep::execute(&sweep::Arguments::of_seeds(scene.seed, study));
    }
    processes::share(&arguments.ranks.adapter, &|processes| simulate(arguments, processes))
}

fn simulate(arguments: &Arguments, processes: Option<&dyn Processes>) -> Result<(), Failure> {
    let scene = arguments.ranks.load(&arguments.scene, processes.map(Processes::count))?;
    let directory = arguments.directory();
    let shown = printable::path(&directory);
    if let Some(kind) = Kind::of(&directory) {
        let message = format!("`{shown}` has a {}: choose another directory with --out", kind.noun);
        return Err(Failure::input_output(message));
    }
    let started = if arguments.how.force { Run::replace(scene, directory) } else { Run::start(scene, directory) };
    let simulation = if arguments.writing.no_pictures { started.without_pictures() } else { started };
    let form = (!arguments.how.quiet).then_some(arguments.writing.progress);
    report::execute(simulation, processes, &arguments.ranks, &shown, form)
}
