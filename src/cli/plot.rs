//! `mesoscope plot`: draw a run or a study again.

use std::path::PathBuf;

use mesoscope::output::{RunDirectory, files};
use mesoscope::stability::{self, StabilitySummary};
use mesoscope::study::redraw;
use mesoscope::sweep::{self, SweepSummary};
use mesoscope::tradeoff::{self, TradeoffSummary};
use mesoscope::{printable, run};

use super::{AdapterArgument, Failure, guidance, heading, print};

/// Draw the plots of a run, or of a sweep, a tradeoff or a map of stability, again from the files it left
///
/// Numbered snapshots stay as they are: the run alone knew those states.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope plot dpd-fluid
  mesoscope plot dpd-fluid --set output.plot.theme=dark --set output.plot.width=800")]
pub struct Arguments {
    /// Directory of the run or of the study
    directory: PathBuf,

    /// Change the look, as in a scene: `output.plot.width=800`, `output.snapshot.color=speed`; may be repeated
    #[arg(long, help_heading = heading::OUTPUT, value_name = "PATH=VALUE")]
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
    guidance::check_directory(&arguments.directory)?;
    let Arguments { directory, set, adapter } = arguments;
    let (choice, has) = (adapter.choice(), |name: &str| directory.join(name).exists());
    let written = if has(files::CHECKPOINT) {
        let directory = RunDirectory::claim(directory)?;
        run::redraw(&directory, &choice, set)?
    } else if has(sweep::files::SUMMARY) {
        redraw::<SweepSummary>(directory, &choice, set)?
    } else if has(tradeoff::files::SUMMARY) {
        redraw::<TradeoffSummary>(directory, &choice, set)?
    } else if has(stability::files::SUMMARY) {
        redraw::<StabilitySummary>(directory, &choice, set)?
    } else {
        let found = RunDirectory::open(directory)?;
        run::redraw(&found, &choice, set)?
    };
    print(&format!("wrote {}/: {}\n", printable::path(directory), written.join(", ")))
}

/// What says when numbered snapshots are taken, which only a run does.
const SCHEDULE: &str = "output.snapshot.every";

/// What of a scene is only about the look.
const LOOK: [&str; 3] = ["output.plot.", "output.snapshot.", "output.fields.ranges."];
