//! What is measured of a choice.

use super::error::TradeoffError;
use crate::families::Model;
use crate::output::{RunDirectory, Summary, files as run_files};
use crate::run;
use crate::scene::Scene;
use crate::sweep::numbers_of;
use crate::table::Table;
use serde::{Deserialize, Serialize};

/// How far the total energy has gone from its first value at most, as a part of it.
pub(crate) const ENERGY_DRIFT: &str = "energy_drift";

/// Columns that are assessed where nobody says which, if a run has them.
const USUAL: [&str; 4] = ["temperature", "configurational_temperature", "pressure", "potential_energy"];

/// A number that was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Its name: a column of the table of energies, `diffusion.einstein` of an analysis, `energy_drift`, `depth_distance`.
    pub measure: String,
    /// Its value.
    pub value: f64,
    /// Its standard error, where that is known.
    pub standard_error: Option<f64>,
    /// Whether it is a mean that more samples make more certain.
    pub fluctuates: bool,
}

/// Everything that a finished run says by itself.
pub(super) fn of_run(
    summary: &Summary,
    scene: &Scene,
    directory: &RunDirectory,
) -> Result<Vec<Measured>, TradeoffError> {
    let mut measured: Vec<Measured> = numbers_of(&summary.means, &summary.results)
        .into_iter()
        .filter(|(_, value, _)| value.is_finite())
        .map(|(measure, value, standard_error)| Measured { measure, value, standard_error, fluctuates: true })
        .collect();
    if drifts(scene) {
        let table = run::read_energies(&directory.file(run_files::ENERGIES), scene, summary.steps)?;
        measured.extend(energy_drift(&table));
    }
    Ok(measured)
}

/// How far the total energy of a table has gone from its first value; none where that is zero or one is not a number.
pub(crate) fn energy_drift(table: &Table) -> Option<Measured> {
    let energies = table.column("total_energy")?;
    let first = energies.first().copied().filter(|first| *first != 0.0)?;
    if energies.iter().any(|energy| !energy.is_finite()) {
        return None;
    }
    let value = energies.iter().map(|energy| ((energy - first) / first).abs()).fold(0.0, f64::max);
    Some(Measured { measure: ENERGY_DRIFT.to_owned(), value, standard_error: Some(0.0), fluctuates: false })
}

/// Whether the energy of a scene would be constant if its equations of motion were solved exactly, so that its drift is an error.
pub(crate) fn drifts(scene: &Scene) -> bool {
    let model = Model::new(scene);
    let columns = run::quantities(&model);
    columns.contains(&"total_energy") && model.physics().is_conservative(&model)
}

/// The names of what a scene measures, as far as they are known before it has run: columns of its table of energies and those of this
/// module. What an analysis finds is named `ANALYSIS.NUMBER`.
pub(super) fn names(scene: &Scene) -> Vec<String> {
    let columns = run::quantities(&Model::new(scene)).into_iter().map(str::to_owned);
    columns.chain(drifts(scene).then(|| ENERGY_DRIFT.to_owned())).collect()
}

/// What is assessed where nobody says which: the usual columns, what analyses find with an error, drift and distances.
pub(super) fn usual(measured: &[Measured]) -> Vec<String> {
    let known = |name: &str| measured.iter().any(|found| found.measure == name);
    let drift_alone = known(ENERGY_DRIFT);
    let columns = USUAL.into_iter().filter(|name| !drift_alone && known(name)).map(str::to_owned);
    let others = measured.iter().filter(|found| {
        let of_analysis = found.measure.contains('.') && found.standard_error.is_some();
        of_analysis || !found.fluctuates
    });
    columns.chain(others.map(|found| found.measure.clone())).collect()
}
