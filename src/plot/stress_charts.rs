//! Charts of the pressure tensor.

use super::chart::{Chart, Mean, Panel};
use super::quantities::{TIME, axis_label};
use crate::measure::statistics::Estimate;
use crate::quantity::Unit;
use crate::table::Table;

/// Normal and shear components of the pressure tensor over time, with their means.
///
/// The columns are `time`, `pressure_xx` and so on; a component that is not in the table is left out. `means` gives the mean of a
/// component, such as `xx`.
///
/// ```
/// use mesoscope::plot::{Mean, stress_chart};
/// use mesoscope::table::Table;
///
/// let columns = ["time", "pressure_xx", "pressure_yy", "pressure_xy"];
/// let table = Table::new(columns, vec![vec![0.0, 23.0, 24.0, 0.1], vec![0.5, 24.0, 23.0, -0.1]]);
/// let mean = |component: &str| Some(Mean { value: if component == "xy" { 0.0 } else { 23.5 }, ..Mean::default() });
/// let chart = stress_chart("A film", &table, &mean);
/// assert_eq!(chart.panels[0].series.len(), 2);
/// assert_eq!(chart.panels[1].series[0].points, [[0.0, 0.1], [0.5, -0.1]]);
/// ```
#[must_use]
pub fn stress_chart(title: &str, table: &Table, means: &dyn Fn(&str) -> Option<Mean>) -> Chart {
    let dimension = if table.column("pressure_zz").is_some() { 3 } else { 2 };
    let panel = |name: &str, components: [&str; 3]| {
        let columns = components.map(|component| (format!("pressure_{component}"), format!("P_{{{component}}}")));
        let panel = Panel::new(TIME, &axis_label(name, Unit::Pressure, dimension)).settled();
        let mut panel = panel.with_columns(table, "time", columns);
        // Two dimensions lack the last of them.
        panel.series.iter_mut().zip(components).for_each(|(series, component)| series.mean = means(component));
        panel
    };
    let panels = [panel("Normal pressure", ["xx", "yy", "zz"]), panel("Shear stress", ["xy", "xz", "yz"])];
    Chart::of_found(title, "pressure tensor", panels)
}

/// The autocorrelation of the shear stress over the lag, and the viscosity that its sum up to there gives, with errors.
///
/// The columns are `time`, `autocorrelation`, `viscosity` and their errors, whose names end in `_error`.
///
/// ```
/// use mesoscope::measure::statistics::Estimate;
/// use mesoscope::plot::stress_correlation_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["time", "autocorrelation", "autocorrelation_error", "viscosity", "viscosity_error"];
/// let table = Table::new(columns, vec![vec![0.0, 9.0, 0.1, 0.2, 0.01], vec![0.1, 3.0, 0.1, 0.5, 0.02]]);
/// let viscosity = Estimate::new(0.5, Some(0.02), 20);
/// let chart = stress_correlation_chart("A fluid", &table, Some(viscosity));
/// assert_eq!(chart.panels[1].series[0].name, "η = 0.500 ± 0.020 at the longest lag");
/// ```
#[must_use]
pub fn stress_correlation_chart(title: &str, table: &Table, viscosity: Option<Estimate>) -> Chart {
    let panel = |column: &str, label: &str, name: &str| {
        Panel::new("Lag (time units)", label).with_columns(table, "time", [(column, name)]).with_reference("zero", 0.0)
    };
    let name = viscosity.map_or("sum up to the lag".to_owned(), |found| format!("η = {found} at the longest lag"));
    let correlation = panel("autocorrelation", "Autocorrelation of the shear stress, times V/kT", "autocorrelation");
    let sum = panel("viscosity", "Viscosity from its sum (mass units/(length unit · time unit))", &name);
    // Noise of a single step would take the whole axis.
    Chart::of_found(title, "means over blocks of time, with standard errors", [correlation.settled(), sum])
}
