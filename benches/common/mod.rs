//! What all benchmarks begin and end with.

pub mod machine;
pub mod statistics;
pub mod timed;

use std::time::Instant;

use mesoscope::gpu::{AdapterChoice, Gpu, GpuError, Requirements};

pub type Failure = Box<dyn std::error::Error>;

/// The best adapter, or the one that `MESOSCOPE_ADAPTER` names, with buffers of this size.
pub fn open(largest_buffer: u64) -> Result<Gpu, GpuError> {
    let name = std::env::var("MESOSCOPE_ADAPTER").ok();
    Gpu::open(&AdapterChoice::parse(name.as_deref()), Requirements { largest_buffer, ..Requirements::default() })
}

/// A report under way.
pub struct Report {
    begun: Instant,
}

impl Report {
    /// Prints the title, the machine, what is measured for comparison, and what else the machine is doing.
    pub fn begin(title: &str, gpu: &Gpu, peer: &str) -> Self {
        println!("## {title}\n");
        println!("{}", machine::describe(gpu.description(), peer));
        others("before");
        Self { begun: Instant::now() }
    }

    /// Prints what else the machine is doing at the end, and how long the benchmark took.
    pub fn end(&self) {
        println!();
        others("after");
        println!("- measured in {:.0} s", self.begun.elapsed().as_secs_f64());
    }
}

/// Says what else the machine is doing.
fn others(when: &str) {
    if let Some(words) = machine::others() {
        println!("- other programs {when} the measurement: {words}");
    }
}
