//! The summary of a run, `run.json`.

use super::{Extent, Found, Id, OutputError, RunDirectory, files, of_one_run, own_file, write_atomically};
use crate::families::{Checked, Column, Model, start_in_words};
use crate::gpu::AdapterDescription;
use crate::measure::statistics::Estimate;
use crate::quantity::Quantity;
use crate::scene::{Change, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// The key of the checksum of everything else.
const CHECKSUM: &str = "checksum";

/// What a run did, on what, and what came out.
///
/// ```
/// use mesoscope::measure::statistics::estimate;
/// use mesoscope::output::Id;
/// use mesoscope::output::summary::{AdapterSummary, Summary};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("run.json");
/// let scene = mesoscope::scene::load("dpd-fluid", &[])?;
/// let mut summary = Summary::new(Id::of_run(&scene), scene.into_scene(), AdapterSummary::default(), 24_000);
/// summary.set_duration(2000, 2000, 12.0);
/// summary.add_mean("temperature", estimate(&[0.75, 1.25]).as_ref());
/// summary.save(&path)?;
/// let found = Summary::load(&path)?;
/// assert_eq!(found.particle_steps_per_second, 4e6);
/// assert_eq!(found.means["temperature"]["value"], 1.0);
/// assert_eq!(found.means["temperature"]["unit"], "energy units");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of the program.
    pub mesoscope_version: String,
    /// The id of the run, which is in its other files too.
    pub run_id: Id,
    /// The adapter the run computed on.
    pub adapter: AdapterSummary,
    /// The ranks that shared the run, if there were several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ranks: Option<RanksSummary>,
    /// What it has from the file that its particles are from, if they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<StartSummary>,
    /// Changes between its steps, of a simulation that is stepped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<Change>,
    /// The stages of the run, if it has some.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<StageSummary>,
    /// Number of particles.
    pub particles: u64,
    /// What the particles of a file or of molecules are, and what acts on which of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub composition: Vec<String>,
    /// Step of the last state.
    pub steps: u64,
    /// Wall-clock time of the steps, in seconds.
    pub wall_seconds: f64,
    /// Particles times steps over wall-clock time.
    pub particle_steps_per_second: f64,
    /// The columns of every table but their first, which counts steps in that of energies; and what arrays of fields hold.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub columns: BTreeMap<String, Vec<ColumnSummary>>,
    /// The nodes that arrays of fields belong to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSummary>,
    /// Steps and times of numbered pictures and arrays.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub numbered: Vec<NumberedFrame>,
    /// Mean of each column of the table of energies after equilibration, in the order of the table; null where a
    /// column has no values.
    pub means: serde_json::Map<String, serde_json::Value>,
    /// Which of these means include the way to equilibrium, and how to leave it out; null where none was found to, or
    /// where equilibrium is not what the scene is about.
    #[serde(default)]
    pub unequilibrated: Option<Unequilibrated>,
    /// Results of the analyses the scene asks for.
    pub results: serde_json::Map<String, serde_json::Value>,
    /// What is conserved to the last bit.
    pub conserved_exactly: Vec<String>,
    /// What the scheme does not conserve.
    pub not_conserved: Vec<String>,
    /// What the user should know before trusting the numbers.
    pub warnings: Vec<String>,
    /// Every table and array, as the run wrote it: these have no place for the id.
    pub tables: BTreeMap<String, Extent>,
    /// All files but the numbered ones, once there are all; null as long as some are missing.
    pub files: Option<Vec<String>>,
    /// The scene with every default filled in.
    pub scene: Scene,
}

/// A stage of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageSummary {
    /// Its first step.
    pub first_step: u64,
    /// The step that it ends with, which is the first of the next stage.
    pub last_step: u64,
    /// The times of both, in time units.
    pub times: [f64; 2],
    /// The numbers that change where it begins, by their paths in the scene.
    pub set: serde_json::Map<String, serde_json::Value>,
    /// Those that go along a line, with their first and last values.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub ramp: serde_json::Map<String, serde_json::Value>,
    /// The largest force of a bond in the stage, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub push_off: Option<f64>,
    /// Mean of each column of the table of energies over its rows; null where a column has no values. Those of the last stage are the
    /// means of the run.
    pub means: serde_json::Map<String, serde_json::Value>,
    /// The directory in that of the run with what analyses of the stage have left; those of the last stage are in that of the run itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub directory: Option<String>,
    /// Results of these analyses.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub results: serde_json::Map<String, serde_json::Value>,
}

