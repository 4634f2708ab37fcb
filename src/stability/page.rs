//! The page of a map, in words: how far a scene may go, and where laws and measurement part.

use super::bounds::Bound;
use super::cell::{Cell, listed};
use super::request::Request;
use super::summary::{Edge, Row, StabilitySummary};
use super::verdict::Verdict;
use crate::numbers::{short, three_digits};
use crate::study::by_key;
use crate::study::table::markdown;
use crate::tradeoff;
use std::collections::BTreeSet;

/// A law and a measured edge are said to part if they differ by more than this factor.
const APART: f64 = 1.25;

/// Up to where a row is right, in words.
fn right_in_words(row: &Row) -> String {
    let Some((first, last, is_bounded)) = row.right() else { return "nowhere".to_owned() };
    let from = row.cells.first().is_some_and(|cell| cell.value < first);
    let from = if from { format!("{} to ", three_digits(first)) } else { String::new() };
    let largest = if is_bounded { "" } else { ", the largest tried" };
    format!("{from}{}{largest}", three_digits(last))
}

/// From where on a row is unstable, in words.
fn unstable_in_words(row: &Row) -> String {
    match row.unstable_from() {
        None => "not seen".to_owned(),
        Some((None, high)) => format!("{} or less", three_digits(high)),
        Some((Some(_), high)) => three_digits(high),
    }
}

/// What laws say of a row, in words.
fn bounds_in_words(row: &Row) -> String {
    let at = |bound: &Bound| format!("{} at {}", bound.law, three_digits(bound.at));
    let outside = row.outside.iter().map(|bound| format!("{}, {} the range", at(bound), side(row, bound)));
    let words: Vec<String> = row.bounds.iter().map(at).chain(outside).collect();
    if words.is_empty() { "none".to_owned() } else { words.join("; ") }
}

/// On which side of a row a bound lies that is not in it.
fn side(row: &Row, bound: &Bound) -> &'static str {
    if row.cells.last().is_some_and(|cell| cell.value < bound.at) { "beyond" } else { "below" }
}

/// The least and the largest of some numbers, or one where they are alike.
fn least_to_most(numbers: &[f64]) -> String {
    let [least, most] =
        [f64::min, f64::max].map(|of| three_digits(numbers.iter().copied().reduce(of).unwrap_or(f64::NAN)));
    if least == most { least } else { format!("{least} to {most}") }
}

/// The laws that bound no row within its range, and where they do.
pub(super) fn laws_outside(summary: &StabilitySummary) -> Vec<String> {
    let inside = |law: &str| summary.rows.iter().flat_map(|row| &row.bounds).any(|bound| bound.law == law);
    let outside = summary.rows.iter().flat_map(|row| row.outside.iter().map(move |bound| (row, bound)));
    let outside = outside.filter(|(_, bound)| !inside(&bound.law));
    let found = by_key(outside.map(|(row, bound)| ((bound.law.as_str(), side(row, bound)), bound.at)));
    let words = |((law, side), places): ((&str, &str), Vec<f64>)| {
        format!("law {law} at {}, {side} the range", least_to_most(&places))
    };
    found.into_iter().map(words).collect()
}

