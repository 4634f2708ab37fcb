//! A tradeoff with numbers that a test makes up.

#![allow(clippy::unwrap_used)]

use super::reference::{Reference, Source};
use super::summary::{ChoiceState, TradeoffSummary};
use super::{Cost, Measured, Request, Target};
use crate::study::Record as _;

/// The measure that all of it is about.
pub(super) const MEASURE: &str = "pressure";

/// Choices of the standard fluid, each with its cost and the value and standard error of its pressure; none for one that became unstable. What it
/// is compared with is 20, and has no error.
pub(super) fn summary(vary: &[&str], target: &str, choices: &[Option<(f64, f64, f64)>]) -> (Request, TradeoffSummary) {
    let vary: Vec<String> = vary.iter().map(|varied| (*varied).to_owned()).collect();
    let target = Target::parse(&format!("{MEASURE}={target}")).unwrap();
    let request = Request::load("dpd-fluid", &[], None, &vary, &[]).unwrap().with_targets(vec![target]).unwrap();
    let given = Reference { measure: MEASURE.to_owned(), value: 20.0, uncertainty: Some(0.0), source: Source::Given };
    let request = request.with_references(super::References::parse(&[format!("{MEASURE}=20")]).unwrap()).unwrap();
    let mut summary = TradeoffSummary::before(&request);
    (summary.measures, summary.references) = (vec![MEASURE.to_owned()], vec![given]);
    assert_eq!(summary.choices.len(), choices.len());
    for (choice, made_up) in summary.choices.iter_mut().zip(choices) {
        let Some((cost, value, error)) = *made_up else {
            choice.state = ChoiceState::Unstable;
            continue;
        };
        choice.state = ChoiceState::Finished;
        choice.cost = Some(Cost {
            seconds_per_time: cost,
            fastest: cost,
            slowest: cost,
            particle_steps_per_second: 1.0 / cost,
            bytes_per_particle: 100.0,
        });
        choice.measured.push(Measured::mean(MEASURE.to_owned(), value, Some(error), false));
    }
    summary.assess(&request).unwrap();
    summary.choose();
    (request, summary)
}