/// A numbered picture, or the numbered arrays of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NumberedFrame {
    /// Its number.
    pub number: u64,
    /// Its step.
    pub step: u64,
    /// Its time, in time units.
    pub time: f64,
}

/// The nodes of a periodic mesh: node (k, l) is at `k * spacing[0]`, `l * spacing[1]`, and its value at place `[k, l]` of an array.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeshSummary {
    /// Nodes along x and y.
    pub nodes: [usize; 2],
    /// Their distances along x and y, in length units.
    pub spacing: [f64; 2],
}

impl MeshSummary {
    /// The nodes of a box with edges of these lengths.
    pub(crate) fn new(nodes: [usize; 2], lengths: [f64; 2]) -> Self {
        Self { nodes, spacing: std::array::from_fn(|axis| lengths[axis] / nodes[axis] as f64) }
    }
}

/// A column of a table, in words.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ColumnSummary {
    /// Its name.
    pub name: String,
    /// The symbol of its quantity, which a component shares with the others.
    pub symbol: String,
    /// Its unit.
    pub unit: String,
    /// The definition of its quantity.
    pub meaning: String,
    /// The species that it is of, in the order of the numbers in its name; nothing where it is of all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub species: Vec<String>,
}

impl ColumnSummary {
    /// A column of a quantity in a box of this dimension.
    pub(crate) fn new(name: &str, quantity: &Quantity, dimension: usize) -> Self {
        let Quantity { symbol, unit, meaning, .. } = quantity;
        let error = if name.ends_with("_error") { "standard error of: " } else { "" };
        let (unit, meaning) = (unit.in_words(Some(dimension)).to_owned(), format!("{error}{meaning}"));
        Self { name: name.to_owned(), symbol: (*symbol).to_owned(), unit, meaning, species: Vec::new() }
    }

    /// The columns of the table of energies of a model.
    pub(crate) fn of_energies(model: &Model) -> Vec<Self> {
        let columns = model.physics().columns(model).into_iter();
        let summary =
            |column: Column| Some(Self::new(column.name, Quantity::of_column(column.name)?, model.units.dimension));
        columns.filter_map(summary).collect()
    }
}

/// What a run has from the file that its particles are from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StartSummary {
    /// In words, with what its steps and times are counted from.
    pub what: String,
    /// Steps of earlier runs that it goes on with, to the last bit; zero where it begins anew.
    pub steps_before: u64,
    /// Seed of its noise.
    pub noise_seed: u64,
    /// Changes between the steps of the simulation that left the file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<Change>,
}

impl StartSummary {
    /// That of a scene and its model, if its particles are from a file.
    pub(crate) fn new(scene: &Checked) -> Option<Self> {
        let model = scene.model();
        let what = start_in_words(scene)?;
        let changes = scene.start().map(|start| start.changes.clone()).unwrap_or_default();
        Some(Self { what, steps_before: model.steps_before, noise_seed: model.seed, changes })
    }
}

/// Means that include the way to equilibrium.
///
/// ```
/// use mesoscope::output::summary::{Unequilibrated, UnsettledMean};
///
/// let mean = UnsettledMean { quantity: "temperature".to_owned(), settled_from: Some(80), mean_from_there: 1.003 };
/// let found = Unequilibrated { means: vec![mean], equilibration: 80, steps: None };
/// assert_eq!(found.arguments(), "--set time.equilibration=80");
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unequilibrated {
    /// The means.
    pub means: Vec<UnsettledMean>,
    /// The number of steps of equilibration to try.
    pub equilibration: u64,
    /// The number of steps to try, where this run was too short to settle.
    pub steps: Option<u64>,
}

/// A mean that includes the way to equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnsettledMean {
    /// The column of the table of energies.
    pub quantity: String,
    /// The step from which on it is steady; none where it is not so in the second half of the run either.
    pub settled_from: Option<u64>,
    /// The mean from there on, or of the second half.
    pub mean_from_there: f64,
}

impl Unequilibrated {
    /// What to add to the command line.
    #[must_use]
    pub fn arguments(&self) -> String {
        let steps = self.steps.map_or_else(String::new, |steps| format!(" --steps {steps}"));
        format!("--set time.equilibration={}{steps}", self.equilibration)
    }

    /// Those of two runs, with what does for both.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.means.extend(other.means);
        let (equilibration, steps) = (self.equilibration.max(other.equilibration), self.steps.max(other.steps));
        Self { equilibration, steps, ..self }
    }

    /// Whether the mean of a column is among them.
    #[must_use]
    pub fn includes(&self, column: &str) -> bool {
        self.means.iter().any(|mean| mean.quantity == column)
    }
}

