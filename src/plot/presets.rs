//! The charts a run writes, made from its tables.

use super::chart::{Axis, Chart, Panel, Series};
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
    fn points(&self, column: &str, divisor: f64) -> Option<Vec<[f64; 2]>> {
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

/// Circulations of material loops over time, relative to their first values.
#[must_use]
pub fn circulation_chart(title: &str, table: &EnergyTable) -> Chart {
    let mut panel = Panel::new("Time (time units)", "Relative change of the circulation").with_reference("none", 0.0);
    for column in table.columns.iter().filter(|column| *column != "time") {
        let points = table.points(column, 1.0).unwrap_or_default();
        let first = points.first().map_or(f64::NAN, |point| point[1]);
        panel
            .series
            .push(Series::line(column, points.iter().map(|point| [point[0], point[1] / first - 1.0]).collect()));
    }
    Chart { title: title.to_owned(), panels: vec![panel], ..Chart::default() }
}

/// The radial distribution function g(r), with the value 1 of an ideal gas as a reference.
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

#[cfg(test)]
mod tests {
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
}
