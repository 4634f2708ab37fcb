//! The table of a tradeoff, `tradeoff.csv`: a row for every choice.

use super::summary::{Choice, TradeoffSummary};
use super::target::Verdict;
use crate::study::table::{line, number, plain};

pub(super) fn text(summary: &TradeoffSummary, keys: &[&str]) -> String {
    let mut header: Vec<String> = ["choice"].into_iter().chain(keys.iter().copied()).map(str::to_owned).collect();
    let further = "state,steps,seconds_per_time,seconds_per_time_fastest,seconds_per_time_slowest,\
                   particle_steps_per_second,bytes_per_particle,float64_distance,float64_steps,float64_distance_after";
    header.extend(further.split(',').map(str::to_owned));
    for measure in &summary.measures {
        let columns = ["", "_standard_error", "_reference", "_error", "_error_uncertainty", "_on_front"];
        header.extend(columns.map(|end| format!("{measure}{end}")));
        header.extend(is_known_of_schemes(summary, measure).then(|| format!("{measure}_error_of_scheme")));
    }
    if !summary.arguments.targets.is_empty() {
        header.push("verdict".to_owned());
    }
    let mut text = line(&header);
    for choice in &summary.choices {
        text.push_str(&line(&row(summary, choice, keys)));
    }
    text
}

/// Whether the error of any scheme by itself is known.
fn is_known_of_schemes(summary: &TradeoffSummary, measure: &str) -> bool {
    summary.choices.iter().any(|choice| choice.error(measure).is_some_and(|error| error.of_scheme.is_some()))
}

fn row(summary: &TradeoffSummary, choice: &Choice, keys: &[&str]) -> Vec<String> {
    let setting = |key: &&str| {
        let found = choice.settings.iter().find(|setting| setting.key == *key)?;
        Some(plain(&found.value))
    };
    let mut cells = vec![choice.name.clone()];
    cells.extend(keys.iter().map(|key| setting(key).unwrap_or_default()));
    cells.extend([choice.state.name().to_owned(), choice.steps.to_string()]);
    let cost = choice.cost.map(|cost| {
        let times = [cost.seconds_per_time, cost.fastest, cost.slowest];
        [times[0], times[1], times[2], cost.particle_steps_per_second, cost.bytes_per_particle]
    });
    cells.extend((0..5).map(|index| number(cost.map(|cost| cost[index]))));
    cells.push(number(choice.float64_distance));
    cells.push(choice.float64_stretch.map_or_else(String::new, |stretch| stretch.steps.to_string()));
    cells.push(number(choice.float64_stretch.map(|stretch| stretch.distance)));
    for measure in &summary.measures {
        let (value, error) = (choice.value(measure), choice.error(measure));
        cells.push(number(value.map(|value| value.value)));
        cells.push(number(value.and_then(|value| value.standard_error)));
        cells.push(number(summary.reference(measure).map(|reference| reference.value)));
        cells.push(number(error.map(|error| error.error)));
        cells.push(number(error.and_then(|error| error.uncertainty)));
        cells.push(error.map_or_else(String::new, |error| u8::from(error.on_front).to_string()));
        cells.extend(is_known_of_schemes(summary, measure).then(|| number(error.and_then(|error| error.of_scheme))));
    }
    if !summary.arguments.targets.is_empty() {
        let verdict = choice.verdict.map(Verdict::name);
        cells.push(verdict.unwrap_or_default().to_owned());
    }
    cells
}
