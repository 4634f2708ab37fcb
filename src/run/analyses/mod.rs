//! Analyses: what a run measures besides the observables, and what it says of them.
//!
//! Each has an id, [`AnalysisId`], and a file here with its [`Descriptor`]: its sampler in the plan, how samples are gathered, its
//! tables and their columns, charts, what `check` says of it before a run and what a run prints at its end.

mod autocorrelation;
mod chain;
mod chain_sizes;
mod circulation;
mod clusters;
mod descriptor;
mod diffusion;
mod gathered;
mod histogram;
mod histogram_range;
mod neighbours;
mod pair_histogram;
mod planner;
mod profiles;
mod quantities;
mod radial_distribution;
mod results;
mod shear_wave;
mod species_pairs;
mod spectra;
mod stress;
mod structure_factor;
mod under_way;
mod viscosity;

pub(super) use planner::Planner;
pub(super) use results::mean;
pub use results::printed_estimate;
pub(super) use stress::stress_of_sample;
pub(super) use under_way::Analyses;

pub(super) use descriptor::Setting;

use descriptor::{Conclusion, Descriptor, Drawn, Sampling};
use gathered::{Gathered, Part};
use planner::SumSampler;
use results::{NO_SAMPLE, found, number, of_species, whose, windows_missing};

use crate::families::{Checked, Model};
use crate::output::Summary;
use crate::plan::Need;
use crate::plot::Chart;
use crate::scene::{AnalysisId, AnalysisTable, Output, Scene};
use crate::table::Table;
use serde_json::{Map, Value};

/// The registry of analyses.
fn describe(id: AnalysisId) -> Box<dyn Descriptor> {
    match id {
        AnalysisId::RadialDistribution => Box::new(radial_distribution::RadialDistribution),
        AnalysisId::StructureFactor => Box::new(structure_factor::StructureFactor),
        AnalysisId::Diffusion => Box::new(diffusion::Diffusion),
        AnalysisId::ChainSizes => Box::new(chain_sizes::ChainSizes),
        AnalysisId::Clusters => Box::new(clusters::Clusters),
        AnalysisId::Viscosity => Box::new(viscosity::Viscosity),
        AnalysisId::Autocorrelation(quantity) => Box::new(autocorrelation::Autocorrelation(quantity)),
        AnalysisId::Histogram(quantity) => Box::new(histogram::Histogram(quantity)),
        AnalysisId::Circulation => Box::new(circulation::Circulation),
        AnalysisId::Chain => Box::new(chain::Chain),
        AnalysisId::Neighbours => Box::new(neighbours::Neighbours),
        AnalysisId::ShearWave => Box::new(shear_wave::ShearWave),
        AnalysisId::Spectra => Box::new(spectra::Spectra),
        AnalysisId::Profiles => Box::new(profiles::Profiles),
        AnalysisId::Stress => Box::new(stress::Stress),
    }
}

/// The mass of all particles.
fn total_mass(model: &Model) -> f64 {
    model.species.iter().map(|species| species.mass * species.count as f64).sum()
}

/// The names of species by their numbers.
fn species_of(scene: &Checked, numbers: &[usize]) -> Vec<String> {
    let species = numbers.iter().filter_map(|number| scene.model().species.get(*number));
    species.map(|species| species.name.clone()).collect()
}

/// What reports have to leave for the analyses that a scene asks for.
pub(super) fn needs(output: &Output) -> Vec<Need> {
    output.analyses().into_iter().flat_map(|id| describe(id).needs(output)).copied().collect()
}

/// Adds the samplers of the analyses that a scene asks for, in its order, and then of those that come with the model.
pub(super) fn add_samplers(planner: &mut Planner<'_>) {
    let mut ids = planner.output.analyses();
    let others = AnalysisId::ALL.into_iter().filter(|id| !ids.contains(id)).collect::<Vec<_>>();
    ids.extend(others);
    for id in ids {
        describe(id).add_sampler(planner);
    }
}

/// An analysis that a scene asks for, before the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AskedAnalysis {
    /// Its id.
    pub id: AnalysisId,
    /// The first step sampled.
    pub first: u64,
    /// Steps between two samples.
    pub every: u64,
    /// How the samples are used, in words.
    pub detail: Option<String>,
    /// The tables that it writes.
    pub tables: &'static [AnalysisTable],
    /// The names of the numbers that it finds, as its results have them: `peak_height`.
    pub found: Vec<&'static str>,
    /// Numbers that its tables will hold, if they are many.
    pub(crate) numbers: u64,
    /// Bytes that it adds to a checkpoint.
    pub(crate) kept_bytes: u64,
}

