//! The charts a run writes, made from its tables.

use super::chart::{Axis, Chart, Panel, Series, SeriesInk, SeriesStyle};
use super::ticks::{grouped, short_number};

/// The table of energies: one row per sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EnergyTable {
    /// Names of the columns, as in `energies.csv`.
    pub columns: Vec<String>,
    /// One number per column; what is missing in a short row is not drawn.
    pub rows: Vec<Vec<f64>>,
}

impl EnergyTable {
    /// Points (time, value / `divisor`) of a column, or none if there is no such column.
    pub(super) fn points(&self, column: &str, divisor: f64) -> Option<Vec<[f64; 2]>> {
        let find = |name: &str| self.columns.iter().position(|found| found == name);
        let (time, value) = (find("time")?, find(column)?);
        let cell = |row: &Vec<f64>, index: usize| row.get(index).copied().unwrap_or(f64::NAN);
        Some(self.rows.iter().map(|row| [cell(row, time), cell(row, value) / divisor]).collect())
    }
}

/// Energies per particle, temperatures and pressures over time; a panel none of whose columns exist is left out.
///
/// The columns are `time`, `kinetic_energy`, `potential_energy`, `total_energy`, `bath_energy`, `extended_energy`,
/// `temperature`, `configurational_temperature`, `pressure` and `pressure_conservative`. `temperature` is the set kT, drawn as a
/// reference; a value that is not finite leaves it out.
///
/// ```
/// use mesoscope::plot::{EnergyTable, energies_chart};
///
/// let columns = ["time", "kinetic_energy", "temperature"].map(str::to_owned).to_vec();
/// let table = EnergyTable { columns, rows: vec![vec![0.0, 30.0, 1.1], vec![0.5, 27.0, 0.9]] };
/// let chart = energies_chart("A fluid", &table, 20, 1.0);
/// // There is no pressure in the table, and no panel for it.
/// assert_eq!(chart.panels.len(), 2);
/// assert_eq!(chart.panels[0].series[0].points, [[0.0, 1.5], [0.5, 1.35]]);
/// assert_eq!(chart.panels[1].references[0].value, 1.0);
/// ```
#[must_use]
pub fn energies_chart(title: &str, table: &EnergyTable, particle_count: u64, temperature: f64) -> Chart {
    let per_particle = particle_count.max(1) as f64;
    let panels = [
        (
            "Energy per particle (energy units)",
            per_particle,
            [
                ("kinetic_energy", "kinetic"),
                ("potential_energy", "potential"),
                ("total_energy", "total"),
                ("bath_energy", "baths"),
                ("extended_energy", "total with baths"),
            ]
            .as_slice(),
        ),
        (
            "Temperature (energy units)",
            1.0,
            &[("temperature", "kinetic"), ("configurational_temperature", "configurational")],
        ),
        ("Pressure (reduced units)", 1.0, &[("pressure", "total"), ("pressure_conservative", "conservative part")]),
    ];
    let mut chart = Chart { title: title.to_owned(), ..Chart::default() };
    for (label, divisor, columns) in panels {
        let mut panel = Panel::new("Time (time units)", label);
        for (column, name) in columns {
            if let Some(points) = table.points(column, divisor) {
                panel.series.push(Series::line(name, points));
            }
        }
        if panel.series.is_empty() {
            continue;
        }
        if label.starts_with("Temperature") && temperature.is_finite() {
            panel = panel.with_reference(&format!("set, kT = {}", short_number(temperature)), temperature);
        }
        chart.panels.push(panel);
    }
    let plural = if particle_count == 1 { "particle" } else { "particles" };
    chart.subtitle = format!("{} {plural}", grouped(particle_count));
    chart
}

