//! The picture of a measure: error against cost, with the Pareto front.

use super::deviation::Deviation;
use super::request::Request;
use super::summary::{Choice, TradeoffSummary};
use crate::plot::{Axis, Chart, Panel, Series, SeriesInk};
use crate::study::{Setting, ShortKeys, each_once, numbers, readable};

/// A choice in the picture.
struct Point<'a> {
    choice: &'a Choice,
    error: &'a Deviation,
    place: [f64; 2],
    bar: f64,
}

/// The chart of a measure; none where no choice has both a cost and an error.
pub(super) fn chart(summary: &TradeoffSummary, request: &Request, measure: &str) -> Option<Chart> {
    let reference = summary.reference(measure)?;
    let relative = !reference.is_zero();
    let is_part = summary.choices.iter().find_map(|choice| choice.error(measure)).is_some_and(Deviation::is_part);
    let scale = if is_part { 100.0 } else { 1.0 };
    let points = summary.choices.iter().filter_map(|choice| {
        let (error, cost) = (choice.error(measure)?, choice.cost?);
        let place = [cost.seconds_per_time, scale * error.on_log_axis()?];
        Some(Point { choice, error, place, bar: scale * error.uncertainty.unwrap_or(0.0) })
    });
    let points: Vec<Point<'_>> = points.collect();
    if points.is_empty() {
        return None;
    }
    let groups = Groups::of(request);
    let what = measure.replace('_', " ");
    let unit = if is_part { " (%)" } else { "" };
    let mut panel = Panel {
        x: Axis::log("Time to compute a time unit (s)"),
        y: Axis::log(&format!("Error of {what}{unit}")),
        ..Panel::default()
    };
    let (on_front, dominated): (Vec<_>, Vec<_>) = points.iter().partition(|point| point.error.on_front);
    let mut front: Vec<[f64; 2]> = on_front.iter().map(|point| point.place).collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for name in each_once(points.iter().map(|point| groups.name(point.choice))) {
        let own = on_front.iter().copied().filter(|point| groups.name(point.choice) == name);
        let own: Vec<&Point<'_>> = own.collect();
        if !own.is_empty() {
            panel.series.push(series(&name, &own, &groups));
        }
    }
    if !dominated.is_empty() {
        let whole = |point: &Point<'_>| {
            let (group, label) = (groups.name(point.choice), groups.label(point.choice));
            [group, label].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(", ")
        };
        let labels = dominated.iter().map(|point| whole(point)).collect();
        let series = series("dominated", &dominated, &groups).with_ink(SeriesInk::Faint);
        panel.series.push(series.with_labels(labels));
    }
    panel.series.push(Series::compared("Pareto front", front));
    let of_this = |target: &&super::Target| target.measure == measure && !target.is_part_of_nothing(relative);
    if let Some(target) = summary.arguments.targets.iter().find(of_this) {
        panel = panel.with_reference("target", scale * target.most(reference.value, relative));
    }
    let few = points.iter().any(|point| point.error.from_few_samples);
    let bars = match (points.iter().any(|point| point.bar > 0.0), few) {
        (true, true) => ", bars: standard errors, of few samples (hollow) three times",
        (true, false) => ", bars: standard errors",
        (false, _) => "",
    };
    let subtitle = format!("{}{bars}", super::advice::reference_in_words(summary, measure));
    Some(Chart { title: format!("{}: {what}", request.base.title), subtitle, panels: vec![panel] })
}

fn series(name: &str, points: &[&Point<'_>], groups: &Groups<'_>) -> Series {
    let labels = points.iter().map(|point| groups.label(point.choice)).collect();
    let series = Series::markers(name, points.iter().map(|point| point.place).collect()).with_labels(labels);
    let few = points.iter().map(|point| point.error.from_few_samples).collect();
    series.with_errors(points.iter().map(|point| point.bar).collect()).with_few(few)
}

/// Choices that differ in one key of numbers alone are of one colour, and labelled by their numbers.
struct Groups<'a> {
    short: ShortKeys,
    /// The key whose values are the labels.
    labelled: Option<&'a str>,
}

