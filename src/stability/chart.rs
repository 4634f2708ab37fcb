//! The picture of a map: verdicts over the two keys, with edges and bounds; of a single row whose errors are known, those over its key.

use super::range::Spacing;
use super::request::Request;
use super::summary::{Row, StabilitySummary};
use super::verdict::Verdict;
use crate::numbers::short;
use crate::plot::{Axis, Chart, Panel, Series, SeriesInk, SeriesStyle};
use crate::study::{each_once, parameter_label, readable};

fn axis(label: &str, spacing: Spacing) -> Axis {
    match spacing {
        Spacing::Log => Axis::log(label),
        Spacing::Linear => Axis::linear(label),
    }
}

/// What an axis calls a key.
fn name_of(key: &str, request: &Request) -> String {
    parameter_label(key, key, &request.base)
}

/// The chart of a map.
pub(super) fn chart(summary: &StabilitySummary, request: &Request) -> Chart {
    let percent = format!("{} %", short(100.0 * summary.arguments.tolerance));
    let measures: Vec<String> = summary.measures.iter().map(|measure| measure.replace('_', " ")).collect();
    let subtitle = if summary.compares_nothing() {
        "nothing is compared".to_owned()
    } else {
        format!("right: {} within {percent}", measures.join(", "))
    };
    // What is not in the picture is in words.
    let subtitle = [subtitle].into_iter().chain(super::page::laws_outside(summary)).collect::<Vec<_>>().join("; ");
    let has_errors = summary.rows.iter().flat_map(|row| &row.cells).any(|cell| !cell.errors.is_empty());
    let is_curve = summary.rows.len() == 1 && has_errors;
    let panel = if is_curve { of_a_row(summary, request) } else { of_rows(summary, request, &percent) };
    Chart { title: format!("{}: stability", request.base.title), subtitle, panels: vec![panel] }
}

/// Verdicts, edges and bounds of all rows.
fn of_rows(summary: &StabilitySummary, request: &Request, percent: &str) -> Panel {
    let key = &name_of(request.row_key().unwrap_or_default(), request);
    let numbers = request.rows.as_ref().and_then(|rows| Some((rows.numbers()?, rows.spacing)));
    let value = |row: &Row| row.setting.as_ref().map(|setting| readable(&setting.value));
    let name = |row: &Row| value(row).unwrap_or_else(|| "the scene".to_owned());
    let named = || Axis::categories(key, summary.rows.iter().map(name).collect());
    let y = numbers.as_ref().map_or_else(named, |(_, spacing)| axis(key, *spacing));
    let height = |row: usize| numbers.as_ref().map_or(row as f64, |(numbers, _)| numbers[row]);
    let rows = || summary.rows.iter().enumerate();
    let mut panel = Panel { x: axis(&name_of(&summary.key, request), summary.spacing), y, ..Panel::default() };
    // Lines go from row to row; where a row has none they end.
    let line = |name: &str, place: &dyn Fn(&Row) -> Option<f64>, pattern: usize| {
        let points: Vec<[f64; 2]> =
            rows().map(|(row, found)| [place(found).unwrap_or(f64::NAN), height(row)]).collect();
        let alone = points.iter().filter(|[place, _]| place.is_finite()).count() < 2;
        let style = if alone { SeriesStyle::LineMarkers } else { SeriesStyle::Line };
        Series { style, ..Series::line(name, points) }.with_ink(SeriesInk::Ink { pattern })
    };
    let bounds = summary.rows.iter().flat_map(|row| &row.bounds);
    for (number, law) in each_once(bounds.map(|bound| &bound.law)).into_iter().enumerate() {
        let bound = |row: &Row| row.bounds.iter().find(|bound| bound.law == *law).map(|bound| bound.at);
        panel.series.push(line(&format!("law: {law}"), &bound, number));
    }
    let last_right = |row: &Row| row.right().filter(|(_, _, others)| *others).map(|(_, last, _)| last);
    let first_unstable = |row: &Row| row.unstable_from().map(|(_, first)| first);
    for (name, place, verdict) in [
        ("edge: right up to", &last_right as &dyn Fn(&Row) -> Option<f64>, Verdict::Right),
        ("edge: unstable from", &first_unstable, Verdict::Unstable),
    ] {
        let is_there = verdict != Verdict::Right || !summary.compares_nothing();
        // A single row has its edges where its verdicts change.
        if is_there && summary.rows.iter().filter_map(place).count() > 1 {
            panel.series.push(line(name, place, 0).with_ink(SeriesInk::Numbered(verdict as usize)));
        }
    }
    for verdict in Verdict::ALL {
        let cells = rows().flat_map(|(row, found)| found.cells.iter().map(move |cell| (row, cell)));
        let own = cells.filter(|(_, cell)| cell.verdict == verdict);
        let points: Vec<[f64; 2]> = own.map(|(row, cell)| [cell.value, height(row)]).collect();
        if points.is_empty() {
            continue;
        }
        let name = match verdict {
            Verdict::Right if !summary.compares_nothing() => format!("right within {percent}"),
            Verdict::Right => summary.right_in_a_word().to_owned(),
            other => other.to_string(),
        };
        panel.series.push(Series::markers(&name, points).with_ink(SeriesInk::Numbered(verdict as usize)));
    }
    panel
}

