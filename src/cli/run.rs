//! `mesoscope run`: simulate a scene.

use std::path::PathBuf;

use super::{Failure, SceneArguments};

/// Simulate a scene and write energies, plots and snapshots
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope run dpd-fluid
  mesoscope run my-scene.json --out results --steps 10000
  mesoscope run dpd-fluid --set time.step=0.02 --set integrator.type=groot-warren
  mesoscope run dpd-fluid --adapter software")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Directory for everything the run writes [default: the scene's name in the working directory]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Adapter to use: its number or part of its name (see `mesoscope adapters`), or `software` for the CPU
    /// [default: the best one]
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,

    /// Overwrite the results of an earlier run in the directory
    #[arg(long)]
    force: bool,

    /// Report errors only
    #[arg(long)]
    quiet: bool,
}

/// Simulates the scene.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    arguments.scene.load()?;
    Err(Failure::usage("the scene is correct, but `run` is not available in this build"))
}
