//! Numbers of results, as charts and the table at the end of a run take them, and why there are none.

use crate::families::Model;
use crate::measure::correlation::WindowedAverage;
use crate::measure::statistics::Estimate;
use crate::numbers::with_error;
use crate::plot::Mean;
use crate::printable;
use serde::Deserialize;
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

/// A number of a result or a summary, if it is one that was measured.
pub(super) fn found(result: &Value) -> Option<Estimate> {
    Estimate::deserialize(result).ok()
}

/// A number of a result, with an error or without.
pub(super) fn number(result: &Value) -> Option<f64> {
    result["value"].as_f64()
}

/// A number of a result or a summary, as charts take means.
pub(in crate::run) fn mean(result: &Value) -> Option<Mean> {
    let Estimate { value, error, few, .. } = found(result)?;
    Some(Mean { value, standard_error: error, from_few_samples: error.is_some() && few, ..Mean::default() })
}

/// A number of a result or a summary with its error; an error that is not known to a quarter of itself is marked by `*`.
///
/// ```
/// use mesoscope::run::printed_estimate;
/// use serde_json::json;
///
/// let mean = json!({ "value": 1.004, "error": 0.012, "samples": 5, "few": true });
/// assert_eq!(printed_estimate(&mean).as_deref(), Some("1.004 ± 0.012 *"));
/// ```
#[must_use]
pub fn printed_estimate(entry: &Value) -> Option<String> {
    let mean = mean(entry)?;
    let text = with_error(mean.value, mean.standard_error);
    Some(if mean.from_few_samples { format!("{text} *") } else { text })
}
