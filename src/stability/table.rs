//! The table of a map, `stability.csv`: a row for every scene that was run.

use super::cell::Cell;
use super::summary::{Row, StabilitySummary};
use crate::study::table::{line, number, plain};

pub(super) fn text(summary: &StabilitySummary) -> String {
    let key = summary.rows.first().and_then(|row| row.setting.as_ref()).map(|setting| setting.key.clone());
    let mut header: Vec<String> = key.into_iter().chain([summary.key.clone()]).collect();
    header.extend(["verdict", "certain", "steps", "time_step"].map(str::to_owned));
    for measure in &summary.measures {
        header.extend(["_error", "_error_uncertainty"].map(|end| format!("{measure}{end}")));
    }
    header.push("reason".to_owned());
    let mut text = line(&header);
    for row in &summary.rows {
        for cell in &row.cells {
            text.push_str(&line(&cells(summary, row, cell)));
        }
    }
    text
}

fn cells(summary: &StabilitySummary, row: &Row, cell: &Cell) -> Vec<String> {
    let mut cells: Vec<String> = row.setting.iter().map(|setting| plain(&setting.value)).collect();
    cells.extend([
        number(Some(cell.value)),
        cell.verdict.name().to_owned(),
        cell.is_certain.to_string(),
        cell.steps.to_string(),
    ]);
    cells.push(number(cell.time_step));
    for measure in &summary.measures {
        let error = cell.error(measure);
        cells.push(number(error.map(|error| error.error)));
        cells.push(number(error.and_then(|error| error.uncertainty)));
    }
    let reason = cell.reason.clone().or_else(|| cell.lacks());
    cells.push(reason.unwrap_or_default().replace('\n', "; "));
    cells
}