/// The analyses that a scene asks for, in the order in which their files are listed.
///
/// ```
/// use mesoscope::scene::{self, AnalysisId};
///
/// let scene = scene::load("dpd-fluid", &[])?;
/// let asked = mesoscope::run::asked_analyses(&scene);
/// assert_eq!(asked[0].id, AnalysisId::RadialDistribution);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn asked_analyses(scene: &Checked) -> Vec<AskedAnalysis> {
    let asked = AnalysisId::ALL.into_iter().filter_map(|id| {
        let descriptor = describe(id);
        let sampling = descriptor.asked(scene)?;
        let kept_bytes = Gathered::new(descriptor.parts(scene)).length_after(sampling.count(scene)).saturating_mul(8);
        let Sampling { first, every, detail, numbers, left_out } = sampling;
        let tables = id.tables().split_at(id.tables().len().saturating_sub(left_out)).0;
        let found = descriptor.finds(scene);
        Some(AskedAnalysis { id, first, every, detail, tables, found, numbers, kept_bytes })
    });
    asked.collect()
}

/// The largest change of the circulation of a material loop in a run, as a part of what it was at first; none without such loops.
pub(crate) fn circulation_change(summary: &Summary) -> Option<f64> {
    circulation::largest_change(summary.results.get(AnalysisId::Circulation.name())?)
}

/// Lines of the table that is printed at the end of a run: what was found, and its value, of the results of a run or a stage.
#[must_use]
pub fn printed_results(results: &Map<String, Value>) -> Vec<(String, String)> {
    let results = AnalysisId::ALL.into_iter().filter_map(|id| Some((id, results.get(id.name())?)));
    let lines = |(id, result): (AnalysisId, &Value)| {
        let of = whose(result).map(|name| format!(" of {name}")).unwrap_or_default();
        describe(id).printed(result).into_iter().map(move |(label, value)| (label + &of, value))
    };
    results.flat_map(lines).collect()
}

/// All tables that analyses may leave, with their analysis and their place among its tables.
pub(super) fn tables() -> impl Iterator<Item = (AnalysisId, usize, AnalysisTable)> {
    AnalysisId::ALL
        .into_iter()
        .flat_map(|id| id.tables().iter().enumerate().map(move |(place, names)| (id, place, *names)))
}

/// The chart of a table, with the results of a run that belong to it.
pub(super) fn chart(
    id: AnalysisId,
    place: usize,
    table: &Table,
    scene: &Scene,
    model: &Model,
    results: &Map<String, Value>,
) -> Chart {
    let result = results.get(id.name()).unwrap_or(&Value::Null);
    let mut chart = describe(id).chart(&Drawn { scene, model, table, place, result });
    let parts = [whose(result).map(|name| format!("species {name}")), Some(chart.subtitle)];
    chart.subtitle = parts.into_iter().flatten().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ");
    chart
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn results_stand_in_the_charts_of_their_tables() {
        let scene = crate::scene::load("ideal-dissipative-gas", &[]).unwrap();
        let results = serde_json::json!({
            "diffusion": { "diffusion_einstein": { "value": 0.3, "error": 0.01 }, "diffusion_green_kubo": null },
            "shear_wave": { "decay_rate": { "value": 0.2, "error": 0.01 },
                "kinematic_viscosity": { "value": 7.0, "error": null } },
        });
        let results = results.as_object().unwrap();
        let table = |columns: &[&str]| {
            Table::new(columns.to_vec(), (0..8).map(|row| vec![1.0 + f64::from(row); columns.len()]).collect())
        };
        let drawn =
            |id: AnalysisId, columns: &[&str], results| chart(id, 0, &table(columns), &scene, scene.model(), results);
        let found = drawn(AnalysisId::Diffusion, &["time", "mean_squared_displacement"], results);
        assert_eq!(found.panels[0].series[1].name, "6 D t + b, D = 0.300 ± 0.010");
        let found = drawn(AnalysisId::ShearWave, &["time", "amplitude", "fit"], results);
        assert!(found.subtitle.ends_with("kinematic viscosity 7"), "{}", found.subtitle);
        assert_eq!(found.panels[0].series[1].name, "exponential decay, rate 0.200 ± 0.010");
        // A run of an earlier version, without results.
        let found = drawn(AnalysisId::Diffusion, &["time", "mean_squared_displacement"], &Map::new());
        assert_eq!(found.panels[0].series.len(), 1);
    }
}
