//! What benchmarks have in common: how they begin and end, and what they time.

// No benchmark takes everything.
#![allow(dead_code)]

pub mod bandwidth;
pub mod machine;
pub mod start_up;
pub mod statistics;
pub mod timed;
pub mod timing;

use std::time::Instant;

use clap::Parser;
use mesoscope::gpu::{AdapterChoice, Gpu, GpuError, Requirements};
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::Checked;

pub type Failure = Box<dyn std::error::Error>;

/// What the command line asks for, after what has to come before everything else.
pub fn settings<S: Parser>() -> S {
    let missing = mesoscope::gpu::driver_environment(1);
    #[cfg(unix)]
    if let (false, Ok(program)) = (missing.is_empty(), std::env::current_exe()) {
        use std::os::unix::process::CommandExt as _;
        // As the program does: drivers read them when they load.
        let _ = std::process::Command::new(program).args(std::env::args_os().skip(1)).envs(missing).exec();
    }
    S::parse()
}

/// The plan of a scene.
pub fn plan_of(scene: &Checked, hardware: Hardware, options: Options) -> Plan {
    run::plan(scene, hardware, options)
}

/// The best adapter, or the one that `MESOSCOPE_ADAPTER` names, with buffers for all of these plans.
pub fn open_for(plans: impl IntoIterator<Item = Result<Plan, Failure>>) -> Result<Gpu, Failure> {
    let mut requirements = Requirements::default();
    for plan in plans {
        let plan = plan?;
        requirements.largest_buffer = requirements.largest_buffer.max(plan.largest_buffer());
        requirements.storage_buffers = requirements.storage_buffers.max(plan.storage_buffers);
    }
    Ok(open(requirements)?)
}

/// The best adapter, or the one that `MESOSCOPE_ADAPTER` names, if it meets the requirements.
pub fn open(requirements: Requirements) -> Result<Gpu, GpuError> {
    let name = std::env::var("MESOSCOPE_ADAPTER").ok();
    Gpu::open(&AdapterChoice::parse(name.as_deref()), requirements)
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
