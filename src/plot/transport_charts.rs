//! Charts of transport: what is measured over lags, with the fits made to it and what they give.

use super::chart::{Axis, Chart, Mean, Panel, Series, SeriesInk};
use super::quantities::TIME;
use crate::measure::statistics::Estimate;
use crate::numbers::with_error;
use crate::table::Table;

const LAG: &str = "Lag (time units)";

/// Mean squared displacement (on logarithmic axes) and velocity autocorrelation over the lag, with what they say of diffusion;
/// a column that is not in the table leaves its panel out.
///
/// The columns are `time`, `mean_squared_displacement` and `velocity_autocorrelation`. `einstein` is the diffusion coefficient
/// that a line through the second half of the displacements gave in so many dimensions, `green_kubo` the one from the integral
/// of the autocorrelation.
///
/// ```
/// use mesoscope::measure::statistics::Estimate;
/// use mesoscope::plot::diffusion_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["time", "mean_squared_displacement"];
/// // ⟨Δr²⟩ = 6 D t - 0.1 with D = ½.
/// let rows = (0..20).map(|lag| vec![0.1 * f64::from(lag), 0.3 * f64::from(lag) - 0.1]).collect();
/// let einstein = Estimate::new(0.5, Some(0.02), 20);
/// let chart = diffusion_chart("A fluid", &Table::new(columns, rows), 3, Some(einstein), None);
/// let fit = &chart.panels[0].series[1];
/// assert!(fit.name.contains("D = 0.500 ± 0.020"), "{}", fit.name);
/// assert!((fit.points[0][1] - 2.9).abs() < 1e-9);
/// ```
#[must_use]
pub fn diffusion_chart(
    title: &str,
    table: &Table,
    dimension: usize,
    einstein: Option<Estimate>,
    green_kubo: Option<Estimate>,
) -> Chart {
    let (x, y) = (Axis::log(LAG), Axis::log("Mean squared displacement (length units²)"));
    let mut displacement = Panel { x, y, ..Panel::default() };
    if let Some(points) = table.over_time("mean_squared_displacement", 1.0) {
        // At lag zero the displacement is zero by definition and has no logarithm.
        let shown = points.iter().copied().filter(|point| point[0] > 0.0).collect();
        displacement.series.push(Series::line("displacement", shown));
        if let Some(found) = einstein {
            let slope = 2.0 * dimension as f64 * found.value;
            let name = format!("{} D t + b, D = {found}", 2 * dimension);
            displacement.series.push(Series::compared(&name, displacement_line(&points, slope)));
        }
    }
    let name = green_kubo.map(|found| format!("autocorrelation; from its integral D = {found}"));
    let columns = [("velocity_autocorrelation", name.as_deref().unwrap_or("autocorrelation"))];
    let correlation = Panel::new(LAG, "Velocity autocorrelation (length units²/time unit²)");
    let correlation = correlation.with_columns(table, "time", columns).with_reference("zero", 0.0);
    Chart::of_found(title, "", [displacement, correlation])
}

/// The line of a slope through the second half of mean squared displacements, with weights 1/t² as in
/// [`DiffusionWindows::einstein`](crate::measure::diffusion::DiffusionWindows::einstein).
fn displacement_line(points: &[[f64; 2]], slope: f64) -> Vec<[f64; 2]> {
    let late = &points[points.len().div_ceil(2).max(1).min(points.len())..];
    let weigh = |sums: [f64; 2], [time, value]: &[f64; 2]| {
        let weight = 1.0 / (time * time);
        [sums[0] + weight, sums[1] + weight * (value - slope * time)]
    };
    let [weight, sum] = late.iter().fold([0.0; 2], weigh);
    late.iter().map(|[time, _]| [*time, slope * time + sum / weight]).collect()
}

/// Autocorrelations of transverse waves of momentum over the lag, on a logarithmic axis where a viscous decay is a straight
/// line, with the decay fitted to each wave.
///
/// The columns are `wave_number`, `time`, `autocorrelation` and `fit`. `viscosities` are those of the waves in order, and that
/// of all of them.
///
/// ```
/// use mesoscope::measure::statistics::Estimate;
/// use mesoscope::plot::viscosity_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["wave_number", "time", "autocorrelation", "fit"];
/// let rows = vec![vec![0.5, 0.0, 1.0, f64::NAN], vec![0.5, 1.0, 0.8, 0.79], vec![0.9, 0.0, 1.0, f64::NAN]];
/// let viscosity = Estimate::new(0.9, Some(0.1), 20);
/// let chart = viscosity_chart("Waves", &Table::new(columns, rows), &[viscosity], Some(viscosity));
/// assert_eq!(chart.panels[0].series[0].name, "k = 0.5/length unit, η = 0.90 ± 0.10");
/// assert_eq!(chart.subtitle, "shear viscosity η = 0.90 ± 0.10");
/// ```
#[must_use]
pub fn viscosity_chart(title: &str, table: &Table, viscosities: &[Estimate], all: Option<Estimate>) -> Chart {
    let label = "Normalised autocorrelation of transverse momentum waves";
    let mut panel = Panel::new(LAG, label);
    panel.y = Axis::log(label);
    let cell = |row: &Vec<f64>, index: usize| row.get(index).copied().unwrap_or(f64::NAN);
    let mut fits = Vec::new();
    for (number, wave) in table.rows.chunk_by(|a, b| cell(a, 0) == cell(b, 0)).enumerate() {
        let column = |index: usize| wave.iter().map(|row| [cell(row, 1), cell(row, index)]).collect::<Vec<_>>();
        let mut name = format!("k = {}/length unit", with_error(cell(&wave[0], 0), None));
        if let Some(found) = viscosities.get(number) {
            name = format!("{name}, η = {found}");
        }
        panel.series.push(Series::line(&name, column(2)));
        let fit: Vec<[f64; 2]> = column(3).into_iter().filter(|point| point[1].is_finite()).collect();
        if !fit.is_empty() {
            let name = if fits.is_empty() { "exponential decays fitted" } else { "" };
            fits.push(Series::compared(name, fit));
        }
    }
    panel.series.extend(fits);
    let subtitle = all.map(|found| format!("shear viscosity η = {found}"));
    Chart { title: title.to_owned(), subtitle: subtitle.unwrap_or_default(), panels: vec![panel] }
}

