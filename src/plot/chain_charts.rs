//! The charts of harmonic chains, made from the tables of a run.

use super::chart::{Axis, Chart, Panel, Series, SeriesInk};
use super::points::{highest, pairs};
use crate::numbers::short;
use crate::table::Table;

/// Columns of the three chains begin with these, which stand for these names.
const CHAINS: [(&str, &str); 3] =
    [("micro", "beads"), ("dpd", "DPD clusters"), ("frictionless", "frictionless clusters")];

const REDUCED_TIME: &str = "Reduced time τ = ω_{0}t/n";

/// Points of two columns; not numbers where there is no such column.
fn points(table: &Table, x: &str, y: &str) -> Vec<[f64; 2]> {
    pairs(&table.values(x), &table.values(y))
}

/// Markers of a series are this many at most, so that they stay apart.
const MOST_MARKERS: usize = 40;

/// Markers of each chain, and what is exact as a line through them.
fn compared(table: &Table, quantity: &str) -> Vec<Series> {
    let every = table.rows.len().div_ceil(MOST_MARKERS).max(1);
    let measured = CHAINS.iter().map(|(chain, name)| {
        let points = points(table, "tau", &format!("{chain}_{quantity}"));
        let errors = table.values(&format!("{chain}_{quantity}_error"));
        Series::markers(name, points.into_iter().step_by(every).collect())
            .with_known_errors(errors.into_iter().step_by(every).collect())
    });
    let exact = CHAINS.iter().zip(["exact", "", ""]).map(|((chain, _), name)| {
        let points = points(table, "tau", &format!("{chain}_exact_{quantity}"));
        Series::line(name, points).with_ink(SeriesInk::Ink { pattern: 0 })
    });
    measured.chain(exact).collect()
}

/// A pulse on its way: displacements of clusters at some reduced times, above each other.
///
/// The columns are `tau`, `cluster`, `micro`, `dpd` and `frictionless`.
///
/// ```
/// use mesoscope::plot::chain_profile_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["tau", "cluster", "micro", "dpd", "frictionless"];
/// let chart = chain_profile_chart("A chain", "", &Table::new(columns, vec![vec![0.0, 0.0, 1.0, 1.0, 1.0], vec![2.0, 0.0, 0.5, 0.5, 0.6]]));
/// // A panel for each time, with a line for each chain.
/// assert_eq!((chart.panels.len(), chart.panels[0].series.len()), (2, 3));
/// ```
#[must_use]
pub fn chain_profile_chart(title: &str, subtitle: &str, table: &Table) -> Chart {
    let last = highest(table.values("cluster"));
    let lines = CHAINS.map(|(chain, name)| (name, points(table, "cluster", chain)));
    let mut panels = Vec::new();
    let mut first = 0;
    for moment in table.values("tau").chunk_by(|a, b| a == b) {
        let range = first..first + moment.len();
        first = range.end;
        let mut panel = Panel::new("Number of the cluster", &format!("X/X_{{0}} at τ = {}", short(moment[0])));
        panel.x.range = Some([0.0, last]);
        panel.series.extend(lines.iter().map(|(name, points)| Series::line(name, points[range.clone()].to_vec())));
        panels.push(panel);
    }
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels }.with_one_legend()
}

/// Peak and variance of the halves of a pulse, and the energy of its clusters, over time.
///
/// The columns are `tau` and, for each of `micro`, `dpd` and `frictionless`, `…_peak`, `…_variance`, `…_energy` and the same
/// with `…_exact_` in between.
///
/// ```
/// use mesoscope::plot::chain_pulse_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["tau", "micro_peak", "micro_variance", "micro_energy"];
/// let rows = vec![vec![0.0, 1.0, 4.0, 1.0], vec![2.0, 0.5, 4.1, 0.99]];
/// let chart = chain_pulse_chart("A chain", "", &Table::new(columns, rows));
/// let points = |panel: usize| chart.panels[panel].series[0].points.clone();
/// assert_eq!(points(0), [[0.0, 1.0], [2.0, 0.5]], "the peak");
/// assert_eq!(points(1), [[0.0, 4.0], [2.0, 4.1]], "the variance");
/// ```
#[must_use]
pub fn chain_pulse_chart(title: &str, subtitle: &str, table: &Table) -> Chart {
    let panel =
        |quantity: &str, label: &str| Panel { series: compared(table, quantity), ..Panel::new(REDUCED_TIME, label) };
    let mut panels = vec![
        panel("peak", "Peak of a half"),
        panel("variance", "Variance of a half (clusters²)"),
        panel("energy", "Energy relative to the first"),
    ];
    panels[2].y.range = Some([0.0, 1.1]);
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels }.with_one_legend()
}