/// Energies of shallow water over time, the change of the conserved one relative to its first value, and, in a bath, the
/// temperature.
///
/// The columns are `time`, `kinetic_energy`, `potential_energy`, `total_energy`, and with a bath `bath_energy`,
/// `extended_energy` and `temperature`, of which `temperature` is the set kT.
///
/// ```
/// use mesoscope::plot::{EnergyTable, shallow_water_chart};
///
/// let columns = ["time", "kinetic_energy", "potential_energy", "total_energy"].map(str::to_owned).to_vec();
/// let rows = vec![vec![0.0, 300.0, 1000.0, 1300.0], vec![0.1, 301.3, 1000.0, 1301.3]];
/// let chart = shallow_water_chart("A vortex", &EnergyTable { columns, rows }, None);
/// let change = &chart.panels[1].series[0].points;
/// assert!((change[1][1] - 1e-3).abs() < 1e-12);
/// ```
#[must_use]
pub fn shallow_water_chart(title: &str, table: &EnergyTable, temperature: Option<f64>) -> Chart {
    let mut chart = Chart { title: title.to_owned(), ..Chart::default() };
    let mut energies = Panel::new("Time (time units)", "Energy (energy units)");
    for (column, name) in [
        ("kinetic_energy", "kinetic"),
        ("potential_energy", "potential"),
        ("total_energy", "kinetic and potential"),
        ("bath_energy", "bath"),
        ("extended_energy", "with the bath"),
    ] {
        if let Some(points) = table.points(column, 1.0) {
            energies.series.push(Series::line(name, points));
        }
    }
    chart.panels.push(energies);
    if let Some(set) = temperature {
        let points = table.points("temperature", 1.0).unwrap_or_default();
        let panel = Panel::new("Time (time units)", "Temperature (energy units)");
        let panel = panel.with(Series::line("kinetic", points));
        chart.panels.push(panel.with_reference(&format!("set, kT = {}", short_number(set)), set));
    } else {
        let points = table.points("total_energy", 1.0).unwrap_or_default();
        let first = points.first().map_or(f64::NAN, |point| point[1]);
        let change = points.iter().map(|point| [point[0], point[1] / first - 1.0]).collect();
        let panel = Panel::new("Time (time units)", "Relative change of the energy");
        chart.panels.push(panel.with(Series::line("energy", change)).with_reference("none", 0.0));
    }
    chart
}

/// Changes of the circulations of material loops over time, relative to their first values unless one of these is 0.
///
/// ```
/// use mesoscope::plot::{EnergyTable, circulation_chart};
///
/// let columns = ["time", "loop_0"].map(str::to_owned).to_vec();
/// let chart = circulation_chart("A loop", &EnergyTable { columns, rows: vec![vec![0.0, 2.0], vec![1.0, 2.002]] });
/// let change = &chart.panels[0].series[0].points;
/// assert!((change[1][1] - 1e-3).abs() < 1e-12);
/// ```
#[must_use]
pub fn circulation_chart(title: &str, table: &EnergyTable) -> Chart {
    let loops: Vec<(&String, Vec<[f64; 2]>)> = table
        .columns
        .iter()
        .filter(|column| *column != "time")
        .map(|column| (column, table.points(column, 1.0).unwrap_or_default()))
        .collect();
    let first = |points: &[[f64; 2]]| points.first().map_or(f64::NAN, |point| point[1]);
    let relative = loops.iter().all(|(_, points)| first(points) != 0.0);
    let label =
        if relative { "Relative change of the circulation" } else { "Change of the circulation (length²/time)" };
    let mut panel = Panel::new("Time (time units)", label).with_reference("none", 0.0);
    for (name, points) in &loops {
        let first = first(points);
        let scale = if relative { first } else { 1.0 };
        let changes = points.iter().map(|[time, value]| [*time, (value - first) / scale]).collect();
        panel.series.push(Series::line(name, changes));
    }
    Chart { title: title.to_owned(), panels: vec![panel], ..Chart::default() }
}

/// The radial distribution function g(r), with the value 1 of an ideal gas as a reference.
///
/// ```
/// use mesoscope::plot::radial_distribution_chart;
///
/// let chart = radial_distribution_chart("Hard discs", &[0.5, 1.0, 1.5], &[0.0, 1.8, 1.1]);
/// assert_eq!(chart.panels[0].x.range, Some([0.0, 1.5]));
/// ```
#[must_use]
pub fn radial_distribution_chart(title: &str, distances: &[f64], values: &[f64]) -> Chart {
    let points = distances.iter().zip(values).map(|(r, g)| [*r, *g]).collect();
    let mut panel = Panel::new("Distance r (length units)", "Radial distribution g(r)")
        .with(Series::line("g(r)", points))
        .with_reference("ideal gas", 1.0);
    let highest = values.iter().copied().filter(|value| value.is_finite()).fold(1.0_f64, f64::max);
    panel.y.range = Some([0.0, 1.1 * highest]);
    let farthest = distances.iter().copied().filter(|distance| distance.is_finite()).fold(0.0, f64::max);
    panel.x.range = Some([0.0, farthest]);
    Chart { title: title.to_owned(), subtitle: String::new(), panels: vec![panel] }
}

