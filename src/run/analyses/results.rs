//! Numbers of results, as charts and the table at the end of a run take them, and why there are none.

use crate::families::Model;
use crate::measure::correlation::WindowedAverage;
use crate::numbers::with_error;
use crate::plot::{Found, Mean};
use crate::printable;
use serde_json::Value;
use std::borrow::Cow;

/// Why an analysis without samples has no result.
pub(super) const NO_SAMPLE: &str = "no sample was taken after equilibration";

/// Why windows give no result, if they do not.
pub(super) fn windows_missing(average: &WindowedAverage, model: &Model, species: Option<&str>) -> Option<String> {
    if average.windows().len() == 0 {
        Some(format!("the run ends before a window of {} samples is full", average.lags()))
    } else if model.mobile_particles_of(species) == 0 {
        let whose = species.map(|name| format!(" of species `{name}`")).unwrap_or_default();
        Some(format!("there are no particles{whose} that can move"))
    } else {
        None
    }
}

/// A result that says which species it is of, if it is of one.
pub(super) fn of_species(species: Option<&str>, mut result: Value) -> Value {
    if let Some(name) = species {
        result[SPECIES] = name.into();
    }
    result
}

/// The key of a result that names its species.
const SPECIES: &str = "species";

/// The species that a result is of, for people; none where it is of all.
pub(super) fn whose(result: &Value) -> Option<Cow<'_, str>> {
    result[SPECIES].as_str().map(printable::name)
}

/// A coefficient with its error, from a result.
pub(super) fn found(result: &Value) -> Option<Found> {
    Some((result["value"].as_f64()?, result["standard_error"].as_f64()))
}

/// A coefficient or a mean of a result with its error, in words.
pub(super) fn printed(result: &Value) -> Option<String> {
    found(result).map(|(value, error)| with_error(value, error)).or_else(|| printed_mean(result))
}

/// A mean of a result or a summary, as charts take it.
pub(in crate::run) fn mean(result: &Value) -> Option<Mean> {
    let standard_error = result["standard_error"].as_f64();
    let from_few_samples = standard_error.is_some() && result["converged"] == false;
    Some(Mean { value: result["mean"].as_f64()?, standard_error, from_few_samples, ..Mean::default() })
}

/// A mean of a result or a summary with its error; an error that is not known to a quarter of itself is marked by `*`.
///
/// ```
/// use mesoscope::run::printed_mean;
/// use serde_json::json;
///
/// let mean = json!({ "mean": 1.004, "standard_error": 0.012, "converged": false });
/// assert_eq!(printed_mean(&mean).as_deref(), Some("1.004 ± 0.012 *"));
/// ```
#[must_use]
pub fn printed_mean(entry: &Value) -> Option<String> {
    let mean = mean(entry)?;
    let text = with_error(mean.value, mean.standard_error);
    Some(if mean.from_few_samples { format!("{text} *") } else { text })
}
