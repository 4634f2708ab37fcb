//! From the data of panels to the ranges of their axes.

use super::chart::{Axis, AxisFit, Panel, Scale, Series, SeriesStyle};
use super::ticks::{AxisMap, LARGEST, SMALLEST};
use crate::numbers::short;

/// Part of a panel at its start whose values do not set the range of a settled axis.
const START: f64 = 0.1;
/// Part of the settled values of a series at each end that may be outliers.
const OUTLIERS: f64 = 0.02;
/// Values within this part of the range of the others are none.
const FENCE: f64 = 0.5;
/// A range this many times as long as the settled one hides what has settled.
const MUCH_LONGER: f64 = 2.0;

/// A panel with everything decided but its place.
#[derive(Clone, Copy)]
pub(super) struct Prepared<'a> {
    pub panel: &'a Panel,
    pub x: AxisMap,
    pub y: AxisMap,
    /// The x axis of the panel below is the same.
    pub shares_x_below: bool,
    /// Points that a logarithmic axis has no place for.
    pub left_out: usize,
    pub has_data: bool,
    /// The lowest and the highest of all values, where a settled axis leaves it out.
    pub beyond: [Option<f64>; 2],
}

impl Prepared<'_> {
    /// How far the series leave the panel, if they do: `pressure up to 92.7`.
    pub(super) fn beyond_note(&self) -> Option<String> {
        let quantity = self.panel.y.label.split(" (").next().unwrap_or_default();
        let mut letters = quantity.chars();
        let quantity: String = letters.next().into_iter().flat_map(char::to_lowercase).chain(letters).collect();
        let text = |value: f64| short(format!("{value:.2e}").parse().unwrap_or(value));
        match self.beyond.map(|end| end.map(text)) {
            [None, None] => None,
            [None, Some(high)] => Some(format!("{quantity} up to {high}")),
            [Some(low), None] => Some(format!("{quantity} down to {low}")),
            [Some(low), Some(high)] => Some(format!("{quantity} from {low} to {high}")),
        }
    }
}

/// Decides on the axes of all panels; neighbours with like x axes share them.
pub(super) fn prepare(panels: &[Panel]) -> Vec<Prepared<'_>> {
    let mut prepared: Vec<Prepared<'_>> = Vec::new();
    for group in panels.chunk_by(|above, below| above.x == below.x) {
        // Lines end at the frame; markers must not be cut by it.
        let lone = |series: &Series| matches!(series.style, SeriesStyle::Markers | SeriesStyle::LineMarkers);
        let marked = group.iter().flat_map(|panel| &panel.series).any(lone);
        let x = axis_map(&group[0].x, group.iter().flat_map(x_values), if marked { 0.03 } else { 0.0 });
        for (index, panel) in group.iter().enumerate() {
            let log = |axis: &Axis, value: f64| axis.scale == Scale::Log && value <= 0.0;
            let points = || panel.series.iter().flat_map(|series| &series.points);
            let settled = settled(panel);
            let y = match settled {
                Some((range, _)) => AxisMap::linear(range[0], range[1]),
                None => axis_map(&panel.y, y_values(panel), 0.05),
            };
            prepared.push(Prepared {
                panel,
                x,
                y,
                shares_x_below: index + 1 < group.len(),
                left_out: points().filter(|point| log(&panel.x, point[0]) || log(&panel.y, point[1])).count(),
                has_data: points().any(|point| {
                    point.iter().all(|value| value.is_finite()) && !log(&panel.x, point[0]) && !log(&panel.y, point[1])
                }),
                beyond: settled.map_or([None; 2], |(_, beyond)| beyond),
            });
        }
    }
    prepared
}

fn x_values(panel: &Panel) -> impl Iterator<Item = f64> + '_ {
    panel.series.iter().flat_map(|series| &series.points).filter(|point| point[1].is_finite()).map(|point| point[0])
}

fn y_values(panel: &Panel) -> impl Iterator<Item = f64> + '_ {
    let of_series = panel.series.iter().flat_map(|series| {
        series.points.iter().enumerate().flat_map(move |(index, point)| {
            let error = series.errors.as_ref().map_or(0.0, |errors| errors[index]);
            let error = if error.is_finite() { error } else { 0.0 };
            let shown = if point[0].is_finite() { point[1] } else { f64::NAN };
            [shown - error, shown, shown + error]
        })
    });
    of_series.chain(compared(panel))
}

/// What else has to be in a panel.
fn compared(panel: &Panel) -> impl Iterator<Item = f64> + '_ {
    let means = panel.series.iter().filter_map(|series| series.mean).map(|mean| mean.value);
    panel.references.iter().map(|reference| reference.value).chain(means)
}

/// Lowest and highest of finite values; none without one.
fn extent(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let ends = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
    let [low, high] = values.filter(|value| value.is_finite()).fold([f64::INFINITY, f64::NEG_INFINITY], ends);
    (low <= high).then_some([low, high])
}

