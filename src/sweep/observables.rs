//! The numbers that came out of a variant: means of the table of energies and results of the analyses.

use super::variant::VariantSummary;
use serde_json::{Map, Value};

/// A quantity with its standard error, which may be missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Observable {
    /// `temperature`, `diffusion.diffusion_einstein`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub error: Option<f64>,
    /// Whether it is a mean that includes the way to equilibrium.
    pub unequilibrated: bool,
}

/// All numbers of a variant, in order.
pub(super) fn observables(variant: &VariantSummary) -> Vec<Observable> {
    let is_spoilt = |name: &str| variant.unequilibrated.as_ref().is_some_and(|found| found.includes(name));
    let mean = |name: &String, mean: &Value| {
        Some(Observable { unequilibrated: is_spoilt(name), ..observable(name.clone(), mean)? })
    };
    let means = variant.means.iter().filter_map(|(name, found)| mean(name, found));
    let results = variant.results.iter().flat_map(|(name, result)| results(name, result));
    means.chain(results).collect()
}

/// The numbers among the means and results of a run: name, value and standard error.
pub(crate) fn numbers_of(means: &Map<String, Value>, results: &Map<String, Value>) -> Vec<(String, f64, Option<f64>)> {
    let means = means.iter().filter_map(|(name, found)| observable(name.clone(), found));
    let results = results.iter().flat_map(|(name, result)| self::results(name, result));
    means.chain(results).map(|found| (found.name, found.value, found.error)).collect()
}

/// A number, or an object with a mean or a value and maybe a standard error.
pub(super) fn observable(name: String, found: &Value) -> Option<Observable> {
    let value = found.as_f64().or_else(|| found["mean"].as_f64()).or_else(|| found["value"].as_f64())?;
    Some(Observable { name, value, error: found["standard_error"].as_f64(), unequilibrated: false })
}

/// The numbers in the result of an analysis: `radial_distribution.peak_height`.
fn results(name: &str, result: &Value) -> Vec<Observable> {
    let entries = result.as_object().into_iter().flatten();
    entries.filter_map(|(key, value)| observable(format!("{name}.{key}"), value)).collect()
}
