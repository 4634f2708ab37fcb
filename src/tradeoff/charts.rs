//! The picture of a measure: error against cost, with the Pareto front.

use super::deviation::Deviation;
use super::request::Request;
use super::summary::TradeoffSummary;
use crate::plot::{Axis, Chart, Panel, Series, SeriesInk};
use crate::study::{Setting, ShortKeys, by_key, numbers, readable};

/// A choice in the picture.
struct Point<'a> {
    error: &'a Deviation,
    place: [f64; 2],
    bar: f64,
    /// What the choices of a colour have in common: they differ in one key of numbers alone.
    group: String,
    /// What tells a choice from others of its colour.
    label: String,
}

/// The chart of a measure; none where no choice has both a cost and an error.
pub(super) fn chart(summary: &TradeoffSummary, request: &Request, measure: &str) -> Option<Chart> {
    let reference = summary.reference(measure)?;
    let relative = !reference.is_zero();
    let is_part = summary.choices.iter().find_map(|choice| choice.error(measure)).is_some_and(Deviation::is_part);
    let scale = if is_part { 100.0 } else { 1.0 };
    let sweep = &request.sweep;
    let short = ShortKeys::of(&sweep.keys());
    let varied = sweep.variations().iter().filter(|varied| numbers(&varied.values).is_some());
    let labelled = varied.max_by_key(|varied| varied.values.len()).map(|varied| varied.key.as_str());
    let points = summary.choices.iter().filter_map(|choice| {
        let (error, cost) = (choice.error(measure)?, choice.cost?);
        let place = [cost.seconds_per_time, scale * error.on_log_axis()?];
        let is_label = |setting: &&Setting| Some(setting.key.as_str()) == labelled;
        let (own, common): (Vec<_>, Vec<_>) = choice.settings.iter().partition(is_label);
        let [label, group] = [own, common].map(|settings| in_words(&settings, &short));
        Some(Point { error, place, bar: scale * error.uncertainty.unwrap_or(0.0), group, label })
    });
    let points: Vec<Point<'_>> = points.collect();
    if points.is_empty() {
        return None;
    }
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
    for (group, mut own) in by_key(points.iter().map(|point| (point.group.as_str(), point))) {
        own.retain(|point| point.error.on_front);
        if !own.is_empty() {
            panel.series.push(series(group, &own));
        }
    }
    if !dominated.is_empty() {
        let whole = |Point { group, label, .. }: &&Point<'_>| {
            [group.as_str(), label].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(", ")
        };
        let labels = dominated.iter().map(whole).collect();
        panel.series.push(Series { labels, ink: SeriesInk::Faint, ..series("dominated", &dominated) });
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

fn series(name: &str, points: &[&Point<'_>]) -> Series {
    let labels = points.iter().map(|point| point.label.clone()).collect();
    let few = points.iter().map(|point| point.error.from_few_samples).collect();
    let series = Series::markers(name, points.iter().map(|point| point.place).collect());
    Series { few, labels, ..series.with_errors(points.iter().map(|point| point.bar).collect()) }
}

/// Settings of a choice in words.
fn in_words(settings: &[&Setting], short: &ShortKeys) -> String {
    let words = settings.iter().map(|Setting { key, value }| {
        // A word says what it is of by itself.
        let is_named = value.is_string() || value.is_object();
        if is_named { readable(value) } else { format!("{} {}", short.short(key), readable(value)) }
    });
    words.collect::<Vec<_>>().join(", ")
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
