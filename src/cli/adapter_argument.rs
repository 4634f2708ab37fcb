//! The argument that names an adapter.

use mesoscope::gpu::AdapterChoice;

use super::{heading, launcher};

/// Which adapter.
#[derive(Debug, Clone, clap::Args)]
pub struct AdapterArgument {
    /// Adapter to use: its number or part of its name (see `mesoscope adapters`), or `software` for the CPU
    /// [default: the best one]
    #[arg(long, help_heading = heading::RUNNING, value_name = "NAME")]
    adapter: Option<String>,
}

impl AdapterArgument {
    /// The same for one of several copies of the program on a machine: each gets one of those that are as good as the best.
    pub fn choice_of_copy(&self) -> AdapterChoice {
        match (self.choice(), launcher::local_rank()) {
            (AdapterChoice::Best, Some(number)) => AdapterChoice::Share(number),
            (choice, _) => choice,
        }
    }

    /// What was asked for.
    pub fn choice(&self) -> AdapterChoice {
        AdapterChoice::parse(self.adapter.as_deref())
    }
}
