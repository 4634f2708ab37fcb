//! The argument that names an adapter.

use mesoscope::gpu::AdapterChoice;

/// Which adapter.
#[derive(Debug, clap::Args)]
pub struct AdapterArgument {
    /// Adapter to use: its number or part of its name (see `mesoscope adapters`), or `software` for the CPU
    /// [default: the best one]
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

impl AdapterArgument {
    /// What was asked for.
    pub fn choice(&self) -> AdapterChoice {
        AdapterChoice::parse(self.adapter.as_deref())
    }
}
