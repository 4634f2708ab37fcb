//! What is measured of a choice.

use super::fields;
use crate::families::{Checked, column};
use crate::measure::statistics::mean_within_two_errors;
use crate::output::{RunDirectory, Summary, files as run_files};
use crate::quantity::Quantity;
use crate::run;
use crate::scene::{did_you_mean, nearest};
use crate::study::StudyError;
use crate::sweep::numbers_of;
use crate::table::Table;
use serde::{Deserialize, Serialize};

/// How far the total energy has gone from its first value at most, as a part of it.
pub(super) const ENERGY_DRIFT: &str = "energy_drift";

/// How far the circulation of a material loop has gone from its first value at most, as a part of it.
pub(super) const CIRCULATION_DRIFT: &str = "circulation_drift";

/// How often the limit has cut an exchange, over faces of Voronoi cells and steps.
pub(super) const LIMITED_EXCHANGES: &str = "limited_exchange_share";

/// By what the standard error of a mean from too few samples is taken to be larger. A choice on the safe side: of short runs of a fluid some
/// were off by five of their errors.
const FEW_SAMPLES: f64 = 3.0;

/// Faces of a cell in a periodic plane, each shared by two.
const FACES_A_CELL: f64 = 3.0;

/// A number that was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Its name: a column of the table of energies, `diffusion.einstein` of an analysis, `energy_drift`, `depth_distance`, `depth_from_exact`.
    pub measure: String,
    /// Its value.
    pub value: f64,
    /// Its standard error, where that is known.
    pub standard_error: Option<f64>,
    /// Whether it is a mean that more samples make more certain.
    pub fluctuates: bool,
    /// Whether there were too few samples for the standard error to reach its plateau.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub from_few_samples: bool,
}

impl Measured {
    /// A number that more samples make no more certain.
    pub(super) fn from_one_sample(measure: impl Into<String>, value: f64, standard_error: Option<f64>) -> Self {
        Self { measure: measure.into(), value, standard_error, fluctuates: false, from_few_samples: false }
    }

    /// A mean that more samples make more certain.
    pub(crate) fn mean(measure: String, value: f64, standard_error: Option<f64>, from_few_samples: bool) -> Self {
        Self { measure, value, standard_error, fluctuates: true, from_few_samples }
    }

    /// The standard error that counts: of what is from few samples it is taken to be larger than what they say.
    #[must_use]
    pub fn uncertainty(&self) -> Option<f64> {
        let factor = if self.from_few_samples { FEW_SAMPLES } else { 1.0 };
        self.standard_error.map(|error| factor * error)
    }
}

/// The means of what runs with several seeds measured, with errors from their scatter, of which two hold the true value
/// with 95 % however few seeds there are; what some of them lack is left out. Errors that all of them share, as those
/// of what they are compared with, are added. A single run keeps its own errors, and so does a number that is the same
/// with every seed.
pub(crate) fn over_seeds(runs: &[&[Measured]]) -> Vec<Measured> {
    let Some((first, others)) = runs.split_first() else { return Vec::new() };
    let mean = |found: &Measured| {
        let others = others.iter().map(|run| run.iter().find(|known| known.measure == found.measure));
        let all: Vec<&Measured> = std::iter::once(Some(found)).chain(others).collect::<Option<_>>()?;
        let values: Vec<f64> = all.iter().map(|found| found.value).collect();
        let (value, error) = mean_within_two_errors(&values)?;
        if error == 0.0 {
            return Some(found.clone());
        }
        let shared = all.iter().filter(|found| !found.fluctuates).filter_map(|found| found.standard_error);
        let standard_error = Some(error.hypot(shared.fold(0.0, f64::max)));
        Some(Measured { value, standard_error, from_few_samples: false, ..found.clone() })
    };
    if others.is_empty() { first.to_vec() } else { first.iter().filter_map(mean).collect() }
}

/// Everything that a finished run says by itself.
pub(super) fn of_run(
    summary: &Summary,
    scene: &Checked,
    directory: &RunDirectory,
) -> Result<Vec<Measured>, StudyError> {
    let numbers = numbers_of(&summary.means, &summary.results).into_iter().filter(|found| found.value.is_finite());
    let mut measured: Vec<Measured> =
        numbers.map(|found| Measured::mean(found.name, found.value, found.error, found.from_few_samples)).collect();
    let table = run::read_energies(&directory.file(run_files::ENERGIES), scene, summary.steps)?;
    measured.extend(of_table(&table, scene));
    let drift = run::circulation_change(summary);
    measured.extend(drift.map(|drift| Measured::from_one_sample(CIRCULATION_DRIFT, drift, Some(0.0))));
    measured.extend(fields::from_exact(scene, directory)?);
    Ok(measured)
}

/// What a table of energies says beside the means of its columns, named as [`names_of_table`] says.
pub(crate) fn of_table(table: &Table, scene: &Checked) -> Vec<Measured> {
    let drift = if drifts(scene) { energy_drift(table) } else { None };
    drift.into_iter().chain(limited_exchange_share(table, scene)).collect()
}

/// The names of what the table of energies of a scene says beside the means of its columns.
pub(crate) fn names_of_table(scene: &Checked) -> Vec<&'static str> {
    let is_limited = run::quantities(scene.model()).contains(&column::LIMITED_EXCHANGES);
    let there = [(ENERGY_DRIFT, drifts(scene)), (LIMITED_EXCHANGES, is_limited)];
    there.into_iter().filter(|(_, there)| *there).map(|(name, _)| name).collect()
}

