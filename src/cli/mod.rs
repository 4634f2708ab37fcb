//! The command line: one file or folder per command.

mod adapter_argument;
mod adapters;
mod check;
mod event_lines;
mod export;
mod failure;
mod guidance;
mod heading;
mod interruption;
mod launcher;
mod page;
mod plot;
mod print;
mod processes;
mod progress;
mod ranks_argument;
mod report;
mod resume;
mod run;
mod run_arguments;
mod scene_arguments;
mod scenes;
mod schema;
mod shell;
mod stability;
mod study_arguments;
mod study_report;
mod sweep;
mod sweep_report;
mod table;
mod tradeoff;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use mesoscope::gpu::driver_environment;

pub use adapter_argument::AdapterArgument;
pub use failure::Failure;
pub use print::{line, print, print_exactly};
pub use ranks_argument::RanksArgument;
pub use run_arguments::RunArguments;
pub use scene_arguments::{SceneArguments, whole_number};
pub use study_arguments::{ComparisonArguments, StudyArguments, VariantArguments};

/// Stochastic mesoscale particle simulations on any GPU.
#[derive(Debug, Parser)]
#[command(
    name = "mesoscope",
    version,
    arg_required_else_help = true,
    after_help = "\
Examples:
  mesoscope run dpd-fluid                     simulate the standard DPD fluid on the best adapter
  mesoscope run my-scene.json --out results   simulate a scene of your own
  mesoscope sweep dpd-fluid --vary seed=1,2   compare variants of a scene
  mesoscope tradeoff dpd-fluid --vary time.step=0.02,0.04   what accuracy costs, and what to choose
  mesoscope stability dpd-fluid               how far its time step can go
  mesoscope check my-scene.json               find all its mistakes, see what it costs
  mesoscope report dpd-fluid                  one page of a run, to send around
  mesoscope scenes dpd-fluid > my-scene.json  start a scene from a built-in one

Exit codes: 2 wrong command line or scene, 3 no usable adapter, 4 unstable run, 5 input or output, 130 interrupted."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Check(check::Arguments),
    Resume(resume::Arguments),
    Sweep(sweep::Arguments),
    Tradeoff(tradeoff::Arguments),
    Stability(stability::Arguments),
    Plot(plot::Arguments),
    Report(page::Arguments),
    Export(export::Arguments),
    Scenes(scenes::Arguments),
    Schema(schema::Arguments),
    Adapters(adapters::Arguments),
    Completions(shell::CompletionsArguments),
    Man(shell::ManArguments),
}

impl Command {
    /// Refuses to be one of several copies, unless these write nothing or know of each other.
    fn check_alone(&self) -> Result<(), Failure> {
        match self {
            Self::Sweep(arguments) if arguments.shard.is_some() => Ok(()),
            Self::Run(arguments) if cfg!(feature = "mpi") && arguments.seeds.is_none() => Ok(()),
            Self::Resume(_) if cfg!(feature = "mpi") => Ok(()),
            Self::Check(_) | Self::Adapters(_) => Ok(()),
            _ if !self.computes() => Ok(()),
            _ => launcher::refuse_copies(),
        }
    }

    /// True if it opens an adapter.
    fn computes(&self) -> bool {
        !matches!(
            self,
            Self::Report(_) | Self::Export(_) | Self::Scenes(_) | Self::Schema(_) | Self::Completions(_) | Self::Man(_)
        )
    }

    fn execute(&self) -> Result<(), Failure> {
        self.check_alone()?;
        if self.computes() {
            start_again_with(driver_environment(launcher::local_copies()));
        }
        match self {
            Self::Run(arguments) => run::execute(arguments),
            Self::Check(arguments) => check::execute(arguments),
            Self::Resume(arguments) => resume::execute(arguments),
            Self::Sweep(arguments) => sweep::execute(arguments),
            Self::Tradeoff(arguments) => tradeoff::execute(arguments),
            Self::Stability(arguments) => stability::execute(arguments),
            Self::Plot(arguments) => plot::execute(arguments),
            Self::Report(arguments) => page::execute(arguments),
            Self::Export(arguments) => export::execute(arguments),
            Self::Scenes(arguments) => scenes::execute(arguments),
            Self::Schema(arguments) => schema::execute(arguments),
            Self::Adapters(arguments) => adapters::execute(arguments),
            Self::Completions(arguments) => shell::completions(arguments),
            Self::Man(arguments) => shell::man(arguments),
        }
    }
}

/// Reads the command line, executes the command and turns a failure into a message and an exit code.
pub fn main() -> ExitCode {
    let Err(failure) = Arguments::parse().command.execute() else { return ExitCode::SUCCESS };
    line(&format!("{}{failure}", failure.prefix()));
    ExitCode::from(failure.exit_code())
}

/// Starts the program again with environment variables that drivers read when they load, before there are threads.
fn start_again_with(missing: Vec<(&'static str, String)>) {
    #[cfg(unix)]
    if let (false, Ok(program)) = (missing.is_empty(), std::env::current_exe()) {
        use std::os::unix::process::CommandExt as _;
        // On success this does not return; otherwise a slower or noisier driver is no reason to fail.
        let _ = std::process::Command::new(program).args(std::env::args_os().skip(1)).envs(missing).exec();
    }
    #[cfg(not(unix))]
    drop(missing);
}
