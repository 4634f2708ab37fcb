//! The table of a map, `stability.csv`: a row for every scene that was run.

use super::cell::Cell;
use super::summary::{Row, StabilitySummary};
use crate::study::table::{number, plain, rows};

pub(super) fn text(summary: &StabilitySummary) -> String {
    rows(summary.rows.iter().flat_map(|row| row.cells.iter().map(|cell| columns(summary, row, cell))))
}

/// Names of columns and cells.
fn columns(summary: &StabilitySummary, row: &Row, cell: &Cell) -> Vec<(String, String)> {
    let setting = row.setting.iter().map(|setting| (setting.key.clone(), plain(&setting.value)));
    let of_run = [
        (summary.key.as_str(), number(Some(cell.value))),
        ("verdict", cell.verdict.to_string()),
        ("certain", cell.is_certain.to_string()),
        ("steps", cell.steps.to_string()),
        ("time_step", number(cell.time_step)),
    ];
    let errors = summary.measures.iter().flat_map(|measure| {
        let error = cell.error(measure);
        let uncertainty = error.and_then(|error| error.uncertainty);
        [("_error", error.map(|error| error.error)), ("_error_uncertainty", uncertainty)]
            .map(|(end, value)| (format!("{measure}{end}"), number(value)))
    });
    let reason = cell.reason.clone().or_else(|| cell.lacks()).unwrap_or_default().replace('\n', "; ");
    let of_run = of_run.map(|(name, cell)| (name.to_owned(), cell));
    setting.chain(of_run).chain(errors).chain([("reason".to_owned(), reason)]).collect()
}
