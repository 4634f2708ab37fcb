//! Means against what is varied: one panel a quantity, with errors.

use super::averages::{Group, groups};
use super::look::Look;
use super::observables::Observable;
use super::summary::SweepSummary;
use crate::plot::{Axis, Chart, Panel, Series, SeriesStyle, UNEQUILIBRATED, quantity_label};
use crate::quantity::QUANTITIES;
use crate::study::{SEED, Setting, ShortKeys, Sweep, Variation, by_key, each_once, numbers, parameter_label, readable};
use serde_json::Value;

/// Panels of one picture.
const PANELS: usize = 4;

/// Columns of the table of energies that say something about the run rather than about the matter.
const LEFT_OUT: [&str; 3] = ["momentum_", "center_of_mass_velocity_", "particle"];

/// The charts of the means of all variants that are finished against the values of one varied key: the one with most
/// numbers, or else most values; every combination of the others is a curve, and further variants are lines to compare
/// with. No chart where less than two values are finished.
pub(super) fn charts(sweep: &Sweep, summary: &SweepSummary, look: &Look) -> Vec<Chart> {
    let Some(axis) = MeansAxis::of(sweep) else { return Vec::new() };
    let groups = groups(&summary.variants);
    let found: Vec<(&Group<'_>, Vec<Observable>)> =
        groups.iter().map(|group| (group, group.observables())).filter(|(_, found)| !found.is_empty()).collect();
    let panels: Vec<Panel> =
        quantities(&found, look).iter().filter_map(|quantity| axis.panel(quantity, &found)).collect();
    let title = sweep.variants().first().map_or("", |variant| variant.scene.title.as_str());
    let seeds = found.iter().map(|(group, _)| group.finished.len()).max().unwrap_or(0);
    let subtitle = if seeds > 1 {
        format!("means over {seeds} seeds, bars: standard errors from their scatter with Student's factor")
    } else {
        "means over time after equilibration, bars: standard errors".to_owned()
    };
    let few = panels.iter().flat_map(|panel| &panel.series).any(|series| series.few.contains(&true));
    let hollow = match (few, seeds > 1) {
        (true, true) => ", hollow: error from few seeds",
        (true, false) => ", hollow: error from few samples",
        (false, _) => "",
    };
    let marked = panels.iter().any(|panel| panel.y.label.ends_with(UNEQUILIBRATED));
    let mark = if marked { format!(", {UNEQUILIBRATED} some with the way to equilibrium") } else { String::new() };
    let subtitle = subtitle + hollow + &mark;
    let chart =
        |panels: &[Panel]| Chart { title: title.to_owned(), subtitle: subtitle.clone(), panels: panels.to_vec() };
    panels.chunks(PANELS).map(chart).collect()
}

/// The quantities to show: those asked for; else those with errors whose means differ.
fn quantities<'f>(found: &'f [(&Group<'_>, Vec<Observable>)], look: &Look) -> Vec<&'f str> {
    let is_wanted = |observable: &&Observable| {
        if look.quantities.is_empty() {
            observable.error.is_some() && LEFT_OUT.iter().all(|start| !observable.name.starts_with(start))
        } else {
            look.quantities.contains(&observable.name)
        }
    };
    let wanted = found.iter().flat_map(|(_, found)| found).filter(is_wanted);
    let mut names = each_once(wanted.map(|observable| observable.name.as_str()));
    names.retain(|name| {
        let mut values = found.iter().filter_map(|(_, found)| value_of(found, name)).map(|observable| observable.value);
        let first = values.next();
        !look.quantities.is_empty() || values.any(|value| Some(value) != first)
    });
    // A sort that keeps the order of results, which follow.
    names.sort_by_key(|name| QUANTITIES.iter().position(|known| known.name == *name).unwrap_or(QUANTITIES.len()));
    names
}

fn value_of<'a>(found: &'a [Observable], name: &str) -> Option<&'a Observable> {
    found.iter().find(|observable| observable.name == name && observable.value.is_finite())
}

/// The key along the horizontal axis.
struct MeansAxis<'a> {
    key: &'a str,
    axis: Axis,
    values: &'a [Value],
    /// Where each value lies.
    places: Vec<f64>,
}

