//! `mesoscope report`: one page of runs and studies.

use std::path::PathBuf;

use mesoscope::output::write_atomically;
use mesoscope::{printable, report};

use super::{Failure, heading, print};

/// Make one page of runs and studies, with pictures inside, to send around
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope report dpd-fluid
  mesoscope report first second dpd-fluid-sweep --out thesis.html

The page needs no other file and no script: it opens in every browser, light or dark, and prints. What is missing or damaged in a directory is said in \
its place.")]
pub struct Arguments {
    /// Directories of runs, sweeps, tradeoffs and maps of stability
    #[arg(required = true, value_name = "DIR")]
    directories: Vec<PathBuf>,

    /// The page
    #[arg(long, help_heading = heading::OUTPUT, value_name = "FILE", default_value = "report.html")]
    out: PathBuf,

    /// Replace a page that is there
    #[arg(long, help_heading = heading::OUTPUT)]
    force: bool,
}

/// Writes the page.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let shown = printable::path(&arguments.out);
    if arguments.out.exists() && !arguments.force {
        let message = format!("`{shown}` exists; give another name with --out, or replace it with --force");
        return Err(Failure::input_output(message));
    }
    let page = report::page(&arguments.directories).map_err(|error| Failure::input_output(error.to_string()))?;
    write_atomically(&arguments.out, |writer| writer.write_all(page.as_bytes()))?;
    print(&format!("{shown}: {:.1} MB\n", page.len() as f64 / 1e6))
}