/// The autocorrelation of the momentum of a cluster.
///
/// The columns are `tau`, `limit`, and for each of `micro`, `dpd` and `frictionless` its own, `…_correlation`, with
/// `…_correlation_error` and `…_exact_correlation`.
///
/// ```
/// use mesoscope::plot::chain_correlation_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["tau", "limit", "dpd_correlation"];
/// let rows = vec![vec![0.0, 1.0, 1.0], vec![0.5, 0.5, 0.48]];
/// let chart = chain_correlation_chart("A chain", "", &Table::new(columns, rows));
/// let limit = chart.panels[0].series.last().map(|series| series.points.as_slice());
/// assert_eq!(limit, Some(&[[0.0, 1.0], [0.5, 0.5]][..]));
/// ```
#[must_use]
pub fn chain_correlation_chart(title: &str, subtitle: &str, table: &Table) -> Chart {
    let mut panel = Panel::new(REDUCED_TIME, "Momentum autocorrelation C_{PP}(τ)");
    panel.series = compared(table, "correlation");
    panel.series.push(Series::compared("large clusters of beads: max(0, 1 − τ)", points(table, "tau", "limit")));
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels: vec![panel.with_reference("", 0.0)] }
}

/// The running integral of the exact memory kernel, as a friction, with the plateau it has while ω₀t ≪ n.
///
/// The columns are `time` and, for each number n of beads in a cluster, `running_friction_n`; `plateau_n` for the line that is
/// fitted to the largest.
///
/// ```
/// use mesoscope::plot::chain_memory_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["time", "running_friction_10", "running_friction_20"];
/// let rows = vec![vec![0.0, 0.0, 0.0], vec![1.0, 0.4, 0.45]];
/// let chart = chain_memory_chart("A chain", "", &Table::new(columns, rows));
/// // On a logarithmic axis there is no place for time 0.
/// assert_eq!(chart.panels[0].series[1].points, [[1.0, 0.45]]);
/// ```
#[must_use]
pub fn chain_memory_chart(title: &str, subtitle: &str, table: &Table) -> Chart {
    let mut panel = Panel::new("", "Running integral (n/2) ∫ K as a friction γ*");
    panel.x = Axis::log("Time ω_{0}t");
    let line = |column: &str| points(table, "time", column).into_iter().filter(|point| point[0] > 0.0).collect();
    for (column, size) in table.columns.iter().filter_map(|name| Some((name, name.strip_prefix("running_friction_")?)))
    {
        panel.series.push(Series::line(&format!("n = {size}"), line(column)));
    }
    // Computed curves bear no markers, however jagged they are.
    let last = panel.series.len().saturating_sub(1).max(1) as f64;
    for (number, series) in panel.series.iter_mut().enumerate() {
        series.ink = SeriesInk::Scale { place: number as f64 / last, pattern: 0 };
    }
    for column in table.columns.iter().filter(|name| name.starts_with("plateau_")) {
        let height = table.values(column).first().copied().unwrap_or(f64::NAN);
        panel.series.push(Series::compared(&format!("plateau, from γ* = {height:.3}"), line(column)));
    }
    let panel = panel.with_reference("γ* = ½", 0.5).with_reference("over all times: 0", 0.0);
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels: vec![panel] }
}

