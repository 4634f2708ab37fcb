//! The summary of a map of stability, `stability.json`.

use super::bounds::Bound;
use super::cell::Cell;
use super::range::Spacing;
use super::request::{Arguments, Request};
use super::run::Bisecting;
use super::verdict::Verdict;
use super::{chart, files, page, table};
use crate::families::StepCheck;
use crate::output::summary::AdapterSummary;
use crate::output::{Id, RunDirectory};
use crate::scene::{PlotStyle, SceneError};
use crate::study::{self, ASKS_ELSE, Charts, Kind, Record, STABILITY, Setting, StudyError};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Edges of a row that are located.
pub(super) const MOST_EDGES: usize = 3;

/// What was asked, and what became of every scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StabilitySummary {
    /// Version of the program that began it.
    pub mesoscope_version: String,
    /// The day it was begun, as year, month and day.
    pub date: String,
    /// The id of the map, made of those of its scenes.
    pub stability_id: Id,
    /// The adapter it last computed on; none before it began.
    pub adapter: Option<AdapterSummary>,
    pub(super) arguments: Arguments,
    /// The key whose value increases along rows.
    pub key: String,
    /// How its values are spread.
    pub spacing: Spacing,
    /// Measures that are compared.
    pub measures: Vec<String>,
    /// Seconds that it took so far.
    pub spent: f64,
    /// The rows, in order.
    pub rows: Vec<Row>,
}

/// Scenes that differ in one number.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Row {
    /// What it is called; empty for a single row.
    pub label: String,
    /// What distinguishes it; none for a single row.
    pub setting: Option<Setting>,
    /// Its scenes so far, by their value.
    pub cells: Vec<Cell>,
    /// Where laws put its edges; none before the map is begun.
    pub bounds: Vec<Bound>,
    /// Where they put edges that lie outside of it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside: Vec<Bound>,
}

/// Where one verdict ends and another begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The verdict below.
    pub below: Verdict,
    /// The verdict above.
    pub above: Verdict,
    /// The largest value that has the verdict below.
    pub low: f64,
    /// The smallest value that has the verdict above.
    pub high: f64,
}

impl Row {
    /// Its edges, by their value.
    #[must_use]
    pub fn edges(&self) -> Vec<Edge> {
        let pairs = self.cells.iter().zip(self.cells.iter().skip(1));
        let differ = pairs.filter(|(low, high)| low.verdict != high.verdict);
        differ
            .map(|(low, high)| Edge { below: low.verdict, above: high.verdict, low: low.value, high: high.value })
            .collect()
    }

    /// The first scenes that are right and follow each other: the smallest and the largest value, and whether there are others above.
    #[must_use]
    pub fn right(&self) -> Option<(f64, f64, bool)> {
        let first = self.cells.iter().position(|cell| cell.verdict == Verdict::Right)?;
        let run = self.cells[first..].iter().take_while(|cell| cell.verdict == Verdict::Right).count();
        Some((self.cells[first].value, self.cells[first + run - 1].value, first + run < self.cells.len()))
    }

    /// Where the first scenes become unstable: the largest value before, and the value at which it is seen.
    pub(crate) fn unstable_from(&self) -> Option<(Option<f64>, f64)> {
        let first = self.cells.iter().position(|cell| cell.verdict == Verdict::Unstable)?;
        Some((first.checked_sub(1).map(|before| self.cells[before].value), self.cells[first].value))
    }

    /// Adds a scene in its place.
    pub(super) fn add(&mut self, cell: Cell) {
        let place = self.cells.partition_point(|known| known.value < cell.value);
        self.cells.insert(place, cell);
    }

    /// Values at which to look next: in the middle of edges that are not located to `nearest` yet.
    pub(super) fn next(&self, spacing: Spacing, nearest: f64) -> Vec<f64> {
        let edges = self.edges();
        let wide = edges.iter().filter(|edge| spacing.distance(edge.low, edge.high) > nearest);
        let middle = |edge: &Edge| super::range::rounded(spacing.middle(edge.low, edge.high));
        let new = |value: &f64| self.cells.iter().all(|cell| cell.value != *value);
        wide.take(MOST_EDGES).map(middle).filter(new).collect()
    }
}

