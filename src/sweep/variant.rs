//! What came out of one variant of a sweep.

use super::files;
use crate::families::Checked;
use crate::output::summary::Unequilibrated;
use crate::output::{Id, Summary};
use crate::study::{self, Setting, Variant};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::fmt;
use std::path::Path;

/// What came out of one variant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VariantSummary {
    /// Name of its directory.
    pub name: String,
    /// The id of its run.
    pub run_id: Id,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, strum::Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum VariantState {
    /// It has not ended yet.
    #[default]
    Waiting,
    /// It reached its last step.
    Finished,
    /// It failed.
    Failed,
}

impl VariantSummary {
    /// Before it has run.
    pub(super) fn before(variant: &Variant) -> Self {
        Self {
            name: variant.name.clone(),
            run_id: Id::of_run(&variant.scene),
            label: variant.label.clone(),
            settings: variant.settings.clone(),
            ..Self::default()
        }
    }

    /// One that is finished and says nothing.
    #[cfg(test)]
    pub(super) fn blank(settings: Vec<Setting>) -> Self {
        Self {
            settings,
            state: VariantState::Finished,
            particles: 8,
            steps: 10,
            wall_seconds: 0.5,
            particle_steps_per_second: 160.0,
            ..Self::default()
        }
    }

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

    /// Takes over what its run in a directory says, if it is finished.
    pub(super) fn record(&mut self, directory: &Path, scene: &Checked) {
        if let Some(run) = study::finished(directory, scene, self.run_id, files::SUMMARY) {
            self.finish(&run);
        }
    }

    /// Notes a failure.
    pub(super) fn fail(&mut self, message: String) {
        self.state = VariantState::Failed;
        self.failure = Some(message);
    }
}

impl fmt::Display for VariantSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.state {
            VariantState::Waiting => formatter.write_str("waiting"),
            VariantState::Finished => write!(formatter, "finished in {:.2} s", self.wall_seconds),
            VariantState::Failed => {
                let failure = self.failure.as_deref().unwrap_or_default();
                write!(formatter, "failed: {}", failure.lines().next().unwrap_or_default())
            }
        }
    }
}