/// A kind of chains: the name of its species, the number of beads, and the means of its squared end-to-end distance and of
/// its squared radius of gyration.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChainKind {
    /// Name of the species.
    pub species: String,
    /// The ink of its curves.
    pub ink: SeriesInk,
    /// Beads in a chain.
    pub beads: u64,
    /// Mean of the squared distance of the ends; none of a ring.
    pub end_to_end: Option<Mean>,
    /// Mean of the squared radius of gyration.
    pub gyration: Option<Mean>,
}

/// Sizes of chains over time, with their means: squared end-to-end distances and squared radii of gyration.
///
/// The columns are `time` and, for each kind with its number, `end_to_end_squared_0` and `radius_of_gyration_squared_0`.
///
/// ```
/// use mesoscope::plot::{ChainKind, Mean, chain_sizes_chart};
/// use mesoscope::table::Table;
///
/// let columns = ["time", "end_to_end_squared_0", "radius_of_gyration_squared_0"];
/// let table = Table::new(columns, vec![vec![0.0, 6.1, 1.0], vec![1.0, 5.9, 1.1]]);
/// let end_to_end = Some(Mean { value: 6.0, ..Mean::default() });
/// let kind = ChainKind { species: "decamer".to_owned(), beads: 10, end_to_end, ..ChainKind::default() };
/// let chart = chain_sizes_chart("A melt", &table, &[kind]);
/// assert_eq!(chart.panels[0].series[0].name, "decamer, 10 beads");
/// assert_eq!(chart.panels[1].series[0].points, [[0.0, 1.0], [1.0, 1.1]]);
/// ```
#[must_use]
pub fn chain_sizes_chart(title: &str, table: &Table, kinds: &[ChainKind]) -> Chart {
    let panel = |label: &str, column: &str, mean_of: fn(&ChainKind) -> Option<Mean>| {
        let mut panel = Panel::new(TIME, label).settled();
        for (number, kind) in kinds.iter().enumerate() {
            let mean = mean_of(kind);
            let Some(points) = table.over_time(&format!("{column}_{number}"), 1.0) else { continue };
            let series = Series::line(&format!("{}, {} beads", kind.species, kind.beads), points);
            panel.series.push(Series { mean, ..series.with_ink(kind.ink) });
        }
        panel
    };
    let mut ends = panel("Squared end-to-end distance (length units²)", "end_to_end_squared", |kind| kind.end_to_end);
    // The ends of a ring are neighbours.
    ends.series.retain(|series| series.mean.is_some());
    let gyration =
        panel("Squared radius of gyration (length units²)", "radius_of_gyration_squared", |kind| kind.gyration);
    let subtitle = "sizes are averages over all chains of a kind";
    Chart::of_found(title, subtitle, [ends, gyration])
}

#[cfg(test)]
mod tests {
    use super::super::series_look::assert_all_told_apart;
    use super::*;

    #[test]
    fn every_wave_is_a_series_with_its_fit() {
        let columns = ["wave_number", "time", "autocorrelation", "fit"];
        let row = |wave: f64, lag: f64, fit: f64| vec![wave, lag, (-lag).exp(), fit];
        let rows = vec![row(0.5, 0.0, f64::NAN), row(0.5, 1.0, 0.4), row(0.9, 0.0, f64::NAN), row(0.9, 1.0, 0.3)];
        let chart = viscosity_chart("waves", &Table::new(columns, rows), &[], None);
        let series: Vec<(&str, usize)> =
            chart.panels[0].series.iter().map(|series| (series.name.as_str(), series.points.len())).collect();
        assert_eq!(
            series,
            [("k = 0.5/length unit", 2), ("k = 0.9/length unit", 2), ("exponential decays fitted", 1), ("", 1)]
        );
        assert_all_told_apart(&chart);
        // A table without fits.
        let columns = ["wave_number", "time", "autocorrelation"];
        let chart = viscosity_chart("waves", &Table::new(columns, vec![vec![0.5, 0.0, 1.0]]), &[], None);
        assert_eq!(chart.panels[0].series.len(), 1);
    }

    #[test]
    fn rings_have_no_ends() {
        let columns = ["time", "end_to_end_squared_0", "radius_of_gyration_squared_0"];
        let table = Table::new(columns, vec![vec![0.0, 1.0, 2.0]]);
        let ring = ChainKind { gyration: Some(Mean::default()), ..ChainKind::default() };
        let chart = chain_sizes_chart("rings", &table, &[ring]);
        assert_eq!(chart.panels.len(), 1);
        assert!(chart.panels[0].y.label.contains("gyration"));
    }

    #[test]
    fn a_line_follows_the_second_half() {
        let points: Vec<[f64; 2]> = (0..40).map(|lag| f64::from(lag) * 0.1).map(|t| [t, 3.0 * t + 0.5]).collect();
        let line = displacement_line(&points, 3.0);
        assert_eq!(line.len(), 20);
        assert!(line.iter().all(|[t, value]| (value - 3.0 * t - 0.5).abs() < 1e-9));
        assert!(displacement_line(&[], 1.0).is_empty());
    }
}