/// The range that the series of a panel come to, and what of all their values it leaves out; none where all of them fit well.
fn settled(panel: &Panel) -> Option<([f64; 2], [Option<f64>; 2])> {
    if panel.y.fit != AxisFit::Settled || panel.y.range.is_some() || panel.y.scale != Scale::Linear {
        return None;
    }
    let [first, last] = extent(x_values(panel))?;
    let from = first + START * (last - first);
    // Means are taken where the run is expected to have settled.
    let from = panel.averaged_from.filter(|averaged| *averaged < last).map_or(from, |averaged| from.max(averaged));
    let mut series = Vec::new();
    for one in &panel.series {
        let late = one.points.iter().filter(|point| point[0] >= from && point[1].is_finite());
        let mut values: Vec<f64> = late.map(|point| point[1]).collect();
        values.sort_unstable_by(f64::total_cmp);
        series.push(values);
    }
    let inner = series.iter().filter(|values| !values.is_empty()).flat_map(|values| {
        let left = (OUTLIERS * values.len() as f64) as usize;
        [values[left], values[values.len() - 1 - left]]
    });
    let inner = extent(inner.chain(compared(panel)))?;
    let reach = FENCE * (inner[1] - inner[0]);
    let near = |value: &f64| (inner[0] - reach..=inner[1] + reach).contains(value);
    let [low, high] = extent(series.into_iter().flatten().filter(near).chain(inner))?;
    let margin = 0.08 * (high - low);
    let range = [low - margin, high + margin];
    let [lowest, highest] = extent(y_values(panel))?;
    // A series that does not change any more has no range of its own, and one in the last digit shows noise.
    let length = range[1] - range[0];
    if length <= 1e-9 * low.abs().max(high.abs()).max(SMALLEST) || highest - lowest <= MUCH_LONGER * length {
        return None;
    }
    Some((range, [(lowest < range[0]).then_some(lowest), (highest > range[1]).then_some(highest)]))
}

/// The range of an axis: as given, or from the data with a margin.
fn axis_map(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64) -> AxisMap {
    if let Some(given) = AxisMap::given(axis.scale, axis.range) {
        return given;
    }
    let log = axis.scale == Scale::Log;
    let (smallest, without_values) = if log { (SMALLEST, [1.0, 10.0]) } else { (-LARGEST, [0.0, 1.0]) };
    let placed = values.filter(|value| value.is_finite() && (!log || *value > 0.0));
    let extent = extent(placed.map(|value| value.clamp(smallest, LARGEST)));
    if let (Some(extent), Scale::Linear) = (extent, axis.scale) {
        return AxisMap::around(extent, margin);
    }
    let [low, high] = extent.unwrap_or(without_values);
    let ratio = high / low;
    let grow = match extent {
        None => 1.0,
        Some(_) if ratio < 1.0 + 1e-9 => 2.0,
        Some(_) => ratio.powf(margin),
    };
    AxisMap { scale: axis.scale, low: low / grow, high: high * grow }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn settled_panel(points: Vec<[f64; 2]>) -> Panel {
        let mut panel = Panel::new("t", "Pressure (units)").with(Series::line("p", points));
        panel.y.fit = AxisFit::Settled;
        panel
    }

    fn noisy(count: usize) -> Vec<[f64; 2]> {
        (0..count).map(|i| [i as f64, 20.0 + (1.7 * i as f64).sin()]).collect()
    }

    #[test]
    fn neither_the_first_value_nor_an_outlier_rules_the_scale() {
        for (place, value) in [(0, 92.7), (0, -40.0), (70, 500.0)] {
            let mut points = noisy(100);
            points[place][1] = value;
            let panel = settled_panel(points);
            let prepared = &prepare(std::slice::from_ref(&panel))[0];
            assert!(prepared.y.low > 15.0 && prepared.y.high < 25.0, "{:?}", prepared.y);
            // All others are in the panel, and it says how far this one leaves it.
            assert!(prepared.y.low < 19.0 && prepared.y.high > 21.0, "{:?}", prepared.y);
            let note = prepared.beyond_note().unwrap();
            let expected = if value > 0.0 { format!("up to {value}") } else { "down to −40".to_owned() };
            assert_eq!(note, format!("pressure {expected}"));
        }
    }

    #[test]
    fn what_is_not_a_transient_stays_in_the_panel() {
        for points in [
            noisy(100),
            // A drift all the way.
            (0..100).map(|i| [f64::from(i), f64::from(i)]).collect(),
            // Constant but for the start, where nothing else is to be seen.
            (0..100).map(|i| [f64::from(i), if i == 0 { 9.0 } else { 1.0 }]).collect(),
            Vec::new(),
            vec![[0.0, 5.0]],
        ] {
            let panel = settled_panel(points);
            let prepared = &prepare(std::slice::from_ref(&panel))[0];
            assert_eq!(prepared.beyond_note(), None);
            let inside = |point: &[f64; 2]| (prepared.y.low..=prepared.y.high).contains(&point[1]);
            assert!(panel.series[0].points.iter().all(inside));
        }
    }

    #[test]
    fn means_and_references_are_in_the_panel() {
        let mut points = noisy(100);
        points[0][1] = 200.0;
        let mut panel = settled_panel(points).with_reference("set", 26.0);
        panel.series[0].mean = Some(super::super::chart::Mean { value: 17.0, ..Default::default() });
        let prepared = &prepare(std::slice::from_ref(&panel))[0];
        assert!(prepared.y.low < 17.0 && prepared.y.high > 26.0 && prepared.y.high < 40.0, "{:?}", prepared.y);
    }

    #[test]
    fn what_comes_before_the_means_does_not_set_the_scale() {
        let mut points = noisy(100);
        for point in &mut points[..30] {
            point[1] += 50.0;
        }
        let mut panel = settled_panel(points);
        assert_eq!(prepare(std::slice::from_ref(&panel))[0].beyond_note(), None);
        panel.averaged_from = Some(30.0);
        assert!(prepare(std::slice::from_ref(&panel))[0].beyond_note().is_some());
    }
}