fn limited_exchange_share(table: &Table, scene: &Checked) -> Option<Measured> {
    let [cut, times] = [column::LIMITED_EXCHANGES, "time"].map(|name| table.column(name));
    let change = |values: Vec<f64>| Some(values.last()? - values.first()?);
    let (cut, steps) = (change(cut?)?, change(times?)? / scene.time.step);
    let faces = FACES_A_CELL * scene.model().particle_count() as f64;
    let share = || Measured::from_one_sample(LIMITED_EXCHANGES, cut / (faces * steps), Some(0.0));
    (steps > 0.0 && faces > 0.0).then(share)
}

/// How far the total energy of a table has gone from its first value; none where that is zero or one is not a number.
fn energy_drift(table: &Table) -> Option<Measured> {
    let energies = table.column("total_energy")?;
    let first = energies.first().copied().filter(|first| *first != 0.0)?;
    if energies.iter().any(|energy| !energy.is_finite()) {
        return None;
    }
    let value = energies.iter().map(|energy| ((energy - first) / first).abs()).fold(0.0, f64::max);
    Some(Measured::from_one_sample(ENERGY_DRIFT, value, Some(0.0)))
}

/// Whether the energy of a scene would be constant if its equations of motion were solved exactly, so that its drift is an error.
fn drifts(scene: &Checked) -> bool {
    let model = scene.model();
    let columns = run::quantities(model);
    columns.contains(&"total_energy") && model.physics().is_conservative(model)
}

/// The names of what a scene measures, as far as they are known before it has run: columns of its table of energies and those of this
/// module. What an analysis finds is named `ANALYSIS.NUMBER`.
pub(super) fn names(scene: &Checked) -> Vec<String> {
    let model = scene.model();
    let columns = run::quantities(model);
    let loops = model.physics().material_loops(model).is_some_and(|found| !found.loops.is_empty());
    let further = names_of_table(scene).into_iter().chain(loops.then_some(CIRCULATION_DRIFT));
    let known = columns.iter().copied().chain(further).map(str::to_owned);
    known.chain(fields::names_from_exact(scene)).collect()
}

/// What is wrong with a measure that an option names, which is not among those that a scene has; nothing where it is.
pub(crate) fn unknown(option: &str, measure: &str, known: &[&str]) -> Option<String> {
    let mistake = || {
        let (near, known) = (did_you_mean(nearest(measure, known.iter().copied()).as_deref()), known.join(", "));
        format!("`{option} {measure}`: no run of this scene measures that{near}; accepted: {known}")
    };
    (!known.contains(&measure)).then(mistake)
}

/// Whether a measure without unit says how large an error is, as a part of something: a drift, a distance or a share.
pub(super) fn is_part(measure: &str) -> bool {
    [ENERGY_DRIFT, CIRCULATION_DRIFT, LIMITED_EXCHANGES].contains(&measure)
        || [fields::DISTANCE, fields::FROM_EXACT].iter().any(|end| measure.ends_with(end))
}

/// What is assessed where nobody says which: the usual columns, what analyses find with an error, drifts, distances and exchanges that were
/// limited.
pub(super) fn usual(measured: &[Measured]) -> Vec<String> {
    let known = |name: &str| measured.iter().any(|found| found.measure == name);
    let drift_alone = known(ENERGY_DRIFT);
    let columns =
        Quantity::usual().map(|usual| usual.name).filter(|name| !drift_alone && known(name)).map(str::to_owned);
    let is_of_analysis = |found: &Measured| found.measure.contains('.') && found.standard_error.is_some();
    let others = measured.iter().filter(|found| !found.fluctuates || is_of_analysis(found));
    columns.chain(others.map(|found| found.measure.clone())).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// 1, 2 and 6 have the mean 3 and the error √((4 + 1 + 9)/(3·2)), before Student's factor of two degrees of
    /// freedom.
    #[test]
    fn means_over_seeds_have_the_error_of_their_scatter() {
        let run = |mean: f64, distance: f64, samples: f64| {
            vec![
                Measured::mean("pressure".to_owned(), mean, Some(100.0), false),
                Measured::from_one_sample("depth_distance", distance, Some(0.3)),
                Measured::mean("radial_distribution.samples".to_owned(), samples, None, false),
            ]
        };
        let mut runs = [run(1.0, 0.5, 8.0), run(2.0, 0.5, 8.0), run(6.0, 0.5, 8.0)];
        runs[0].push(Measured::mean("of_one".to_owned(), 1.0, None, false));
        let all: Vec<&[Measured]> = runs.iter().map(Vec::as_slice).collect();
        let found = over_seeds(&all);
        let names: Vec<&str> = found.iter().map(|found| found.measure.as_str()).collect();
        assert_eq!(names, ["pressure", "depth_distance", "radial_distribution.samples"]);
        // The 95 % interval of two degrees of freedom is 4.303 standard errors wide, to each side.
        let widened = 0.5 * 4.303 * (14.0_f64 / 6.0).sqrt();
        assert_eq!((found[0].value, found[0].from_few_samples), (3.0, false));
        assert!((found[0].standard_error.unwrap() - widened).abs() < 1e-3 * widened);
        // All seeds share the error of what they are compared with; a count has none.
        assert_eq!((found[1].standard_error, found[1].from_few_samples), (Some(0.3), false));
        assert_eq!((found[2].value, found[2].standard_error), (8.0, None));
        assert_eq!(over_seeds(&all[..1]), runs[0]);
    }
}