impl<'a> Groups<'a> {
    fn of(request: &'a Request) -> Self {
        let sweep = request.sweep();
        let short = ShortKeys::of(&sweep.keys());
        let varied = sweep.variations().iter().filter(|varied| numbers(&varied.values).is_some());
        let labelled = varied.max_by_key(|varied| varied.values.len()).map(|varied| varied.key.as_str());
        Self { short, labelled }
    }

    fn in_words(&self, settings: &[Setting], wanted: impl Fn(&str) -> bool) -> String {
        let own = settings.iter().filter(|setting| wanted(&setting.key));
        let words = own.map(|setting| {
            let key = self.short.short(&setting.key);
            let value = readable(&setting.value);
            // A word says what it is of by itself.
            if setting.value.is_string() || setting.value.is_object() { value } else { format!("{key} {value}") }
        });
        words.collect::<Vec<_>>().join(", ")
    }

    /// What the choices of a colour have in common.
    fn name(&self, choice: &Choice) -> String {
        self.in_words(&choice.settings, |key| Some(key) != self.labelled)
    }

    /// What tells a choice from others of its colour.
    fn label(&self, choice: &Choice) -> String {
        self.in_words(&choice.settings, |key| Some(key) == self.labelled)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::made_up;
    use super::*;
    use crate::plot::{Scale, SeriesStyle};

    #[test]
    fn a_picture_has_the_front_the_rest_in_grey_the_target_and_error_bars() {
        // Errors of 1, 2, 5 and 10 %: the third costs more than the second.
        let made_up = [(8.0, 20.2, 0.02), (4.0, 19.6, 0.02), (5.0, 21.0, 0.04), (1.0, 22.0, 0.02)].map(Some);
        let (request, summary) =
            made_up::summary(&["time.step=0.01,0.02", "integrator.type=splitting,groot-warren"], "3%", &made_up);
        let chart = chart(&summary, &request, made_up::MEASURE).unwrap();
        assert_eq!(chart.panels.len(), 1, "{chart:?}");
        let panel = &chart.panels[0];
        assert_eq!((panel.x.scale, panel.y.scale), (Scale::Log, Scale::Log));
        assert!(panel.y.label == "Error of pressure (%)" && panel.x.label.ends_with("(s)"), "{panel:?}");
        let series = |name: &str| panel.series.iter().find(|series| series.name == name).unwrap();
        let places = |found: &Series| -> Vec<[f64; 2]> {
            found.points.iter().map(|point| point.map(|number| (1e6 * number).round() / 1e6)).collect()
        };
        assert_eq!(places(series("Pareto front")), [[1.0, 10.0], [4.0, 2.0], [8.0, 1.0]]);
        let grey = series("dominated");
        assert_eq!((places(grey), grey.ink), (vec![[5.0, 5.0]], SeriesInk::Faint));
        assert_eq!(grey.labels, ["splitting, step 0.02"]);
        // What is on the front is in the colour of its integrator, with the step beside it.
        assert_eq!(
            (places(series("splitting")), &series("splitting").labels[..]),
            (vec![[8.0, 1.0]], &["step 0.01".to_owned()][..])
        );
        assert_eq!(places(series("groot-warren")), [[4.0, 2.0], [1.0, 10.0]]);
        let bars = grey.errors.as_ref().unwrap();
        assert!((bars[0] - 0.2).abs() < 1e-12 && grey.style == SeriesStyle::Markers, "{grey:?}");
        assert_eq!(panel.references.len(), 1, "{panel:?}");
        let target = &panel.references[0];
        assert!(target.label == "target" && (target.value - 3.0).abs() < 1e-12, "{target:?}");
        assert!(chart.subtitle.ends_with("which was given, bars: standard errors"), "{}", chart.subtitle);
    }
}