impl StabilitySummary {
    /// Whether no run is compared with anything: no law says what should be, or there are too few particles for what it says.
    pub(crate) fn compares_nothing(&self) -> bool {
        let cells = || self.rows.iter().flat_map(|row| &row.cells);
        let is_all_undefined =
            cells().any(|cell| !cell.undefined.is_empty()) && cells().all(|cell| cell.errors.is_empty());
        self.measures.is_empty() || is_all_undefined
    }

    /// Reads the summary in the directory of a map.
    ///
    /// # Errors
    /// [`StudyError::Nothing`] when there is none, [`StudyError::Output`] when it cannot be read or is no summary.
    pub fn load(directory: &Path) -> Result<Self, StudyError> {
        study::load(directory)
    }
}

impl Record for StabilitySummary {
    type Request = Request;
    type Ended = Cell;
    type Phase = Bisecting;

    const KIND: &'static Kind = &STABILITY;

    fn before(request: &Request) -> Self {
        let row = |row| Row { label: request.row_label(row), setting: request.setting(row), ..Row::default() };
        Self {
            mesoscope_version: env!("CARGO_PKG_VERSION").to_owned(),
            date: jiff::Timestamp::now().strftime("%Y-%m-%d").to_string(),
            stability_id: request.id(),
            adapter: None,
            arguments: request.arguments.clone(),
            key: request.along.key.clone(),
            spacing: request.along.spacing,
            measures: request.measures(),
            spent: 0.0,
            rows: (0..request.row_count()).map(row).collect(),
        }
    }

    fn request(&self) -> Result<Request, StudyError> {
        Request::new(self.arguments.clone())
    }

    fn checks(&self, request: &Request) -> Vec<(bool, &'static str)> {
        vec![
            (!self.is_of_this_version() || self.stability_id == request.id(), ASKS_ELSE),
            (self.rows.len() == request.row_count(), "has other rows than those that it asks for"),
            (self.measures == request.measures(), "compares other measures than those that it asks for"),
        ]
    }

    fn version(&self) -> &str {
        &self.mesoscope_version
    }

    fn id(&self) -> Id {
        self.stability_id
    }

    fn tables(&self, _: &Request) -> Vec<(&'static str, String)> {
        vec![(files::TABLE, table::text(self))]
    }

    fn page(&self, request: &Request) -> Option<(&'static str, String)> {
        Some((files::PAGE, page::page(self, request)))
    }

    fn charts<'c>(&'c self, request: &'c Request, _: &RunDirectory) -> Result<Charts<'c>, StudyError> {
        Ok(Box::new([(files::PLOT.to_owned(), chart::chart(self, request))].into_iter()))
    }

    fn style(&self, request: &Request, overrides: &[String]) -> Result<PlotStyle, SceneError> {
        let Arguments { scene, state_files, .. } = &request.arguments;
        study::style(scene, &request.base, overrides, state_files, StepCheck::Allow)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(verdicts: &[(f64, Verdict)]) -> Row {
        let mut row = Row::default();
        for (value, verdict) in verdicts {
            row.add(Cell { verdict: *verdict, ..Cell::refused(*value, String::new()) });
        }
        row
    }

    #[test]
    fn edges_lie_between_neighbours_that_differ() {
        use Verdict::{Biased, Right, Unstable};
        let found = row(&[(4.0, Biased), (1.0, Right), (16.0, Unstable), (2.0, Right), (8.0, Biased)]);
        assert_eq!(
            found.edges(),
            [
                Edge { below: Right, above: Biased, low: 2.0, high: 4.0 },
                Edge { below: Biased, above: Unstable, low: 8.0, high: 16.0 }
            ]
        );
        assert_eq!(found.right(), Some((1.0, 2.0, true)));
        assert_eq!(found.unstable_from(), Some((Some(8.0), 16.0)));
        let factor_of_two = 2.0_f64.ln();
        assert_eq!(found.next(Spacing::Log, 0.9 * factor_of_two), [2.828, 11.31]);
        assert!(found.next(Spacing::Log, 1.1 * factor_of_two).is_empty());
        assert_eq!(found.next(Spacing::Linear, 3.0), [12.0]);
        assert_eq!(row(&[(1.0, Right)]).right(), Some((1.0, 1.0, false)));
        assert_eq!((row(&[(1.0, Biased)]).right(), row(&[(1.0, Unstable)]).unstable_from()), (None, Some((None, 1.0))));
    }
}
