//! The summary of a sweep, `sweep.json`.

use super::averages::{SeedAverage, averages};
use super::error::SweepError;
use super::expansion::Sweep;
use super::files;
use super::look::Look;
use super::variant::{VariantState, VariantSummary};
use super::variation::{Setting, Variation};
use crate::output::summary::AdapterSummary;
use crate::output::{OutputError, write_atomically};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::path::Path;

/// What was varied, on what, and what came out of every variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepSummary {
    /// Version of the program.
    pub mesoscope_version: String,
    /// File or built-in name of the scene.
    pub scene: String,
    /// The adapter the sweep last computed on; none before it began.
    pub adapter: Option<AdapterSummary>,
    /// Keys that are varied, with their values.
    pub vary: Vec<Variation>,
    /// Variants beside their combinations.
    pub also: Vec<Vec<Setting>>,
    /// Overrides of the scene that apply to all variants.
    pub set: Vec<String>,
    /// The number of steps of all variants that do not set it, if it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// What the plots show.
    pub plots: Look,
    /// The variants, in order.
    pub variants: Vec<VariantSummary>,
    /// Means over the seed, where it is among the keys and several are finished.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub averages: Vec<SeedAverage>,
    /// The scene as it was written, before all of this.
    pub base: Value,
}

impl SweepSummary {
    /// The summary of a sweep before anything has run.
    pub(super) fn new(sweep: &Sweep, look: Look) -> Self {
        let waiting = |variant: &super::Variant| VariantSummary {
            name: variant.name.clone(),
            label: variant.label.clone(),
            settings: variant.settings.clone(),
            state: VariantState::Waiting,
            failure: None,
            particles: 0,
            steps: 0,
            wall_seconds: 0.0,
            particle_steps_per_second: 0.0,
            means: Map::new(),
            results: Map::new(),
            unequilibrated: None,
            warnings: Vec::new(),
        };
        Self {
            mesoscope_version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: sweep.scene.clone(),
            adapter: None,
            vary: sweep.vary.clone(),
            also: sweep.also.clone(),
            set: sweep.set.clone(),
            steps: sweep.steps,
            plots: look,
            variants: sweep.variants().iter().map(waiting).collect(),
            averages: Vec::new(),
            base: sweep.base.clone(),
        }
    }

    /// Takes the means over the seed anew.
    pub(super) fn average(&mut self) {
        self.averages = averages(&self.variants);
    }

    /// Writes the summary into the directory of the sweep.
    pub(super) fn save(&self, directory: &Path) -> Result<(), OutputError> {
        let path = directory.join(files::SUMMARY);
        let text =
            serde_json::to_string_pretty(self).map_err(|source| OutputError::Json { path: path.clone(), source })?;
        write_atomically(&path, |writer| writeln!(writer, "{text}"))
    }

    /// Reads the summary in the directory of a sweep.
    ///
    /// # Errors
    /// [`SweepError::NoSweep`] when there is none, [`SweepError::Output`] when it cannot be read or is no summary.
    pub fn load(directory: &Path) -> Result<Self, SweepError> {
        let path = directory.join(files::SUMMARY);
        let text = match std::fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(SweepError::NoSweep { path: directory.to_path_buf() });
            }
            read => read.map_err(|source| OutputError::Io { attempted: "read", path: path.clone(), source })?,
        };
        serde_json::from_slice(&text).map_err(|error| {
            let problem = format!("this is no summary of a sweep ({error}); run the sweep again with --force");
            let line = error.line() as u64;
            SweepError::Output(OutputError::Line { path, line, problem })
        })
    }

    /// The sweep that this is the summary of.
    pub(super) fn sweep(&self) -> Result<Sweep, SweepError> {
        let (scene, base, set) = (self.scene.clone(), self.base.clone(), self.set.clone());
        Sweep::again(scene, base, (set, self.steps), self.vary.clone(), self.also.clone())
    }
}
