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
    /// Whether a certain adapter is asked for.
    pub fn is_named(&self) -> bool {
        self.adapter.is_some()
    }

    /// What was asked for.
    pub fn choice(&self) -> AdapterChoice {
        AdapterChoice::parse(self.adapter.as_deref())
    }
}
