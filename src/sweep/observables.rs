//! The numbers that came out of a variant: means of the table of energies and results of the analyses.

use super::variant::VariantSummary;
use crate::measure::statistics::Estimate;
use serde::Deserialize;
use serde_json::{Map, Value};

/// A quantity with its standard error, which may be missing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Observable {
    /// `temperature`, `diffusion.diffusion_einstein`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub error: Option<f64>,
    /// Whether there were too few samples for the error to settle, so that it is likely larger.
    pub from_few_samples: bool,
    /// Whether it is a mean that includes the way to equilibrium.
    pub unequilibrated: bool,
}

/// All numbers of a variant, in order.
pub(super) fn observables(variant: &VariantSummary) -> Vec<Observable> {
    let is_spoilt = |name: &str| variant.unequilibrated.as_ref().is_some_and(|found| found.includes(name));
    let noted = |found: Observable| Observable { unequilibrated: is_spoilt(&found.name), ..found };
    numbers_of(&variant.means, &variant.results).into_iter().map(noted).collect()
}

/// The numbers among the means and results of a run.
pub(crate) fn numbers_of(means: &Map<String, Value>, results: &Map<String, Value>) -> Vec<Observable> {
    let means = means.iter().filter_map(|(name, found)| observable(name.clone(), found));
    // Those in the result of an analysis: `radial_distribution.peak_height`.
    let of_analysis = |(name, result): (&String, &Value)| {
        let entries = result.as_object().into_iter().flatten();
        entries.filter_map(|(key, value)| observable(format!("{name}.{key}"), value)).collect::<Vec<_>>()
    };
    means.chain(results.iter().flat_map(of_analysis)).collect()
}

/// A number, as such or with its error.
pub(super) fn observable(name: String, found: &Value) -> Option<Observable> {
    let exact = || found.as_f64().map(|value| Estimate { value, ..Estimate::default() });
    let Estimate { value, error, few, .. } = Estimate::deserialize(found).ok().or_else(exact)?;
    Some(Observable { name, value, error, from_few_samples: error.is_some() && few, unequilibrated: false })
}
