//! The charts a run writes, made from its tables.

use super::chart::{Chart, Panel, Series, SeriesInk, SeriesStyle};
use super::points::{MOST_MARKERS, highest, pairs, since_first, steps};
use super::quantities::{TIME, capitalised};
use crate::table::Table;

/// Changes of the circulations of material loops over time, relative to their first values unless one of these is 0.
///
/// ```
/// use mesoscope::plot::circulation_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["time", "loop_0"];
/// let chart = circulation_chart("A loop", &Table::new(columns, vec![vec![0.0, 2.0], vec![1.0, 2.002]]));
/// let change = &chart.panels[0].series[0].points;
/// assert!((change[1][1] - 1e-3).abs() < 1e-12);
/// ```
#[must_use]
pub fn circulation_chart(title: &str, table: &Table) -> Chart {
    let columns = table.columns.iter().filter(|column| *column != "time");
    let loops: Vec<(&String, Vec<[f64; 2]>)> =
        columns.map(|column| (column, table.over_time(column, 1.0).unwrap_or_default())).collect();
    let first = |points: &[[f64; 2]]| points.first().map_or(f64::NAN, |point| point[1]);
    let relative = loops.iter().all(|(_, points)| first(points) != 0.0);
    let label = if relative {
        "Relative change of the circulation"
    } else {
        "Change of the circulation (length units²/time unit)"
    };
    let mut panel = Panel::new(TIME, label).with_reference("no change", 0.0);
    for (name, points) in &loops {
        let scale = if relative { first(points) } else { 1.0 };
        let changes = since_first(points).into_iter().map(|[time, change]| [time, change / scale]).collect();
        panel.series.push(Series::line(name, changes));
    }
    Chart { title: title.to_owned(), panels: vec![panel], ..Chart::default() }
}

/// The radial distribution function g(r), of all particles or of pairs of species, with the value 1 of an ideal gas as a reference.
///
/// ```
/// use mesoscope::plot::{Series, radial_distribution_chart};
///
/// let curve = Series::line("g(r)", vec![[0.5, 0.0], [1.0, 1.8], [1.5, 1.1]]);
/// let chart = radial_distribution_chart("Hard discs", vec![curve]);
/// assert_eq!(chart.panels[0].x.range, Some([0.0, 1.5]));
/// ```
#[must_use]
pub fn radial_distribution_chart(title: &str, curves: Vec<Series>) -> Chart {
    let mut panel =
        Panel::new("Distance r (length units)", "Radial distribution g(r)").with_reference("ideal gas", 1.0);
    let [x, y] = [0, 1].map(|axis| highest(curves.iter().flat_map(|curve| &curve.points).map(|point| point[axis])));
    panel.y.range = Some([0.0, 1.1 * y.max(1.0)]);
    panel.x.range = Some([0.0, x]);
    panel.series = curves;
    Chart { title: title.to_owned(), subtitle: String::new(), panels: vec![panel] }
}

/// A normalised autocorrelation of a `quantity` over the lag, given by lags, values and errors, with the curve fitted to it,
/// given by name and values, of which an empty list leaves the curve out.
///
/// ```
/// use mesoscope::plot::autocorrelation_chart;
///
/// let (lags, values, errors) = ([0.0, 0.1, 0.2], [1.0, 0.62, 0.35], [0.0, 0.02, 0.02]);
/// let fit = lags.map(|lag: f64| (-5.0 * lag).exp());
/// let chart = autocorrelation_chart("A fluid", "velocity", (&lags, &values, &errors), ("exp(−5t)", &fit));
/// assert_eq!(chart.panels[0].y.label, "Normalised velocity autocorrelation");
/// assert_eq!(chart.panels[0].series.len(), 2);
/// ```
#[must_use]
pub fn autocorrelation_chart(
    title: &str,
    quantity: &str,
    (lags, values, errors): (&[f64], &[f64], &[f64]),
    (fit_name, fit): (&str, &[f64]),
) -> Chart {
    let mut panel = Panel::new("Lag (time units)", &format!("Normalised {quantity} autocorrelation"));
    let name = if fit.is_empty() { "autocorrelation" } else { "measured" };
    let few = lags.len() <= MOST_MARKERS;
    let style = if few { SeriesStyle::Markers } else { SeriesStyle::Band };
    let measured = Series { style, ..Series::line(name, pairs(lags, values)) };
    panel.series.push(measured.with_known_errors(errors.to_vec()));
    if !fit.is_empty() {
        // Over separate points; under a line, which it would hide.
        let ink = SeriesInk::Ink { pattern: usize::from(!few) };
        panel.series.insert(usize::from(!few), Series::line(fit_name, pairs(lags, fit)).with_ink(ink));
    }
    panel = panel.with_reference("zero", 0.0);
    Chart { title: title.to_owned(), subtitle: String::new(), panels: vec![panel] }
}

