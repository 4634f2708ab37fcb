//! The table of energies of a run: its file, and what a summary says of it.

use super::RunError;
use super::energy_rows::EnergyRows;
use super::sections::{Sections, bytes, samples};
use super::settling;
use crate::families::{Checked, Model};
use crate::measure::Observables;
use crate::output::{EnergiesFile, Extent, OutputError, Summary, own_file, read_table};
use crate::table::Table;
use std::path::Path;

/// Names of the quantities that the table of energies of a model holds.
pub(crate) fn quantities(model: &Model) -> Vec<&'static str> {
    model.physics().columns(model).into_iter().map(|column| column.name).filter(|name| *name != "time").collect()
}

/// Name of the section of a checkpoint that holds the sums behind the configurational temperature.
pub(super) const SECTION: &str = "configuration";

/// The rows so far, on disk and in memory.
pub(super) struct EnergyRecorder {
    pub file: EnergiesFile,
    pub rows: EnergyRows,
    /// Whether means are meant to be those of equilibrium.
    is_about_equilibrium: bool,
}

/// Reads the table that a run of this scene, with all its stages, wrote until it came to a step.
pub(crate) fn read(path: &Path, scene: &Checked, step: u64) -> Result<Table, OutputError> {
    let model = scene.model();
    let table = read_table(path)?;
    let expected: Vec<&str> =
        std::iter::once("step").chain(model.physics().columns(model).into_iter().map(|column| column.name)).collect();
    if table.columns != expected {
        let (expected, found) = (expected.join(","), table.columns.join(","));
        return Err(OutputError::Columns { path: path.to_path_buf(), expected, found });
    }
    match missing_row(path, step.saturating_add(1), &scene.parts().unwrap_or_default())? {
        Some(step) => Err(OutputError::MissingRow { path: path.to_path_buf(), step }),
        None => Ok(table),
    }
}

/// The first step below `end` whose row is not in the table of a run with these parts.
fn missing_row(path: &Path, end: u64, parts: &[Checked]) -> Result<Option<u64>, OutputError> {
    let lines = own_file::lines(path).map_err(OutputError::io("continue", path))?;
    let whole = lines.map_while(Result::ok).skip(1).filter(|line| line.ends_with('\n'));
    let mut steps = whole.map_while(|line| line.split([',', '\n']).next()?.parse::<u64>().ok());
    Ok(expected_rows(end, parts).find(|step| steps.next() != Some(*step)))
}

/// The steps below `end` whose rows are in the table of a run with these parts.
fn expected_rows(end: u64, parts: &[Checked]) -> impl Iterator<Item = u64> {
    let begins = std::iter::once(0).chain(parts.iter().map(|part| part.time.steps));
    parts.iter().zip(begins).enumerate().flat_map(move |(number, (part, begin))| {
        let end = if number + 1 == parts.len() { end } else { end.min(part.time.steps) };
        let every = part.output.energies.every.max(1);
        let first = begin.checked_next_multiple_of(every).unwrap_or(u64::MAX);
        (first..end).step_by(usize::try_from(every).unwrap_or(usize::MAX))
    })
}

impl EnergyRecorder {
    /// Begins the table at step 0, or continues in one of these parts of the run what had been written of it before the step of a checkpoint,
    /// with what [`Self::section`] left there.
    pub(super) fn open(
        path: &Path,
        scene: &Checked,
        parts: &[Checked],
        written: Option<Extent>,
        sections: &Sections<'_>,
    ) -> Result<Self, RunError> {
        let (model, step) = (scene.model(), sections.step);
        let kept = samples(scene.output.energies.every, scene.time.equilibration, step);
        let configuration = sections.numbers(SECTION, kept.saturating_mul(2))?.unwrap_or_default();
        let configuration = configuration.as_chunks().0.to_vec();
        let names: Vec<&str> = model.physics().columns(model).into_iter().map(|column| column.name).collect();
        let (file, rows) = match written {
            None => (EnergiesFile::create(path, &names)?, Vec::new()),
            Some(written) => match EnergiesFile::resume(path, &names, written) {
                Err(OutputError::Altered { path }) => {
                    // The row is worth naming, if the rest can be read.
                    return Err(match missing_row(&path, step, parts) {
                        Ok(Some(step)) => OutputError::MissingRow { path, step }.into(),
                        _ => OutputError::Altered { path }.into(),
                    });
                }
                file => (file?, read_table(path)?.rows),
            },
        };
        let is_about_equilibrium = settling::is_about_equilibrium(scene, scene.model());
        let rows = EnergyRows::continued(scene, rows, configuration);
        Ok(Self { file, rows, is_about_equilibrium })
    }

    /// What a checkpoint has to keep besides the table itself.
    pub(super) fn section(&self) -> Vec<u8> {
        bytes(self.rows.configuration.iter().flatten().copied())
    }

    pub(super) fn add(&mut self, observables: &Observables) -> Result<(), RunError> {
        let cells = self.rows.add(observables);
        self.file.append(observables.step, &cells)?;
        Ok(())
    }

    /// Kinetic temperature of the last row.
    pub(super) fn temperature(&self) -> Option<f64> {
        self.rows.last("temperature").filter(|temperature| temperature.is_finite())
    }

    /// Adds the means after equilibration to a summary.
    pub(super) fn summarise(&self, summary: &mut Summary) {
        self.rows.summarise(self.is_about_equilibrium, summary);
    }
}
