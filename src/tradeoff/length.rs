//! How long the runs of a tradeoff are.

use super::summary::Choice;
use serde::{Deserialize, Serialize};

/// How often the runs are made longer, at most: each time by what is known from the last.
const MOST_EXTENSIONS: usize = 5;
/// The most by which one extension lengthens the runs: what a short run says of its error is itself uncertain.
const LARGEST_FACTOR: f64 = 8.0;
/// A factor that is not worth another round.
const SMALLEST_FACTOR: f64 = 1.1;
/// More samples than the law of the inverse square asks for, so that one extension is usually enough.
const MARGIN: f64 = 1.15;

/// How long the runs are: the simulated time of the scene, unless more is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Length {
    /// The relative standard error that every mean is to have, at most.
    pub error: Option<f64>,
    /// Seconds that all steps of all runs may take together.
    pub budget: Option<f64>,
}

/// What an extension of all runs is to be, and whether the budget allows no more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extension {
    /// By what the averaged time is multiplied; one or less means that the runs stay as they are.
    pub factor: f64,
    /// Whether the budget ends before the error is reached.
    pub is_short: bool,
}

/// By what to lengthen all runs so that the worst relative standard error falls from `worst` to what is asked for, within the
/// budget. `spent` are the seconds of all runs so far, `averaged` the simulated time that means are taken over, `rounds` how often the runs
/// were made longer.
pub(super) fn extension(length: &Length, worst: Option<f64>, spent: f64, averaged: f64, rounds: usize) -> Extension {
    let wanted = match (length.error, worst) {
        (Some(error), Some(worst)) if worst > error => ((worst / error).powi(2) * MARGIN).min(LARGEST_FACTOR),
        // An error that is not known yet needs more samples to be known.
        (Some(_), None) => 2.0,
        // Without an error to reach, a budget is there to be used.
        (None, _) if length.budget.is_some() => LARGEST_FACTOR,
        _ => 1.0,
    };
    if wanted <= 1.0 || rounds >= MOST_EXTENSIONS || averaged <= 0.0 {
        return Extension { factor: 1.0, is_short: wanted > 1.0 && length.error.is_some() };
    }
    // Seconds go with the time that is simulated.
    let allowed =
        length.budget.map_or(f64::INFINITY, |budget| if spent > 0.0 { budget / spent } else { f64::INFINITY });
    let factor = wanted.min(allowed);
    let factor = if factor < SMALLEST_FACTOR { 1.0 } else { factor };
    Extension { factor, is_short: length.error.is_some() && allowed < wanted }
}

/// The largest relative standard error among what is assessed of all choices; none where no mean has one yet. What an analysis gives
/// without an error never has one.
pub(super) fn worst_error(choices: &[Choice], measures: &[String]) -> Option<f64> {
    let mut worst = None;
    for measured in choices.iter().flat_map(|choice| &choice.measured) {
        if !measures.contains(&measured.measure) || !measured.fluctuates {
            continue;
        }
        let Some(error) = measured.standard_error else { continue };
        let relative = if measured.value == 0.0 { error } else { (error / measured.value).abs() };
        worst = Some(worst.map_or(relative, |worst: f64| worst.max(relative)));
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_times_the_samples_halve_an_error() {
        let asked = Length { error: Some(0.01), budget: None };
        let found = extension(&asked, Some(0.02), 10.0, 5.0, 0);
        assert!((found.factor - 4.0 * MARGIN).abs() < 1e-12 && !found.is_short);
        assert_eq!(extension(&asked, Some(0.009), 10.0, 5.0, 0).factor, 1.0);
        assert_eq!(extension(&asked, Some(1.0), 10.0, 5.0, 0).factor, LARGEST_FACTOR);
        assert!(extension(&asked, Some(0.02), 10.0, 5.0, MOST_EXTENSIONS).is_short);
    }

    #[test]
    fn a_budget_limits_what_an_error_asks_for() {
        let asked = Length { error: Some(0.01), budget: Some(20.0) };
        let found = extension(&asked, Some(0.02), 10.0, 5.0, 0);
        assert_eq!((found.factor, found.is_short), (2.0, true));
        let found = extension(&Length { error: None, budget: Some(20.0) }, Some(0.02), 10.0, 5.0, 0);
        assert_eq!((found.factor, found.is_short), (2.0, false));
        let used_up = extension(&Length { error: None, budget: Some(20.0) }, Some(0.02), 19.0, 5.0, 0);
        assert_eq!((used_up.factor, used_up.is_short), (1.0, false));
        assert_eq!(extension(&Length::default(), Some(0.5), 10.0, 5.0, 0).factor, 1.0);
    }
}