/// Errors over the key, the tolerance, and where runs end.
fn of_a_row(summary: &StabilitySummary, request: &Request) -> Panel {
    let x = axis(&name_of(&summary.key, request), summary.spacing);
    let mut panel = Panel { x, y: Axis::log("Error (%)"), ..Panel::default() };
    let Some(row) = summary.rows.first() else { return panel };
    let tolerance = 100.0 * summary.arguments.tolerance;
    let mut ends = [tolerance, tolerance];
    for measure in &summary.measures {
        let of_cell = |cell: &super::Cell| {
            let error = cell.error(measure)?;
            Some(([cell.value, 100.0 * error.on_log_axis()?], 100.0 * error.uncertainty.unwrap_or(0.0)))
        };
        let (points, bars): (Vec<[f64; 2]>, Vec<f64>) = row.cells.iter().filter_map(of_cell).unzip();
        for [_, size] in &points {
            ends = [ends[0].min(*size), ends[1].max(*size)];
        }
        let series = Series { style: SeriesStyle::LineMarkers, ..Series::line(&measure.replace('_', " "), points) };
        panel.series.push(series.with_errors(bars));
    }
    let lost: Vec<[f64; 2]> =
        row.cells.iter().filter(|cell| cell.verdict >= Verdict::Unstable).map(|cell| [cell.value, ends[1]]).collect();
    if !lost.is_empty() {
        panel.series.push(Series::markers("unstable", lost));
    }
    let vertical = |name: &str, at: f64, pattern: usize| {
        Series::line(name, ends.map(|end| [at, end]).to_vec()).with_ink(SeriesInk::Ink { pattern })
    };
    for (number, bound) in row.bounds.iter().enumerate() {
        panel.series.push(vertical(&format!("law: {}", bound.law), bound.at, number + 1));
    }
    if let Some((_, first)) = row.unstable_from() {
        panel.series.push(vertical("first unstable", first, 0));
    }
    panel.with_reference("tolerance", tolerance)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::cell::Cell;
    use super::super::{Bound, Request};
    use super::*;
    use crate::study::Record as _;

    #[test]
    fn the_line_of_the_first_unstable_run_is_where_that_run_is() {
        let request = Request::load("dpd-fluid", &[], None, &["time.step=0.1..0.4/3".to_owned()]).unwrap();
        let mut summary = StabilitySummary::before(&request);
        for (value, verdict) in [(0.1, Verdict::Right), (0.2, Verdict::Biased), (0.4, Verdict::Unstable)] {
            summary.rows[0].add(Cell { verdict, ..Cell::refused(value, String::new()) });
        }
        let law = |law: &str, at: f64| Bound { law: law.to_owned(), is_of_stability: true, at };
        summary.rows[0].outside = vec![law("low", 0.05), law("high", 0.8)];
        let panel = of_a_row(&summary, &request);
        let line = panel.series.iter().find(|series| series.name == "first unstable").unwrap();
        assert!(line.points.iter().all(|[value, _]| *value == 0.4), "{line:?}");
        // Laws outside of the picture are in its words.
        let subtitle = chart(&summary, &request).subtitle;
        assert!(
            subtitle.ends_with("; law low at 0.05, below the range; law high at 0.8, beyond the range"),
            "{subtitle}"
        );
    }
}