/// Where laws and measurement part, law by law: the first law of stability and the first unstable runs, the first law of all and the first biased
/// ones: a law of accuracy says nothing where runs end before it.
fn differences(summary: &StabilitySummary) -> Vec<String> {
    let mut found = Vec::new();
    for row in &summary.rows {
        let laws = || row.bounds.iter().chain(&row.outside);
        let by_place = |a: &&Bound, b: &&Bound| a.at.total_cmp(&b.at);
        let of_stability = laws().filter(|bound| bound.is_of_stability).min_by(by_place);
        let middle = |low: f64, high: f64| summary.spacing.middle(low, high);
        let unstable = row.unstable_from().and_then(|(low, high)| Some(middle(low?, high)));
        // What is biased beyond a law, and right before.
        let bias = |edge: &Edge| (edge.below, edge.above) == (Verdict::Right, Verdict::Biased);
        let biased = row.edges().into_iter().find(bias).map(|edge| middle(edge.low, edge.high));
        for (bound, kind, edge) in [(of_stability, "unstable", unstable), (laws().min_by(by_place), "biased", biased)] {
            let Some((bound, edge)) = bound.zip(edge) else { continue };
            let ratio = edge / bound.at;
            if !(1.0 / APART..=APART).contains(&ratio) {
                found.push(((bound.law.as_str(), bound.is_of_stability, kind), ratio));
            }
        }
    }
    let words = |((law, is_of_stability, kind), ratios): ((&str, bool, &str), Vec<f64>)| {
        let rows = if ratios.len() == 1 { "runs".to_owned() } else { format!("in {} rows runs", ratios.len()) };
        let place = least_to_most(&ratios);
        let says = if is_of_stability && kind == "biased" { ", the edge of stability," } else { "" };
        format!("{rows} become {kind} at {place} times what the law {law}{says} says")
    };
    by_key(found).into_iter().map(words).collect()
}

/// Rows whose runs are the same, digit by digit: what tells these rows apart makes no difference.
fn same_rows(summary: &StabilitySummary) -> Vec<String> {
    let has_numbers =
        |row: &&Row| row.cells.iter().flat_map(|cell| &cell.errors).any(|error| error.uncertainty != Some(0.0));
    let rows = summary.rows.iter().filter(has_numbers);
    let alike = by_key(rows.map(|row| (&row.cells, row.label.as_str())));
    let several = alike.into_iter().map(|(_, labels)| labels).filter(|labels| labels.len() > 1);
    let in_words = |labels: Vec<&str>| {
        let labels = labels.join(" and ");
        format!("{labels} are the same runs, digit by digit: what tells these rows apart makes no difference")
    };
    several.map(in_words).collect()
}

/// The page.
pub(super) fn page(summary: &StabilitySummary, request: &Request) -> String {
    let keys = request.short_keys();
    let key = keys.short(&summary.key);
    let meaning = if summary.compares_nothing() {
        "Nothing is compared, so that nobody knows whether what ran to its end is right.".to_owned()
    } else {
        format!(
            "Right means that {} are within {} %.",
            listed(&summary.measures),
            short(100.0 * summary.arguments.tolerance)
        )
    };
    let begun = summary.adapter.as_ref().map(|adapter| {
        let (date, version) = (&summary.date, &summary.mesoscope_version);
        format!(" {date}, {} ({}), version {version}.", adapter.name, adapter.driver)
    });
    let seeds = summary.arguments.seeds;
    let averaged = seeds.map(|seeds| format!(" Means are over {seeds} seeds, with errors from their scatter."));
    let right = summary.right_in_a_word();
    let header = ["row".to_owned(), format!("{right}: {key} up to"), "unstable from".to_owned(), "laws".to_owned()];
    let title = format!("# {}: how far it may go", request.base.title);
    let [averaged, begun] = [averaged, begun].map(Option::unwrap_or_default);
    let varied = format!("`{}` is varied. {meaning}{averaged}{begun}", summary.key);
    let table = markdown([header].into_iter().chain(summary.in_words()).map(Vec::from), "---");
    let findings: Vec<String> = summary.findings().iter().map(|finding| format!("- {finding}")).collect();
    let paragraphs = [title, varied, table, findings.join("\n")].into_iter().filter(|text| !text.is_empty());
    paragraphs.collect::<Vec<_>>().join("\n\n") + "\n"
}

impl StabilitySummary {
    /// The result of a row in words: its label, up to where it is right, and from where on it is unstable.
    #[must_use]
    pub fn in_words(&self) -> Vec<[String; 4]> {
        let words = |row: &Row| {
            let label = if row.label.is_empty() { "the scene".to_owned() } else { row.label.clone() };
            [label, right_in_words(row), unstable_in_words(row), bounds_in_words(row)]
        };
        self.rows.iter().map(words).collect()
    }