/// Variances in equilibrium over time, relative to those of springs between clusters.
///
/// The columns are `tau`, and for each of `micro`, `dpd` and `frictionless` `…_momentum_variance`,
/// `…_separation_variance` and `…_exact_separation_variance`.
///
/// ```
/// use mesoscope::plot::chain_equilibrium_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["tau", "dpd_momentum_variance", "dpd_separation_variance"];
/// let rows = vec![vec![0.0, 1.01, 0.99], vec![1.0, 0.99, 1.02]];
/// let chart = chain_equilibrium_chart("A chain", "", &Table::new(columns, rows));
/// assert_eq!(chart.panels[0].references[0].value, 1.0);
/// ```
#[must_use]
pub fn chain_equilibrium_chart(title: &str, subtitle: &str, table: &Table) -> Chart {
    let panel = |quantity: &str, label: &str| {
        let columns = CHAINS.map(|(chain, name)| (format!("{chain}_{quantity}"), name));
        Panel::new(REDUCED_TIME, label).with_columns(table, "tau", columns)
    };
    let momenta = panel("momentum_variance", "⟨P²⟩ / nmkT").with_reference("exact", 1.0);
    let mut separations = panel("separation_variance", "var(X_{μ+1} − X_{μ}) κ/nkT");
    for (chain, name) in [("micro", "exact, beads"), ("dpd", "exact, clusters")] {
        let exact = table.values(&format!("{chain}_exact_separation_variance"));
        if let Some(value) = exact.first() {
            separations = separations.with_reference(&format!("{name}: {value:.3}"), *value);
        }
    }
    Chart { title: title.to_owned(), subtitle: subtitle.to_owned(), panels: vec![momenta, separations] }
        .with_one_legend()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(columns: &[&str], rows: &[&[f64]]) -> Table {
        Table::new(columns.to_vec(), rows.iter().map(|row| row.to_vec()).collect())
    }

    #[test]
    fn every_moment_has_a_panel_of_its_own() {
        let columns = ["tau", "cluster", "micro", "dpd", "frictionless"];
        let rows: [&[f64]; 4] = [
            &[0.0, 0.0, 1.0, 2.0, 3.0],
            &[0.0, 1.0, 4.0, 5.0, 6.0],
            &[10.0, 0.0, 7.0, 8.0, 9.0],
            &[10.0, 1.0, 1.5, 2.5, 3.5],
        ];
        let chart = chain_profile_chart("t", "s", &table(&columns, &rows));
        assert_eq!(chart.panels.len(), 2);
        assert_eq!(chart.panels[1].y.label, "X/X_{0} at τ = 10");
        assert_eq!(chart.panels[1].series[2].points, [[0.0, 9.0], [1.0, 3.5]]);
        assert_eq!(chart.panels[0].series[1].points, [[0.0, 2.0], [1.0, 5.0]]);
    }

    #[test]
    fn exact_lines_are_named_once_and_errors_belong_to_their_chain() {
        let columns = ["tau", "limit", "dpd_correlation", "dpd_correlation_error", "dpd_exact_correlation"];
        let chart = chain_correlation_chart("t", "s", &table(&columns, &[&[0.0, 1.0, 0.9, 0.1, 0.95]]));
        let series = &chart.panels[0].series;
        assert_eq!(series.iter().filter(|series| series.name == "exact").count(), 1);
        assert_eq!(series[4].points, [[0.0, 0.95]]);
        let dpd = series.iter().find(|series| series.name == "DPD clusters");
        assert_eq!(dpd.map(|series| (series.points[0], series.errors.clone())), Some(([0.0, 0.9], Some(vec![0.1]))));
    }

    #[test]
    fn every_cluster_size_is_a_line_and_time_zero_has_no_logarithm() {
        let columns = ["time", "running_friction_16", "running_friction_64", "plateau_64"];
        let chart = chain_memory_chart("t", "s", &table(&columns, &[&[0.0, 0.0, 0.0, 0.5], &[1.0, 0.6, 0.7, 0.48]]));
        let names: Vec<&str> = chart.panels[0].series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["n = 16", "n = 64", "plateau, from γ* = 0.500"]);
        assert_eq!(chart.panels[0].series[1].points, [[1.0, 0.7]]);
    }

    /// A plateau, what it tends to and zero were three dashed lines alike.
    #[test]
    fn all_lines_of_every_chart_are_told_apart() {
        use super::super::series_look::assert_all_told_apart;
        let columns = ["time", "running_friction_16", "running_friction_64", "running_friction_256", "plateau_256"];
        let memory = chain_memory_chart("memory", "", &table(&columns, &[&[1.0; 5]]));
        assert_eq!((memory.panels[0].series.len(), memory.panels[0].references.len()), (4, 2));
        let columns = ["tau", "limit", "micro_correlation", "dpd_correlation", "frictionless_correlation"];
        let correlation = chain_correlation_chart("correlation", "", &table(&columns, &[&[1.0; 5]]));
        let columns = ["tau", "micro_exact_separation_variance", "dpd_exact_separation_variance"];
        let equilibrium = chain_equilibrium_chart("equilibrium", "", &table(&columns, &[&[1.0; 3]]));
        for chart in [memory, correlation, equilibrium] {
            assert_all_told_apart(&chart);
        }
    }

    #[test]
    fn exact_variances_are_references() {
        let columns = ["tau", "micro_exact_separation_variance", "dpd_exact_separation_variance"];
        let chart = chain_equilibrium_chart("t", "s", &table(&columns, &[&[0.0, 0.67, 0.99]]));
        let values: Vec<f64> = chart.panels[1].references.iter().map(|reference| reference.value).collect();
        assert_eq!(values, [0.67, 0.99]);
    }
}
