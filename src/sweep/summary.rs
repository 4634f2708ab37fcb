//! The summary of a sweep, `sweep.json`.

use super::averages::{SeedAverage, averages};
use super::error::SweepError;
use super::expansion::Sweep;
use super::files;
use super::look::Look;
use super::variant::{VariantState, VariantSummary};
use super::variation::{Setting, Variation};
use crate::output::summary::AdapterSummary;
use crate::output::{Id, OutputError, write_atomically};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::path::Path;

/// What was varied, on what, and what came out of every variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepSummary {
    /// Version of the program.
    pub mesoscope_version: String,
    /// The id of the sweep, made of those of its runs.
    pub sweep_id: Id,
    /// File or built-in name of the scene.
    pub scene: String,
    /// The adapter the sweep last computed on; none before it began.
    pub adapter: Option<AdapterSummary>,
    /// Keys that are varied, with their values.
    pub vary: Vec<Variation>,
    /// Variants in addition to their combinations.
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
            run_id: Id::of_run(&variant.scene),
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
        let variants: Vec<VariantSummary> = sweep.variants().iter().map(waiting).collect();
        Self {
            mesoscope_version: env!("CARGO_PKG_VERSION").to_owned(),
            sweep_id: Id::of_sweep(variants.iter().map(|variant| variant.run_id)),
            scene: sweep.scene.clone(),
            adapter: None,
            vary: sweep.vary.clone(),
            also: sweep.also.clone(),
            set: sweep.set.clone(),
            steps: sweep.steps,
            plots: look,
            variants,
            averages: Vec::new(),
            base: sweep.base.clone(),
        }
    }

    /// Takes the means over the seed of all variants that are finished.
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

    /// The sweep that this is the summary of, if the ids of its runs are those in the summary.
    ///
    /// # Errors
    /// [`SweepError::Changed`], and what [`Sweep::load`] gives rise to.
    pub(super) fn sweep(&self, directory: &Path) -> Result<Sweep, SweepError> {
        let (scene, base, set) = (self.scene.clone(), self.base.clone(), self.set.clone());
        let sweep = Sweep::again(scene, base, (set, self.steps), self.vary.clone(), self.also.clone())?;
        let ids = |summary: &Self| summary.variants.iter().map(|variant| variant.run_id).collect::<Vec<_>>();
        let expected = Self::new(&sweep, self.plots.clone());
        // Another version may have keys in its scenes that change the ids.
        let same_version = self.mesoscope_version == expected.mesoscope_version;
        let same_names = self.variants.iter().map(|v| &v.name).eq(expected.variants.iter().map(|v| &v.name));
        let same_ids = !same_version || ids(self) == ids(&expected);
        if same_names && same_ids && self.sweep_id == Id::of_sweep(ids(self)) {
            return Ok(sweep);
        }
        Err(SweepError::Changed { path: directory.join(files::SUMMARY) })
    }

    /// The summary of the same sweep before any of its variants was run.
    pub(super) fn begun_again(self, sweep: &Sweep, look: Look) -> Self {
        let mut new = Self::new(sweep, look);
        (new.sweep_id, new.adapter) = (self.sweep_id, self.adapter);
        for (variant, earlier) in new.variants.iter_mut().zip(&self.variants) {
            variant.run_id = earlier.run_id;
        }
        new
    }
}
