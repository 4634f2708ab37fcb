//! `mesoscope adapters`: what this machine can run on.

use mesoscope::gpu::{AdapterDescription, GpuError, list_adapters};

use super::table::aligned;
use super::{Failure, print};

/// List the adapters of this machine, the best first
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope adapters
  mesoscope run dpd-fluid --adapter 1      by number
  mesoscope run dpd-fluid --adapter nvidia by part of the name")]
pub struct Arguments {}

/// Lists the adapters.
pub fn execute(_: &Arguments) -> Result<(), Failure> {
    let adapters = list_adapters();
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter.into());
    }
    let header = ["", "NAME", "KIND", "BACKEND", "DRIVER"].map(str::to_owned).to_vec();
    let row = |(number, adapter): (usize, AdapterDescription)| {
        vec![number.to_string(), adapter.name, adapter.kind.to_owned(), adapter.backend, adapter.driver]
    };
    let rows: Vec<Vec<String>> = std::iter::once(header).chain(adapters.into_iter().enumerate().map(row)).collect();
    print(&aligned(&rows, ""))
}