impl fmt::Display for Unequilibrated {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named: Vec<String> = self.means.iter().take(3).map(|mean| format!("`{}`", mean.quantity)).collect();
        let more = self.means.len() - named.len();
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let [verb, noun] = if self.means.len() == 1 { ["includes", "mean"] } else { ["include", "means"] };
        let (named, arguments) = (named.join(", "), self.arguments());
        write!(formatter, "the {noun} of {named}{more} {verb} the way to equilibrium")?;
        if self.steps.is_some() {
            write!(formatter, ", which this run did not reach: run longer, as with `{arguments}`")
        } else {
            write!(formatter, ": leave it out with `{arguments}`")
        }
    }
}

/// The ranks that shared a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RanksSummary {
    /// Parts of the box on each axis.
    pub parts: [u32; 3],
    /// How far around its part a rank knew the particles.
    pub halo: f64,
    /// Whether all ranks computed the same from the same state.
    #[serde(default)]
    pub alike: bool,
    /// Time that the slowest rank computed a step, over the mean of all: what an even load would save.
    #[serde(default)]
    pub slowest_over_mean: f64,
    /// Each rank.
    pub ranks: Vec<RankSummary>,
}

/// One of the ranks that shared a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RankSummary {
    /// The machine it was on.
    #[serde(default)]
    pub host: String,
    /// A checksum of what it computed from a state that all ranks knew: ranks that round alike have the same.
    #[serde(default)]
    pub arithmetic: String,
    /// The adapter it computed on.
    pub adapter: String,
    /// Particles of other ranks that it got at the end of a step, on average.
    pub copies: f64,
    /// Bytes that it sent at the end of a step, on average.
    pub bytes_per_step: f64,
    /// Seconds a step that it waited for its device, on average, and for the copies from it to the host.
    #[serde(default)]
    pub seconds_computing: f64,
    /// Seconds a step that the exchange took but for these copies, on average: waiting for other ranks, and what the host did before and
    /// after. The device may have computed meanwhile.
    #[serde(default)]
    pub seconds_exchanging: f64,
    /// Seconds a step that it waited for other ranks, on average.
    pub seconds_waiting: f64,
}

/// The adapter a run computed on.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct AdapterSummary {
    /// Its name.
    pub name: String,
    /// Its driver, with the version.
    pub driver: String,
    /// The graphics interface it was reached through.
    pub backend: String,
}

impl From<&AdapterDescription> for AdapterSummary {
    fn from(adapter: &AdapterDescription) -> Self {
        let AdapterDescription { name, driver, backend, .. } = adapter.clone();
        Self { name, driver, backend }
    }
}

impl Summary {
    /// A summary of a run that has not measured anything yet.
    #[must_use]
    pub fn new(run_id: Id, scene: Scene, adapter: AdapterSummary, particles: u64) -> Self {
        Self {
            mesoscope_version: env!("CARGO_PKG_VERSION").to_owned(),
            run_id,
            adapter,
            ranks: None,
            start: None,
            changes: Vec::new(),
            stages: Vec::new(),
            particles,
            composition: Vec::new(),
            steps: 0,
            wall_seconds: 0.0,
            particle_steps_per_second: 0.0,
            columns: BTreeMap::new(),
            mesh: None,
            numbered: Vec::new(),
            means: serde_json::Map::new(),
            unequilibrated: None,
            results: serde_json::Map::new(),
            conserved_exactly: Vec::new(),
            not_conserved: Vec::new(),
            warnings: Vec::new(),
            tables: BTreeMap::new(),
            files: None,
            scene,
        }
    }

    /// Sets the duration: `steps` steps of this process, which ended at step `last_step`, in `wall_seconds`.
    pub fn set_duration(&mut self, last_step: u64, steps: u64, wall_seconds: f64) {
        self.steps = last_step;
        self.wall_seconds = wall_seconds;
        let rate = self.particles as f64 * steps as f64 / wall_seconds;
        self.particle_steps_per_second = if rate.is_finite() { rate } else { 0.0 };
    }

    /// Whether everything that the run was to leave in its directory is there, and its tables are those that it wrote.
    pub(crate) fn is_complete(&self, directory: &RunDirectory) -> bool {
        let written = |name: &String| directory.file(name).is_file();
        self.files.as_ref().is_some_and(|files| files.iter().all(written)) && self.check_tables(directory).is_ok()
    }

