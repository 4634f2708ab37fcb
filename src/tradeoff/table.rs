//! The table of a tradeoff, `tradeoff.csv`: a row for every choice.

use super::cost::Cost;
use super::summary::{Choice, TradeoffSummary};
use crate::study::table::{number, rows, settings_of_keys};

pub(super) fn text(summary: &TradeoffSummary, keys: &[&str]) -> String {
    rows(summary.choices.iter().map(|choice| row(summary, choice, keys)))
}

/// Whether the error of any scheme by itself is known.
fn is_known_of_schemes(summary: &TradeoffSummary, measure: &str) -> bool {
    summary.choices.iter().any(|choice| choice.error(measure).is_some_and(|error| error.of_scheme.is_some()))
}

/// Names of columns and cells.
fn row(summary: &TradeoffSummary, choice: &Choice, keys: &[&str]) -> Vec<(String, String)> {
    let mut row = vec![("choice".to_owned(), choice.name.clone())];
    row.extend(settings_of_keys(&choice.settings, keys));
    let of_cost = |value: fn(Cost) -> f64| number(choice.cost.map(value));
    let stretch = choice.float64_stretch;
    let of_run = [
        ("state", choice.state.to_string()),
        ("steps", choice.steps.to_string()),
        ("seconds_per_time", of_cost(|cost| cost.seconds_per_time)),
        ("seconds_per_time_fastest", of_cost(|cost| cost.fastest)),
        ("seconds_per_time_slowest", of_cost(|cost| cost.slowest)),
        ("particle_steps_per_second", of_cost(|cost| cost.particle_steps_per_second)),
        ("bytes_per_particle", of_cost(|cost| cost.bytes_per_particle)),
        ("float64_distance", number(choice.float64_distance)),
        ("float64_steps", stretch.map_or_else(String::new, |stretch| stretch.steps.to_string())),
        ("float64_distance_after", number(stretch.map(|stretch| stretch.distance))),
    ];
    row.extend(of_run.map(|(name, cell)| (name.to_owned(), cell)));
    row.extend(summary.arguments.seeds.map(|seeds| ("seeds".to_owned(), seeds.to_string())));
    for measure in &summary.measures {
        let (value, error) = (choice.value(measure), choice.error(measure));
        let of_measure = [
            ("", number(value.map(|value| value.value))),
            ("_standard_error", number(value.and_then(|value| value.standard_error))),
            ("_reference", number(summary.reference(measure).map(|reference| reference.value))),
            ("_error", number(error.map(|error| error.error))),
            ("_error_uncertainty", number(error.and_then(|error| error.uncertainty))),
            ("_on_front", error.map_or_else(String::new, |error| u8::from(error.on_front).to_string())),
        ];
        let of_scheme = is_known_of_schemes(summary, measure)
            .then(|| ("_error_of_scheme", number(error.and_then(|error| error.of_scheme))));
        row.extend(of_measure.into_iter().chain(of_scheme).map(|(end, cell)| (format!("{measure}{end}"), cell)));
    }
    if !summary.arguments.targets.is_empty() {
        row.push(("verdict".to_owned(), choice.verdict.map(|verdict| verdict.to_string()).unwrap_or_default()));
    }
    row
}
