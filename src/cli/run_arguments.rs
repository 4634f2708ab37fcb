//! Arguments of every command that runs something into a directory.

use super::heading;

/// How to run.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArguments {
    /// Overwrite the results of an earlier run in the directory
    #[arg(long, help_heading = heading::OUTPUT)]
    pub force: bool,

    /// Report errors only
    #[arg(long, help_heading = heading::OUTPUT)]
    pub quiet: bool,
}
