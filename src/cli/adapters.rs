//! `mesoscope adapters`: what this machine can run on.

use super::Failure;

/// List the adapters of this machine, the best first
#[derive(Debug, clap::Args)]
pub struct Arguments {}

/// Lists the adapters.
pub fn execute(_: &Arguments) -> Result<(), Failure> {
    Err(Failure::usage("`adapters` is not available in this build"))
}
