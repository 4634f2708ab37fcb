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

/// By what runs are made longer where an error is not known yet.
const TO_BE_KNOWN: f64 = 2.0;

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
    /// How many extensions are expected, this one included.
    pub rounds: usize,
    /// By what all of them together multiply the averaged time.
    pub total: f64,
}

impl Extension {
    /// None.
    pub(super) fn none(is_short: bool) -> Self {
        Self { factor: 1.0, is_short, rounds: 0, total: 1.0 }
    }
}

/// The largest relative standard errors among what is assessed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Worst {
    /// As they count: larger where they are from few samples.
    pub counted: f64,
    /// As the samples say.
    pub measured: f64,
}

/// By what to lengthen all runs so that the worst relative standard error falls from `worst` to what is asked for, within the
/// budget. `spent` are the seconds of all runs so far, `averaged` the simulated time that means are taken over, `done` how often the runs
/// were made longer.
pub(super) fn extension(length: &Length, worst: Option<Worst>, spent: f64, averaged: f64, done: usize) -> Extension {
    let wanted = match (length.error, worst) {
        (Some(error), Some(worst)) if worst.measured > error => (worst.measured / error).powi(2) * MARGIN,
        // An error that is not known yet needs more samples to be known.
        (Some(error), worst) if worst.is_none_or(|worst| worst.counted > error) => TO_BE_KNOWN,
        // Without an error to reach, a budget is there to be used.
        (None, _) if length.budget.is_some() => LARGEST_FACTOR,
        _ => 1.0,
    };
    if wanted <= 1.0 || done >= MOST_EXTENSIONS || averaged <= 0.0 {
        return Extension::none(wanted > 1.0 && length.error.is_some());
    }
    // Seconds go with the time that is simulated.
    let allowed =
        length.budget.map_or(f64::INFINITY, |budget| if spent > 0.0 { budget / spent } else { f64::INFINITY });
    let is_short = length.error.is_some() && allowed < wanted.min(LARGEST_FACTOR);
    let factor = wanted.min(LARGEST_FACTOR).min(allowed);
    if factor < SMALLEST_FACTOR {
        return Extension::none(is_short);
    }
    let wanted = wanted.min(allowed);
    let rounds = (wanted.ln() / LARGEST_FACTOR.ln()).ceil().clamp(1.0, (MOST_EXTENSIONS - done) as f64);
    Extension { factor, is_short, rounds: rounds as usize, total: wanted.min(LARGEST_FACTOR.powf(rounds)) }
}

/// The largest relative standard errors among what is assessed of all choices; none where no mean has one yet. What an analysis gives
/// without an error never has one.
pub(super) fn worst_error(choices: &[Choice], measures: &[String]) -> Option<Worst> {
    let measured = choices.iter().flat_map(|choice| &choice.measured);
    let assessed = measured.filter(|found| found.fluctuates && measures.contains(&found.measure));
    let errors = assessed.filter_map(|found| {
        let relative = |error: f64| if found.value == 0.0 { error } else { (error / found.value).abs() };
        Some(Worst { counted: relative(found.uncertainty()?), measured: relative(found.standard_error?) })
    });
    errors.reduce(|one, other| Worst {
        counted: one.counted.max(other.counted),
        measured: one.measured.max(other.measured),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(asked: &Length, worst: Worst, done: usize) -> Extension {
        extension(asked, Some(worst), 10.0, 5.0, done)
    }

    fn known(error: f64) -> Worst {
        Worst { counted: error, measured: error }
    }

    #[test]
    fn four_times_the_samples_halve_an_error() {
        let asked = Length { error: Some(0.01), budget: None };
        let found = of(&asked, known(0.02), 0);
        assert!((found.factor - 4.0 * MARGIN).abs() < 1e-12 && !found.is_short);
        assert_eq!(of(&asked, known(0.009), 0).factor, 1.0);
        assert_eq!(of(&asked, known(1.0), 0).factor, LARGEST_FACTOR);
        assert!(of(&asked, known(0.02), MOST_EXTENSIONS).is_short);
    }

    #[test]
    fn errors_from_few_samples_are_not_believed() {
        let asked = Length { error: Some(0.01), budget: None };
        let few = |error: f64| Worst { counted: 3.0 * error, measured: error };
        // It seems to be reached, and more samples have to say so; where it is not, its size is the best guess of what is missing.
        assert_eq!(of(&asked, few(0.009), 0).factor, TO_BE_KNOWN);
        assert!((of(&asked, few(0.02), 0).factor - 4.0 * MARGIN).abs() < 1e-12);
        assert_eq!(of(&asked, few(0.003), 0).factor, 1.0);
        assert_eq!(extension(&asked, None, 10.0, 5.0, 0).factor, TO_BE_KNOWN);
    }

    #[test]
    fn the_rounds_that_are_expected_are_counted() {
        let asked = Length { error: Some(0.01), budget: None };
        let rounds = |worst: f64, done: usize| {
            let found = of(&asked, known(worst), done);
            (found.rounds, found.total)
        };
        // 4.6, 115 and 11 500 times the samples; a million times is more than five rounds give.
        assert_eq!(rounds(0.02, 0).0, 1);
        assert_eq!(rounds(0.1, 0), (3, 100.0 * MARGIN));
        assert_eq!(rounds(1.0, 0).0, 5);
        assert_eq!(rounds(10.0, 0), (5, LARGEST_FACTOR.powi(5)));
        assert_eq!(rounds(1.0, 3), (2, LARGEST_FACTOR.powi(2)));
        assert_eq!(rounds(0.005, 0), (0, 1.0));
    }

    #[test]
    fn a_budget_limits_what_an_error_asks_for() {
        let asked = Length { error: Some(0.01), budget: Some(20.0) };
        let found = of(&asked, known(0.02), 0);
        assert_eq!((found.factor, found.is_short), (2.0, true));
        let found = of(&Length { error: None, budget: Some(20.0) }, known(0.02), 0);
        assert_eq!((found.factor, found.is_short), (2.0, false));
        let used_up = extension(&Length { error: None, budget: Some(20.0) }, Some(known(0.02)), 19.0, 5.0, 0);
        assert_eq!((used_up.factor, used_up.is_short), (1.0, false));
        assert_eq!(of(&Length::default(), known(0.5), 0).factor, 1.0);
    }
}
