//! `mesoscope plot`: draw a run again.

use std::path::PathBuf;

use super::Failure;

/// Draw the plots of a run again from the files it left
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope plot dpd-fluid
  mesoscope plot dpd-fluid --adapter software")]
pub struct Arguments {
    /// Directory of the run
    directory: PathBuf,

    /// Adapter to use: its number or part of its name (see `mesoscope adapters`), or `software` for the CPU
    /// [default: the best one]
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

/// Draws the plots.
pub fn execute(_: &Arguments) -> Result<(), Failure> {
    Err(Failure::usage("`plot` is not available in this build"))
}