impl<'a> MeansAxis<'a> {
    /// The axis of a sweep; none where nothing but the seed has two values.
    fn of(sweep: &'a Sweep) -> Option<Self> {
        let varied = || sweep.variations().iter().filter(|varied| varied.key != SEED && varied.values.len() > 1);
        let most = |varied: &&Variation| (numbers(&varied.values).is_some(), varied.values.len());
        // Of equals the first.
        let chosen = varied().rev().max_by_key(most)?;
        let short = ShortKeys::of(&[&chosen.key]);
        let label = &parameter_label(&chosen.key, short.short(&chosen.key), &sweep.variants().first()?.scene);
        let (axis, places) = if let Some(places) = numbers(&chosen.values) {
            (if is_geometric(&places) { Axis::log(label) } else { Axis::linear(label) }, places)
        } else {
            let places = (0..chosen.values.len()).map(|place| place as f64).collect();
            (Axis::categories(label, chosen.values.iter().map(readable).collect()), places)
        };
        Some(Self { key: &chosen.key, axis, values: &chosen.values, places })
    }

    fn place(&self, settings: &[Setting]) -> Option<f64> {
        let setting = settings.iter().find(|setting| setting.key == self.key)?;
        let place = self.values.iter().position(|value| *value == setting.value)?;
        self.places.get(place).copied()
    }

