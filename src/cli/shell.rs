//! `mesoscope completions` and `mesoscope man`: the command line for shells and for manuals.

use std::fs;
use std::path::PathBuf;

use clap::CommandFactory as _;
use clap_complete::Shell;
use mesoscope::printable;

use super::{Failure, print_exactly};

/// Print what a shell needs to complete commands, options and names of scenes
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope completions bash > ~/.local/share/bash-completion/completions/mesoscope
  mesoscope completions zsh > ~/.zfunc/_mesoscope
  mesoscope completions fish > ~/.config/fish/completions/mesoscope.fish")]
pub struct CompletionsArguments {
    /// The shell
    shell: Shell,
}

/// Prints completions.
pub fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut super::Arguments::command(), "mesoscope", &mut text);
    print_exactly(&String::from_utf8_lossy(&text))
}

/// Write manual pages of all commands into a directory
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope man ~/.local/share/man/man1   then `man mesoscope-run`")]
pub struct ManArguments {
    /// The directory, which is created
    directory: PathBuf,
}

/// Writes manual pages; those of the same names are replaced.
pub fn man(arguments: &ManArguments) -> Result<(), Failure> {
    let directory = &arguments.directory;
    let written =
        fs::create_dir_all(directory).and_then(|()| clap_mangen::generate_to(super::Arguments::command(), directory));
    written.map_err(|error| {
        let place = printable::path(directory);
        Failure::input_output(format!("cannot write manual pages into `{place}`: {error}; choose another directory"))
    })
}