/// A histogram as a probability density of a `quantity`, in steps from `edges[k]` to `edges[k + 1]`, with a density to
/// compare it with, given by name as points.
///
/// ```
/// use mesoscope::plot::histogram_chart;
///
/// let gaussian: Vec<[f64; 2]> =
///     [-1.0, 0.0, 1.0].map(|v: f64| [v, (-v * v / 2.0).exp() / std::f64::consts::TAU.sqrt()]).to_vec();
/// let chart = histogram_chart("A gas", "velocity", &[-1.0, 0.0, 1.0], &[0.34, 0.35], ("Maxwell", &gaussian));
/// assert_eq!(chart.panels[0].series[0].points[..2], [[-1.0, 0.34], [0.0, 0.34]]);
/// ```
#[must_use]
pub fn histogram_chart(
    title: &str,
    quantity: &str,
    edges: &[f64],
    densities: &[f64],
    (name, compared): (&str, &[[f64; 2]]),
) -> Chart {
    let unit = if quantity == "acceleration" { "length units/time unit²" } else { "length units/time unit" };
    let density = format!("Probability density (1/({unit}))");
    let mut panel = Panel::new(&format!("{} ({unit})", capitalised(quantity)), &density);
    let bins = edges.windows(2).zip(densities).map(|(edges, density)| ([edges[0], edges[1]], *density));
    panel.series.push(Series::line("histogram", steps(bins)));
    panel.series.push(Series::compared(name, compared.to_vec()));
    let highest = highest(densities.iter().copied().chain(compared.iter().map(|point| point[1])));
    if highest > 0.0 {
        panel.y.range = Some([0.0, 1.08 * highest]);
    }
    if let (Some(first), Some(last)) = (edges.first(), edges.last()) {
        panel.x.range = Some([*first, *last]);
    }
    Chart { title: title.to_owned(), subtitle: String::new(), panels: vec![panel] }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::panic)]
    use super::*;

    #[test]
    fn a_fit_is_a_line_over_points_with_errors() {
        let chart =
            autocorrelation_chart("a run", "velocity", (&[0.0, 1.0], &[1.0, 0.5], &[0.0, 0.1]), ("fit", &[1.0, 0.6]));
        let [fit, measured] = &chart.panels[0].series[..] else { panic!("two series") };
        assert_eq!((fit.style, fit.points[1], &fit.errors), (SeriesStyle::Line, [1.0, 0.6], &None));
        assert_eq!((measured.style, measured.points[1]), (SeriesStyle::Markers, [1.0, 0.5]));
        assert_eq!(measured.errors, Some(vec![0.0, 0.1]));
        let lone = autocorrelation_chart("a run", "force", (&[0.0, 1.0], &[1.0, 0.5], &[f64::NAN; 2]), ("", &[]));
        assert_eq!((lone.panels[0].series.len(), &lone.panels[0].series[0].errors), (1, &None));
        let long = autocorrelation_chart("a run", "force", (&[0.0; 100], &[1.0; 100], &[0.1; 100]), ("", &[]));
        assert_eq!(long.panels[0].series[0].style, SeriesStyle::Band);
    }

    #[test]
    fn a_histogram_is_drawn_in_steps_from_edge_to_edge() {
        let compared: (&str, &[[f64; 2]]) = ("gaussian", &[[0.0, 0.6]]);
        let chart = histogram_chart("a run", "velocity", &[-1.0, 0.0, 1.0], &[0.25, 0.75], compared);
        let panel = &chart.panels[0];
        assert_eq!(panel.series[0].points, [[-1.0, 0.25], [0.0, 0.25], [0.0, 0.75], [1.0, 0.75]]);
        assert_eq!((panel.x.range, panel.series[1].points.len()), (Some([-1.0, 1.0]), 1));
        assert!(panel.x.label.starts_with("Velocity"));
    }
}