    fn panel(&self, quantity: &str, found: &[(&Group<'_>, Vec<Observable>)]) -> Option<Panel> {
        let last = quantity.rsplit('.').next().unwrap_or(quantity);
        let spoilt = found.iter().filter_map(|(_, found)| value_of(found, quantity)).any(|found| found.unequilibrated);
        let mark = if spoilt { format!(" {UNEQUILIBRATED}") } else { String::new() };
        let label = quantity_label(last, false) + &mark;
        let mut panel = Panel { x: self.axis.clone(), ..Panel::new("", &label) };
        // Points with their errors, curve by curve.
        let mut points = Vec::new();
        for (group, observables) in found {
            let Some(observable) = value_of(observables, quantity) else { continue };
            let mut others = group.settings.clone();
            others.retain(|setting| setting.key != self.key);
            let name = if others.is_empty() { String::new() } else { ShortKeys::of_settings(&others).label(&others) };
            let Some(place) = self.place(&group.settings) else {
                panel = panel.with_reference(&name, observable.value);
                continue;
            };
            let error = (observable.error.unwrap_or(f64::NAN), observable.from_few_samples);
            points.push((name, ([place, observable.value], error)));
        }
        let curves = by_key(points);
        let several = curves.len() + panel.references.len() > 1;
        for (name, mut points) in curves {
            points.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
            let (points, errors): (Vec<[f64; 2]>, Vec<(f64, bool)>) = points.into_iter().unzip();
            let (errors, few) = errors.into_iter().unzip();
            let name = match (several, name.is_empty()) {
                (false, _) => "",
                (true, true) => "variants",
                (true, false) => &name,
            };
            let style = if self.axis.categories.is_empty() { SeriesStyle::LineMarkers } else { SeriesStyle::Markers };
            panel.series.push(Series { style, few, ..Series::markers(name, points).with_errors(errors) });
        }
        let places: Vec<f64> = panel.series.iter().flat_map(|series| &series.points).map(|point| point[0]).collect();
        places.iter().any(|place| *place != places[0]).then_some(panel)
    }
}

/// Whether numbers lie more evenly by their ratios than by their differences, over a factor of at least ten.
fn is_geometric(values: &[f64]) -> bool {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(least), Some(most)) = (sorted.first(), sorted.last()) else { return false };
    if *least <= 0.0 || sorted.len() < 3 || most / least < 9.999 {
        return false;
    }
    // The spread of the distances between neighbours, relative to their mean.
    let unevenness = |measure: fn(f64, f64) -> f64| {
        let gaps: Vec<f64> = sorted.windows(2).map(|pair| measure(pair[0], pair[1])).collect();
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        gaps.iter().map(|gap| (gap / mean - 1.0).powi(2)).sum::<f64>()
    };
    unevenness(|a, b| (b / a).ln()) < unevenness(|a, b| b - a)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::variant::VariantState;
    use super::*;
    use crate::measure::statistics::student;
    use crate::plot::Scale;
    use crate::study::Record;
    use serde_json::json;

    /// The charts of a sweep whose variants are finished, with the temperature that a function gives for their number.
    fn drawn(vary: &[&str], also: &[&str], temperature: impl Fn(usize) -> f64) -> Vec<Chart> {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        let sweep = Sweep::load("dpd-fluid", &[], None, &owned(vary), &owned(also)).unwrap();
        let mut summary = SweepSummary::before(&sweep);
        for (number, variant) in summary.variants.iter_mut().enumerate() {
            variant.state = VariantState::Finished;
            let value = json!({"value": temperature(number), "error": 0.125});
            variant.means.insert("momentum_x".to_owned(), value.clone());
            variant.means.insert("pressure".to_owned(), json!({"value": 3.0, "error": 0.5}));
            variant.means.insert("temperature".to_owned(), value);
        }
        charts(&sweep, &summary, &Look::default())
    }

    #[test]
    fn numbers_over_decades_are_logarithmic() {
        for (values, log) in [
            (&[0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0][..], true),
            (&[100.0, 1.0, 10.0], true),
            (&[1.0, 4.5, 9.0], false),
            (&[0.01, 0.02, 0.04, 0.06, 0.08], false),
            (&[0.0, 1.0, 10.0, 100.0], false),
            (&[1.0, 100.0], false),
            (&[1.0, 25.0, 50.0, 75.0, 100.0], false),
        ] {
            assert_eq!(is_geometric(values), log, "{values:?}");
        }
    }

    #[test]
    fn means_stand_over_the_values_of_the_key_in_order() {
        let charts = drawn(&["interactions.0.friction=9,1,4.5"], &["temperature=0"], |number| number as f64);
        assert_eq!((charts.len(), charts[0].panels.len()), (1, 1), "the pressure is always the same");
        let panel = &charts[0].panels[0];
        assert_eq!((panel.x.label.as_str(), panel.x.scale), ("Friction (mass units/time unit)", Scale::Linear));
        assert_eq!(panel.y.label, "Temperature (energy units)");
        assert_eq!(panel.series[0].points, [[1.0, 1.0], [4.5, 2.0], [9.0, 0.0]]);
        assert_eq!(panel.series[0].errors.as_deref(), Some(&[0.125; 3][..]));
        assert_eq!((panel.references[0].label.as_str(), panel.references[0].value), ("temperature = 0", 3.0));
    }

    #[test]
    fn means_with_the_way_to_equilibrium_are_marked() {
        let sweep = Sweep::load("dpd-fluid", &[], None, &["temperature=1,2".to_owned()], &[]).unwrap();
        let mut summary = SweepSummary::before(&sweep);
        for (number, variant) in summary.variants.iter_mut().enumerate() {
            variant.state = VariantState::Finished;
            let value = json!({"value": number, "error": 0.125});
            variant.means.insert("pressure".to_owned(), value.clone());
            variant.means.insert("temperature".to_owned(), value);
        }
        let spoilt = json!({"means": [{"quantity": "pressure", "settled_from": null, "mean_from_there": 1.0}],
                            "equilibration": 10, "steps": null});
        summary.variants[1].unequilibrated = serde_json::from_value(spoilt).unwrap();
        let chart = &charts(&sweep, &summary, &Look::default())[0];
        assert!(!chart.panels[0].y.label.contains('†') && chart.panels[1].y.label.ends_with('†'));
        assert!(chart.subtitle.contains('†'));
    }

    #[test]
    fn words_are_categories_and_other_keys_are_curves() {
        let charts =
            drawn(&["integrator.type=splitting,cotter-reich", "time.step=0.01,0.02,0.03"], &[], |number| number as f64);
        let panel = &charts[0].panels[0];
        assert_eq!(panel.x.label, "Time step (time units)");
        let curves: Vec<&str> = panel.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(curves, ["type = splitting", "type = cotter-reich"]);
        assert_eq!(panel.series[1].points, [[0.01, 3.0], [0.02, 4.0], [0.03, 5.0]]);
        let charts = drawn(&["integrator.type=splitting,cotter-reich,groot-warren"], &[], |number| number as f64);
        let panel = &charts[0].panels[0];
        assert_eq!(panel.x.categories, ["splitting", "cotter-reich", "groot-warren"]);
        assert_eq!(panel.series[0].points[2], [2.0, 2.0]);
    }

    #[test]
    fn seeds_are_averaged() {
        let charts = drawn(&["interactions.0.friction=1,10,100", "seed=1,2"], &[], |number| (number * number) as f64);
        let panel = &charts[0].panels[0];
        assert_eq!((panel.series.len(), panel.x.scale), (1, Scale::Log));
        // 0 and 1, 4 and 9, 16 and 25: half the difference is the error of the mean of two, but for Student's factor.
        assert_eq!(panel.series[0].points, [[1.0, 0.5], [10.0, 6.5], [100.0, 20.5]]);
        let errors = [0.5, 2.5, 4.5].map(|error| error * student(1.0));
        assert_eq!(panel.series[0].errors.as_deref(), Some(&errors[..]));
        assert_eq!(panel.series[0].few, [true; 3]);
        let subtitle = &charts[0].subtitle;
        assert!(subtitle.contains("2 seeds") && subtitle.ends_with("hollow: error from few seeds"), "{subtitle}");
        assert!(drawn(&["seed=1,2,3"], &[], |number| number as f64).is_empty());
    }
}