    /// Looks whether the tables in a directory are those that the run wrote.
    ///
    /// # Errors
    /// [`OutputError::Altered`] names the first that is not, [`OutputError::Continued`] means that the run went on and was
    /// killed, [`OutputError::Io`] names the first that cannot be read.
    pub(crate) fn check_tables(&self, directory: &RunDirectory) -> Result<(), OutputError> {
        self.tables.keys().try_for_each(|name| self.check_table(directory, name))
    }

    /// Looks whether one table in a directory is the one that the run wrote.
    ///
    /// # Errors
    /// As [`check_tables`](Self::check_tables).
    pub(crate) fn check_table(&self, directory: &RunDirectory, name: &str) -> Result<(), OutputError> {
        let path = directory.file(name);
        // Who edits a summary may name any file in it.
        let extent = self.tables.get(name).filter(|_| files::is_of_a_run(name));
        let Some(extent) = extent else { return Err(OutputError::Altered { path }) };
        // Arrays may have been moved elsewhere.
        if files::is_array(name) && !path.exists() {
            return Ok(());
        }
        match extent.find_in(&path)? {
            Found::Whole => Ok(()),
            Found::AtTheBeginning => {
                let (directory, finished) = (directory.path().to_path_buf(), self.steps);
                Err(OutputError::Continued { directory, finished })
            }
            Found::Nowhere => Err(OutputError::Altered { path }),
        }
    }

    /// Looks whether this is the summary of a run of this id and scene, however many steps it has.
    ///
    /// # Errors
    /// [`OutputError::OtherRun`] or [`OutputError::OtherScene`], with the path of the summary.
    pub(crate) fn check_run(&self, run_id: Id, scene: &Scene, path: &Path) -> Result<(), OutputError> {
        run_id.check(path, Some(self.run_id), files::CHECKPOINT)?;
        if of_one_run(&self.scene, scene) { Ok(()) } else { Err(OutputError::OtherScene { path: path.to_path_buf() }) }
    }

    /// Adds the mean of a column; `None` where the column has no values.
    pub fn add_mean(&mut self, column: &str, estimate: Option<&Estimate>) {
        let value = self.mean_with_unit(column, estimate);
        self.means.insert(column.to_owned(), value);
    }

    /// A mean as the summary writes it.
    pub(crate) fn mean_with_unit(&self, column: &str, estimate: Option<&Estimate>) -> serde_json::Value {
        // Plain numbers and nothing else: this conversion cannot fail.
        let mut value = serde_json::to_value(estimate).unwrap_or_default();
        if let (Some(number), Some(quantity)) = (value.as_object_mut(), Quantity::of_column(column)) {
            let unit = quantity.unit.in_words(Some(self.scene.space.lengths.len()));
            number.insert("unit".to_owned(), unit.into());
        }
        value
    }

    /// Writes the summary as JSON for people, keys in the order of the fields.
    ///
    /// # Errors
    /// [`OutputError::Json`] or [`OutputError::Io`] when it cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), OutputError> {
        let text = || {
            let mut content = serde_json::to_value(self)?;
            content[CHECKSUM] = own_file::checksum_of([&content]).into();
            serde_json::to_string_pretty(&content)
        };
        let text = text().map_err(|source| OutputError::Json { path: path.to_path_buf(), source })?;
        write_atomically(path, |writer| writeln!(writer, "{text}"))
    }

    /// Reads the summary of an earlier run.
    ///
    /// # Errors
    /// [`OutputError::Unfinished`] when there is none, [`OutputError::Io`] when it cannot be read, [`OutputError::Line`] where it is not a
    /// summary, [`OutputError::Edited`] where it is not what a run wrote.
    pub fn load(path: &Path) -> Result<Self, OutputError> {
        let summary = own_file::json(path).map_err(|error| match error {
            OutputError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                OutputError::Unfinished {
                    path: path.to_path_buf(),
                    advice: if path.with_file_name(files::CHECKPOINT).exists() {
                        "no run has been finished there; `mesoscope resume` continues from the last checkpoint"
                    } else if path.with_file_name(files::ENERGIES).exists() {
                        "the run there ended before it saved its first checkpoint; run the scene again with --force"
                    } else {
                        "there is no run in this directory"
                    },
                }
            }
            error => error,
        })?;
        let mut content: serde_json::Map<_, _> = own_file::json(path)?;
        // Earlier versions of the program noted none.
        let noted = content.shift_remove(CHECKSUM);
        if noted.is_none_or(|noted| noted == own_file::checksum_of([&content.into()])) {
            Ok(summary)
        } else {
            Err(OutputError::Edited { path: path.to_path_buf() })
        }
    }
}