/// Mean squared displacement (on logarithmic axes) and velocity autocorrelation over the lag; an empty list leaves its
/// panel out.
///
/// ```
/// use mesoscope::plot::correlation_chart;
///
/// let lags = [0.0, 0.1, 0.2];
/// let both = correlation_chart("Diffusion", &lags, &[0.0, 0.02, 0.06], &[3.0, 2.2, 1.7]);
/// let one = correlation_chart("Diffusion", &lags, &[0.0, 0.02, 0.06], &[]);
/// assert_eq!((both.panels.len(), one.panels.len()), (2, 1));
/// ```
#[must_use]
pub fn correlation_chart(title: &str, lags: &[f64], displacement: &[f64], autocorrelation: &[f64]) -> Chart {
    let series = |name: &str, values: &[f64], first: f64| {
        // At lag zero the displacement is zero by definition and has no logarithm.
        let pairs = lags.iter().zip(values).filter(|(lag, _)| **lag > first || first < 0.0);
        Series::line(name, pairs.map(|(lag, value)| [*lag, *value]).collect())
    };
    let mut chart = Chart { title: title.to_owned(), ..Chart::default() };
    if !displacement.is_empty() {
        let mut panel = Panel::new("Lag (time units)", "Mean squared displacement (length units²)");
        panel.x = Axis::log("Lag (time units)");
        panel.y = Axis::log("Mean squared displacement (length units²)");
        chart.panels.push(panel.with(series("displacement", displacement, 0.0)));
    }
    if !autocorrelation.is_empty() {
        let panel = Panel::new("Lag (time units)", "Velocity autocorrelation (velocity units²)");
        chart.panels.push(panel.with(series("autocorrelation", autocorrelation, -1.0)).with_reference("zero", 0.0));
    }
    chart
}

/// A normalised autocorrelation of a `quantity` over the lag, with its errors and the curve fitted to it, of which an
/// empty list leaves the curve out.
///
/// ```
/// use mesoscope::plot::autocorrelation_chart;
///
/// let (lags, values, errors) = ([0.0, 0.1, 0.2], [1.0, 0.62, 0.35], [0.0, 0.02, 0.02]);
/// let fit = lags.map(|lag: f64| (-5.0 * lag).exp());
/// let chart = autocorrelation_chart("A fluid", "velocity", &lags, &values, &errors, &fit);
/// assert_eq!(chart.panels[0].y.label, "Normalised velocity autocorrelation");
/// assert_eq!(chart.panels[0].series.len(), 2);
/// ```
#[must_use]
pub fn autocorrelation_chart(
    title: &str,
    quantity: &str,
    lags: &[f64],
    values: &[f64],
    errors: &[f64],
    fit: &[f64],
) -> Chart {
    let points = |values: &[f64]| lags.iter().zip(values).map(|(lag, value)| [*lag, *value]).collect::<Vec<_>>();
    let mut panel = Panel::new("Lag (time units)", &format!("Normalised {quantity} autocorrelation"));
    let name = if fit.is_empty() { "autocorrelation" } else { "measured" };
    let few = lags.len() <= MOST_MARKERS;
    let measured = if few {
        Series::markers(name, points(values))
    } else {
        Series { style: SeriesStyle::Band, ..Series::line(name, points(values)) }
    };
    let known = errors.iter().any(|error| error.is_finite());
    panel.series.push(if known { measured.with_errors(errors.to_vec()) } else { measured });
    if !fit.is_empty() {
        // Over separate points; under a line, which it would hide.
        let ink = SeriesInk::Ink { pattern: usize::from(!few) };
        panel.series.insert(usize::from(!few), Series::line("fit", points(fit)).with_ink(ink));
    }
    panel = panel.with_reference("zero", 0.0);
    Chart { title: title.to_owned(), subtitle: String::new(), panels: vec![panel] }
}

