//! `mesoscope check`: what a scene requires.

use super::{Failure, SceneArguments};

/// Check a scene: all mistakes at once, or else what it requires - kernels, buffers, bytes, expected cost
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope check my-scene.json
  mesoscope check dpd-fluid --set particles.0.number_density=4")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
}

/// Checks the scene.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    arguments.scene.load()?;
    Err(Failure::usage("the scene is correct, but `check` cannot print its plan in this build"))
}
