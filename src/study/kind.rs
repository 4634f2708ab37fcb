//! The kinds of studies: their words and their files.

use crate::printable;
use std::path::Path;

/// What a kind of study is called, and what belongs to it.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Its command.
    pub command: &'static str,
    /// What messages call one of them.
    pub noun: &'static str,
    /// The name of its summary.
    pub summary: &'static str,
    /// How to replace one: `run the sweep again`.
    pub again: &'static str,
    /// What resuming one does: `finishes the sweep`.
    pub resumed: &'static str,
    /// What makes one shorter: `--budget to shorten them`.
    pub shortened: &'static str,
    /// What stands before the time that its runs are expected to take: `about`, or `at most` where runs may end early.
    pub estimate: &'static str,
    /// Keys of its summary that say what was asked for; a checksum of their values is kept.
    pub(super) asked: &'static [&'static str],
    /// Names of its other files, but for the pictures of quantities.
    files: &'static [&'static str],
    /// Whether it has a picture for every quantity.
    has_plots: bool,
    /// Keys of its summary with lists of the runs that have directories, each with a name.
    pub(super) runs: &'static [&'static str],
}

/// Sweeps.
pub(crate) const SWEEP: Kind = Kind {
    command: "sweep",
    noun: "sweep",
    summary: "sweep.json",
    again: "run the sweep again",
    resumed: "finishes the sweep",
    shortened: "shorten them with --steps",
    estimate: "about",
    asked: &["scene", "vary", "also", "set", "steps", "state_files", "base"],
    files: &["sweep.csv", "sweep-averages.csv"],
    has_plots: true,
    runs: &["variants"],
};

/// Tradeoffs.
pub(crate) const TRADEOFF: Kind = Kind {
    command: "tradeoff",
    noun: "tradeoff",
    summary: "tradeoff.json",
    again: "run the tradeoff again",
    resumed: "goes on",
    shortened: "shorten them with --budget or --steps",
    estimate: "about",
    asked: &["arguments"],
    files: &["tradeoff.csv", "tradeoff.md"],
    has_plots: true,
    runs: &["choices", "finer", "further_seeds"],
};

/// Maps of stability.
pub(crate) const STABILITY: Kind = Kind {
    command: "stability",
    noun: "map of stability",
    summary: "stability.json",
    again: "make the map again",
    resumed: "goes on",
    shortened: "shorten them with --steps N or a narrower range",
    // A run ends when its verdict is certain.
    estimate: "at most",
    asked: &["arguments"],
    files: &["stability.csv", "stability.md", "stability.png", "stability.svg", "stability.pdf"],
    has_plots: false,
    runs: &[],
};

/// All kinds.
pub(super) const KINDS: [&Kind; 3] = [&SWEEP, &TRADEOFF, &STABILITY];

impl Kind {
    /// The kind of the study in a directory; none where there is none.
    #[must_use]
    pub fn of(directory: &Path) -> Option<&'static Self> {
        KINDS.into_iter().find(|kind| directory.join(kind.summary).exists())
    }

    /// What goes on with one of them in a directory.
    #[must_use]
    pub fn resuming(&self, directory: &Path) -> String {
        format!("`mesoscope {} --resume {}`", self.command, printable::path(directory))
    }

    /// Whether its runs have directories of their own.
    #[must_use]
    pub fn has_runs(&self) -> bool {
        !self.runs.is_empty()
    }

    /// Whether it may have written a file of this name.
    pub(crate) fn has_file(&self, name: &str) -> bool {
        name == self.summary || self.files.contains(&name) || self.has_plots && self.is_plot(name)
    }

    /// The name of the picture of a quantity.
    pub(crate) fn plot(&self, quantity: &str) -> String {
        format!("{}-{quantity}.png", self.command)
    }

    fn is_plot(&self, name: &str) -> bool {
        let rest = name.strip_prefix(self.command).and_then(|rest| rest.strip_prefix('-'));
        let quantity = rest.and_then(|rest| [".png", ".svg", ".pdf"].iter().find_map(|end| rest.strip_suffix(end)));
        quantity.is_some_and(|quantity| !quantity.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_of_the_kind_that_begins_its_name() {
        for name in [
            "sweep.json",
            "sweep.csv",
            "sweep-averages.csv",
            "sweep-x.png",
            "tradeoff.json",
            "tradeoff.csv",
            "tradeoff.md",
            "tradeoff-pressure.png",
            "stability.json",
            "stability.csv",
            "stability.md",
            "stability.png",
        ] {
            let kinds: Vec<&str> = KINDS.iter().filter(|kind| kind.has_file(name)).map(|kind| kind.command).collect();
            assert!(kinds.len() == 1 && name.starts_with(kinds[0]), "{name}: {kinds:?}");
        }
        for name in ["sweep-.png", "stability-x.png", "tradeoff.json.bak", "energies.csv", "notes.md"] {
            assert!(KINDS.iter().all(|kind| !kind.has_file(name)), "{name}");
        }
    }
}