    /// What the best of runs are called: right, or only run to the end where nothing is compared.
    #[must_use]
    pub fn right_in_a_word(&self) -> &'static str {
        if self.compares_nothing() { "ran to its end" } else { "right" }
    }

    /// The meaning of the mark of errors from few samples, where there are any.
    #[must_use]
    pub fn legend(&self) -> Option<String> {
        tradeoff::legend_of(self.rows.iter().flat_map(|row| &row.cells).flat_map(|cell| &cell.errors))
    }

    /// What else was found, line by line.
    #[must_use]
    pub fn findings(&self) -> Vec<String> {
        let cells = || self.rows.iter().flat_map(|row| &row.cells);
        let count = |counts: &dyn Fn(&Cell) -> bool| cells().filter(|cell| counts(cell)).count();
        let (runs, is_compared) = (cells().count(), |cell: &Cell| cell.is_compared(&self.measures));
        let lawless = |cell: &Cell| cell.undefined.is_empty() && cell.verdict == Verdict::Right && !is_compared(cell);
        let is_open = |cell: &Cell| is_compared(cell) && cell.unequilibrated.is_empty() && !cell.is_certain;
        let undefined = listed(cells().flat_map(|cell| &cell.undefined).collect::<BTreeSet<_>>());
        let counted = [
            (
                count(&lawless),
                "runs count as right though no law says what some of their measures should be, as that of a temperature without friction".to_owned(),
            ),
            (
                count(&|cell| !cell.undefined.is_empty()),
                format!("of {runs} runs have so few particles that they have no {undefined}, which cannot be compared: of these it is known where runs end, and no more"),
            ),
            (
                count(&|cell| !self.measures.is_empty() && is_open(cell)),
                format!("of {runs} verdicts are within two standard errors of the tolerance: longer runs (--set time.steps=N) decide them"),
            ),
            (
                count(&|cell| !cell.unequilibrated.is_empty()),
                format!("of {runs} runs are still on their way to equilibrium, which their errors include: give them time with --set time.equilibration=N"),
            ),
        ];
        let mut lines = [differences(self), same_rows(self)].concat();
        lines.extend(counted.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
        let refused = cells().filter(|cell| cell.verdict == Verdict::Refused);
        let reasons = by_key(refused.filter_map(|cell| Some((cell.reason_in_a_line()?, cell))));
        lines.extend(reasons.into_iter().map(|(reason, cells)| format!("{} refused: {reason}", cells.len())));
        if self.measures.is_empty() {
            lines.push("nothing is compared, as no law says what this scene measures: whether what ran to its end is right is not known; --reference MEASURE=VALUE gives a value".to_owned());
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::study::Record as _;

    /// A row that is biased from .04 and unstable from .09.
    fn findings_with(laws: &[(&str, bool, f64)]) -> Vec<String> {
        let request = Request::load("dpd-fluid", &[], None, &["time.step=0.02..0.1/3".to_owned()]).unwrap();
        let mut summary = StabilitySummary::before(&request);
        for (value, verdict) in [(0.03, Verdict::Right), (0.05, Verdict::Biased), (0.1, Verdict::Unstable)] {
            summary.rows[0].add(Cell { verdict, ..Cell::refused(value, String::new()) });
        }
        let law = |(law, is_of_stability, at): &(&str, bool, f64)| Bound {
            law: (*law).to_owned(),
            is_of_stability: *is_of_stability,
            at: *at,
        };
        (summary.rows[0].bounds, summary.rows[0].outside) = (laws.iter().map(law).collect(), Vec::new());
        differences(&summary)
    }

    /// A law of accuracy whose bound lies beyond that of stability is none of what acts.
    #[test]
    fn bias_is_put_beside_the_first_law() {
        let stability = ("B + W = 4", true, 0.08);
        assert_eq!(
            findings_with(&[stability, ("friction", false, 0.3)]),
            ["runs become biased at 0.484 times what the law B + W = 4, the edge of stability, says"]
        );
        assert_eq!(
            findings_with(&[("friction", false, 0.02), stability]),
            ["runs become biased at 1.94 times what the law friction says"]
        );
    }
}
