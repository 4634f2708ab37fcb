//! `mesoscope plot`: draw a run or a sweep again.

use std::path::PathBuf;

use mesoscope::output::{RunDirectory, files};
use mesoscope::study::Kind;
use mesoscope::{printable, run, sweep};

use super::{AdapterArgument, Failure, print};

/// Draw the plots of a run, or of a sweep, again from the files it left
///
/// Numbered snapshots stay as they are: the run alone knew those states.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope plot dpd-fluid
  mesoscope plot dpd-fluid --set output.plot.theme=dark --set output.plot.width=800")]
pub struct Arguments {
    /// Directory of the run or of the sweep
    directory: PathBuf,

    /// Change the look, as in a scene: `output.plot.width=800`, `output.snapshot.color=speed`; may be repeated
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,

    #[command(flatten)]
    adapter: AdapterArgument,
}

/// Draws the plots.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let is_look = |change: &&String| {
        let change = change.trim();
        LOOK.iter().any(|prefix| change.starts_with(prefix)) && !change.starts_with(SCHEDULE)
    };
    if let Some(other) = arguments.set.iter().find(|change| !is_look(change)) {
        return Err(Failure::usage(format!(
            "`--set {other}`: a plot can be drawn with another look, {}, but not of another run",
            LOOK.map(|prefix| format!("`{prefix}…`")).join(" or ")
        )));
    }
    let is_run = arguments.directory.join(files::CHECKPOINT).exists();
    if let Some(kind) = Kind::of(&arguments.directory).filter(|kind| !is_run && kind.summary != sweep::files::SUMMARY) {
        let (shown, resuming) = (printable::path(&arguments.directory), kind.resuming(&arguments.directory));
        return Err(Failure::usage(format!("`{shown}` holds a {}: {resuming} draws its pictures again", kind.noun)));
    }
    let choice = arguments.adapter.choice();
    let written = if arguments.directory.join(sweep::files::SUMMARY).exists() {
        sweep::redraw(&arguments.directory, &choice, &arguments.set)?
    } else {
        let directory = RunDirectory::claim(&arguments.directory)?;
        run::redraw(&directory, &choice, &arguments.set)?.into_iter().map(str::to_owned).collect()
    };
    print(&format!(
        "wrote {}/: {}
",
        printable::path(&arguments.directory),
        written.join(", ")
    ))
}

/// What says when numbered snapshots are taken, which only a run does.
const SCHEDULE: &str = "output.snapshot.every";

/// What of a scene is only about the look.
const LOOK: [&str; 3] = ["output.plot.", "output.snapshot.", "output.fields.ranges."];