/// With more points than this, markers and their error bars would run into each other.
const MOST_MARKERS: usize = 60;

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
    let unit = if quantity == "acceleration" { "length units per time unit²" } else { "length units per time unit" };
    let mut panel = Panel::new(&format!("{} ({unit})", capitalised(quantity)), "Probability density");
    let steps = edges.windows(2).zip(densities).flat_map(|(edge, density)| edge.iter().map(|x| [*x, *density]));
    panel.series.push(Series::line("histogram", steps.collect()));
    panel.series.push(Series::line(name, compared.to_vec()).with_ink(SeriesInk::Ink { pattern: 1 }));
    let heights = densities.iter().copied().chain(compared.iter().map(|point| point[1]));
    let highest = heights.filter(|value| value.is_finite()).fold(0.0, f64::max);
    if highest > 0.0 {
        panel.y.range = Some([0.0, 1.08 * highest]);
    }
    if let (Some(first), Some(last)) = (edges.first(), edges.last()) {
        panel.x.range = Some([*first, *last]);
    }
    Chart { title: title.to_owned(), subtitle: String::new(), panels: vec![panel] }
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::panic)]
    use super::*;

    fn table(columns: &[&str], rows: &[&[f64]]) -> EnergyTable {
        EnergyTable {
            columns: columns.iter().map(ToString::to_string).collect(),
            rows: rows.iter().map(|row| row.to_vec()).collect(),
        }
    }

    #[test]
    fn columns_decide_the_panels() {
        let table = table(&["step", "time", "pressure", "kinetic_energy"], &[&[1.0, 0.5, 23.0, 30.0], &[2.0, 1.0]]);
        let chart = energies_chart("a run", &table, 10, 1.0);
        assert_eq!(chart.panels.len(), 2);
        assert_eq!(chart.panels[0].series[0].points[0], [0.5, 3.0]);
        assert!(chart.panels[0].series[0].points[1][1].is_nan());
        assert_eq!(chart.panels[1].series[0].points[0], [0.5, 23.0]);
        assert_eq!(chart.subtitle, "10 particles");
    }

    #[test]
    fn the_set_temperature_is_a_reference() {
        let chart = energies_chart("a run", &table(&["time", "temperature"], &[&[0.0, 1.1]]), 0, 1.5);
        assert_eq!(chart.panels[0].references[0].label, "set, kT = 1.5");
        assert_eq!(chart.panels[0].references[0].value, 1.5);
        let without = energies_chart("a run", &table(&["time", "temperature"], &[&[0.0, 1.1]]), 0, f64::NAN);
        assert!(without.panels[0].references.is_empty());
    }

    #[test]
    fn a_table_without_time_has_no_panels() {
        assert!(energies_chart("a run", &table(&["pressure"], &[&[1.0]]), 1, 1.0).panels.is_empty());
    }

    #[test]
    fn logarithmic_panels_start_after_lag_zero() {
        let chart = correlation_chart("a run", &[0.0, 1.0], &[0.0, 2.0], &[3.0, 0.1]);
        assert_eq!(chart.panels[0].series[0].points, [[1.0, 2.0]]);
        assert_eq!(chart.panels[1].series[0].points.len(), 2);
    }

    #[test]
    fn a_fit_is_a_line_over_points_with_errors() {
        let chart = autocorrelation_chart("a run", "velocity", &[0.0, 1.0], &[1.0, 0.5], &[0.0, 0.1], &[1.0, 0.6]);
        let [fit, measured] = &chart.panels[0].series[..] else { panic!("two series") };
        assert_eq!((fit.style, fit.points[1], &fit.errors), (SeriesStyle::Line, [1.0, 0.6], &None));
        assert_eq!((measured.style, measured.points[1]), (SeriesStyle::Markers, [1.0, 0.5]));
        assert_eq!(measured.errors, Some(vec![0.0, 0.1]));
        let lone = autocorrelation_chart("a run", "force", &[0.0, 1.0], &[1.0, 0.5], &[f64::NAN; 2], &[]);
        assert_eq!((lone.panels[0].series.len(), &lone.panels[0].series[0].errors), (1, &None));
        let long = autocorrelation_chart("a run", "force", &[0.0; 100], &[1.0; 100], &[0.1; 100], &[]);
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
