//! `mesoscope resume`: continue a run.

use std::path::PathBuf;

use mesoscope::output::files;
use mesoscope::printable;
use mesoscope::ranks::Processes;
use mesoscope::run::Run;
use mesoscope::study::Kind;

use super::event_lines::WritingArguments;
use super::report;
use super::{Failure, RanksArgument, guidance, heading, print, processes, whole_number};

/// Continue a run from its last checkpoint
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope resume dpd-fluid                 finish a run that was interrupted
  mesoscope resume dpd-fluid --steps 50000   continue to step 50000
  mesoscope resume dpd-fluid --steps 60000 --set temperature=0.5
                                             with another temperature, as a new stage")]
pub struct Arguments {
    /// Directory of the run
    directory: PathBuf,

    /// Change a number of the scene from here on, in a new stage of the run; may be repeated
    #[arg(long, help_heading = heading::SCENE, value_name = "PATH=VALUE")]
    set: Vec<String>,

    /// Step at which to stop [default: the number of steps in the scene]
    #[arg(long, help_heading = heading::RUNNING, value_name = "N", value_parser = whole_number, allow_negative_numbers = true)]
    steps: Option<u64>,

    #[command(flatten)]
    ranks: RanksArgument,

    #[command(flatten)]
    writing: WritingArguments,

    /// Report errors only
    #[arg(long, help_heading = heading::OUTPUT)]
    quiet: bool,
}

/// Continues the run, with all copies of the program that a launcher has started.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    processes::share(&arguments.ranks.adapter, &|processes| resume(arguments, processes))
}

fn resume(arguments: &Arguments, processes: Option<&dyn Processes>) -> Result<(), Failure> {
    let shown = printable::path(&arguments.directory);
    guidance::check_directory(&arguments.directory)?;
    let is_run = arguments.directory.join(files::CHECKPOINT).exists();
    if let Some(kind) = Kind::of(&arguments.directory).filter(|_| !is_run) {
        let resuming = kind.resuming(&arguments.directory);
        let own = if kind.has_runs() { ", and a directory in it can be resumed on its own" } else { "" };
        return Err(Failure::usage(format!(
            "`{shown}` holds a {}, not a run: {resuming} {}{own}",
            kind.noun, kind.resumed
        )));
    }
    let resumed = Run::resume(&arguments.directory, arguments.steps)?;
    let resumed = if arguments.set.is_empty() { resumed } else { resumed.in_new_stage(&arguments.set)? };
    if resumed.is_finished() {
        let step = resumed.first_step();
        let state = if step > resumed.scene().time.steps { "has reached" } else { "is finished at" };
        let text =
            format!("nothing to do: the run in {shown} {state} step {step}; `--steps N` continues to a later step\n");
        return if arguments.quiet { Ok(()) } else { print(&text) };
    }
    let simulation = if arguments.writing.no_pictures { resumed.without_pictures() } else { resumed };
    let form = (!arguments.quiet).then_some(arguments.writing.progress);
    report::execute(simulation, processes, &arguments.ranks, &shown, form)
}
