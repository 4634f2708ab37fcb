//! The summary of a sweep, `sweep.json`.

use super::averages::SeedAverage;
use super::look::Look;
use super::variant::{VariantState, VariantSummary};
use super::{files, plots, table};
use crate::families::StepCheck;
use crate::output::summary::AdapterSummary;
use crate::output::{Id, RunDirectory};
use crate::scene::{PlotStyle, SceneError, StateFiles, WrittenScene};
use crate::study::{self, Charts, Kind, Record, SWEEP, Setting, StudyError, Sweep, Variation};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::convert::Infallible;
use std::path::Path;

/// What was varied, on what, and what came out of every variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepSummary {
    /// Version of the program that began it.
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
    /// The files that variants start from.
    #[serde(default, skip_serializing_if = "StateFiles::is_empty")]
    pub(super) state_files: StateFiles,
    /// The scene as it was written, before all of this.
    pub base: Value,
}

impl SweepSummary {
    /// Reads the summary in the directory of a sweep.
    ///
    /// # Errors
    /// [`StudyError::Nothing`] when there is none, [`StudyError::Output`] when it cannot be read or is no summary.
    pub fn load(directory: &Path) -> Result<Self, StudyError> {
        study::load(directory)
    }

    /// Numbers of the variants that are not finished.
    pub(super) fn waiting(&self) -> Vec<usize> {
        let variants = self.variants.iter().enumerate();
        variants.filter(|(_, variant)| variant.state != VariantState::Finished).map(|(number, _)| number).collect()
    }

    /// Whether it was asked for in the same way as another one, which this version of the program made, and has its runs.
    pub(super) fn is_of(&self, other: &Self) -> bool {
        let same_keys = self.vary == other.vary && self.also == other.also && self.set == other.set;
        let same_scene = self.steps == other.steps && self.base == other.base;
        // Where no scene has a file, only one that was not read from its own summary knows where files would be.
        let have_none = self.state_files.is_empty() && other.state_files.is_empty();
        let same_files = have_none || self.state_files == other.state_files;
        same_keys && same_scene && same_files && self.has_runs_of(other)
    }

    /// True if it has the runs of another one, which this version of the program made.
    fn has_runs_of(&self, other: &Self) -> bool {
        let same_names = self.variants.iter().map(|v| &v.name).eq(other.variants.iter().map(|v| &v.name));
        let same_ids = !self.is_of_this_version() || self.ids().eq(other.ids());
        same_names && same_ids && self.sweep_id == Id::of_sweep(self.ids())
    }

    fn ids(&self) -> impl Iterator<Item = Id> {
        self.variants.iter().map(|variant| variant.run_id)
    }
}

impl Record for SweepSummary {
    type Request = Sweep;
    type Ended = VariantSummary;
    type Phase = Infallible;

    const KIND: &'static Kind = &SWEEP;

    fn before(sweep: &Sweep) -> Self {
        let variants: Vec<VariantSummary> = sweep.variants().iter().map(VariantSummary::before).collect();
        Self {
            mesoscope_version: env!("CARGO_PKG_VERSION").to_owned(),
            sweep_id: Id::of_sweep(variants.iter().map(|variant| variant.run_id)),
            scene: sweep.scene.name.clone(),
            adapter: None,
            vary: sweep.vary.clone(),
            also: sweep.also.clone(),
            set: sweep.scene.set.clone(),
            steps: sweep.scene.steps,
            plots: Look::default(),
            variants,
            averages: Vec::new(),
            state_files: sweep.files.clone(),
            base: sweep.base.clone(),
        }
    }

    fn request(&self) -> Result<Sweep, StudyError> {
        let (name, text, set) = (self.scene.clone(), self.base.to_string(), self.set.clone());
        let scene = WrittenScene { name, text, set, steps: self.steps };
        Sweep::new(scene, self.vary.clone(), self.also.clone(), self.state_files.clone(), StepCheck::Refuse)
    }

    fn checks(&self, sweep: &Sweep) -> Vec<(bool, &'static str)> {
        vec![(self.has_runs_of(&Self::before(sweep)), "describes other runs than those whose ids are in it")]
    }

    fn version(&self) -> &str {
        &self.mesoscope_version
    }

    fn id(&self) -> Id {
        self.sweep_id
    }

    fn runs(&self) -> Vec<&str> {
        self.variants.iter().map(|variant| variant.name.as_str()).collect()
    }

    /// The summary before any of the variants was run, but for those that are finished.
    fn resumed(self, sweep: &Sweep, directory: &RunDirectory) -> Self {
        let mut new = Self::before(sweep);
        // Its ids are of that version.
        new.mesoscope_version = self.mesoscope_version;
        (new.sweep_id, new.adapter, new.plots) = (self.sweep_id, self.adapter, self.plots);
        for ((entry, earlier), variant) in new.variants.iter_mut().zip(self.variants).zip(sweep.variants()) {
            entry.run_id = earlier.run_id;
            entry.record(&directory.file(&variant.name), &variant.scene);
        }
        new
    }

    fn tables(&self, sweep: &Sweep) -> Vec<(&'static str, String)> {
        let averages = table::averages_text(self, &sweep.keys()).map(|text| (files::AVERAGES, text));
        [(files::TABLE, table::text(self, &sweep.keys()))].into_iter().chain(averages).collect()
    }

    fn charts<'c>(&'c self, sweep: &'c Sweep, directory: &RunDirectory) -> Result<Charts<'c>, StudyError> {
        plots::charts(sweep, self, directory)
    }

    /// That of the first variant.
    fn style(&self, sweep: &Sweep, overrides: &[String]) -> Result<PlotStyle, SceneError> {
        let Some(first) = sweep.variants().first() else { return Ok(PlotStyle::default()) };
        let own: Vec<String> = first.settings.iter().map(Setting::argument).collect();
        study::style(&sweep.scene.clone().with(&own), &first.scene, overrides, &sweep.files, StepCheck::Refuse)
    }

    fn progress(&self) -> String {
        let all = self.variants.len();
        format!(" after {} of {all} variants", all - self.waiting().len())
    }
}
