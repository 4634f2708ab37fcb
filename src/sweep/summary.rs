//! The summary of a sweep, `sweep.json`.

use super::averages::{SeedAverage, averages};
use super::error::SweepError;
use super::expansion::Sweep;
use super::files;
use super::plots::Look;
use super::variation::{Setting, Variation};
use crate::output::summary::{AdapterSummary, Unequilibrated};
use crate::output::{OutputError, Summary, write_atomically};
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

/// What came out of one variant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariantSummary {
    /// Name of its directory.
    pub name: String,
    /// What a legend calls it.
    pub label: String,
    /// What distinguishes it.
    pub settings: Vec<Setting>,
    /// How far it came.
    pub state: VariantState,
    /// Why it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// Number of particles.
    pub particles: u64,
    /// Step of the last state.
    pub steps: u64,
    /// Wall-clock time of the steps, in seconds.
    pub wall_seconds: f64,
    /// Particles times steps over wall-clock time.
    pub particle_steps_per_second: f64,
    /// Means of the table of energies, as in `run.json`.
    pub means: Map<String, Value>,
    /// Results of the analyses, as in `run.json`.
    pub results: Map<String, Value>,
    /// Means that include the way to equilibrium, as in `run.json`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unequilibrated: Option<Unequilibrated>,
    /// What the user should know before trusting the numbers.
    pub warnings: Vec<String>,
}

/// How far a variant came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VariantState {
    /// It has not ended yet.
    Waiting,
    /// It came to its last step.
    Finished,
    /// It failed.
    Failed,
}

impl VariantState {
    /// The word that tables and messages use.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Finished => "finished",
            Self::Failed => "failed",
        }
    }
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

impl VariantSummary {
    /// Takes over what a finished run says.
    pub(super) fn finish(&mut self, run: &Summary) {
        self.state = VariantState::Finished;
        self.failure = None;
        self.particles = run.particles;
        self.steps = run.steps;
        self.wall_seconds = run.wall_seconds;
        self.particle_steps_per_second = run.particle_steps_per_second;
        self.means.clone_from(&run.means);
        self.results.clone_from(&run.results);
        self.unequilibrated.clone_from(&run.unequilibrated);
        self.warnings.clone_from(&run.warnings);
    }

    /// Notes a failure.
    pub(super) fn fail(&mut self, message: String) {
        self.state = VariantState::Failed;
        self.failure = Some(message);
    }
}
