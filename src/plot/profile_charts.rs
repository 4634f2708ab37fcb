//! Charts of profiles along an axis of the box.

use super::chart::{Chart, Panel, SeriesInk, SeriesStyle};
use super::points::MOST_MARKERS;
use super::quantities::axis_label;
use crate::numbers::short;
use crate::quantity::Unit;
use crate::table::Table;

/// Particles whose density has a column of its own: those of a species, or all.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ProfiledSpecies {
    /// Their name.
    pub name: String,
    /// The name of their column.
    pub column: String,
    /// The ink of their curve.
    pub ink: SeriesInk,
}

/// Profiles of density, charge, velocity, temperature and normal pressures along an axis, with error bars; a column that is not in the table leaves its panel
/// out.
///
/// The columns are `position`, those of the densities, `charge_density`, `electrostatic_potential`, `velocity_x` and so on, `temperature`, and `pressure_xx` and so
/// on, each but the first with another whose name ends in `_error`. `dimension` is that of the box, and `temperature`
/// that of the bath, if there is one.
///
/// ```
/// use mesoscope::plot::profiles_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["position", "velocity_x", "velocity_x_error"];
/// let table = Table::new(columns, vec![vec![0.5, 0.9, 0.1], vec![1.5, -0.9, 0.1]]);
/// let chart = profiles_chart("Two streams", "y", 2, &table, &[], Some(1.0));
/// assert_eq!(chart.panels.len(), 1);
/// assert_eq!(chart.panels[0].x.label, "Position along y (length units)");
/// assert_eq!(chart.panels[0].series[0].errors, Some(vec![0.1, 0.1]));
/// ```
#[must_use]
pub fn profiles_chart(
    title: &str,
    axis: &str,
    dimension: usize,
    table: &Table,
    densities: &[ProfiledSpecies],
    temperature: Option<f64>,
) -> Chart {
    let along = format!("Position along {axis} (length units)");
    let panel = |label: &str, columns: &[(&str, &str)]| {
        let mut panel = Panel::new(&along, label).with_columns(table, "position", columns.iter().copied());
        if table.rows.len() <= MOST_MARKERS {
            panel.series.iter_mut().for_each(|series| series.style = SeriesStyle::LineMarkers);
        }
        panel
    };
    let columns: Vec<_> = densities.iter().map(|of| (of.column.as_str(), of.name.as_str())).collect();
    let mut density = panel(&axis_label("Number density", Unit::Density, dimension), &columns);
    let inks = densities.iter().filter(|of| table.column(&of.column).is_some()).map(|of| of.ink);
    density.series.iter_mut().zip(inks).for_each(|(series, ink)| series.ink = ink);
    let velocities = [("velocity_x", "v_{x}"), ("velocity_y", "v_{y}"), ("velocity_z", "v_{z}")];
    let velocity = panel("Velocity (length units/time unit)", &velocities);
    let mut thermal = panel(
        &axis_label("Temperature", Unit::Temperature, dimension),
        &[("temperature", "about the velocity of the bin")],
    )
    .settled();
    if let Some(temperature) = temperature {
        thermal = thermal.with_reference(&format!("kT = {}", short(temperature)), temperature);
    }
    let charge = panel(&axis_label("Charge density", Unit::Density, dimension), &[("charge_density", "all charges")]);
    let potential = panel(
        "Potential of a unit charge (energy units)",
        &[("electrostatic_potential", "of the clouds of all charges")],
    );
    let normal = [("pressure_xx", "P_{xx}"), ("pressure_yy", "P_{yy}"), ("pressure_zz", "P_{zz}")];
    let pressure = panel(&axis_label("Pressure", Unit::Pressure, dimension), &normal);
    let subtitle = "means over time after equilibration, with standard errors";
    Chart::of_found(title, subtitle, [density, charge, potential, velocity, thermal, pressure])
}

#[cfg(test)]
mod tests {
    use super::super::series_look::assert_all_told_apart;
    use super::*;

    #[test]
    fn columns_decide_the_panels() {
        let columns = ["position", "number_density", "number_density_0", "number_density_1", "temperature"];
        let table = Table::new(columns, (0..80).map(|bin| vec![f64::from(bin), 3.0, 1.0, 2.0, 1.0]).collect());
        let density =
            |name: &str, column: &str, ink| ProfiledSpecies { name: name.to_owned(), column: column.to_owned(), ink };
        let species = [
            density("all", "number_density", SeriesInk::AllSpecies),
            density("A", "number_density_0", SeriesInk::Species([0, 0])),
            density("B", "number_density_1", SeriesInk::Species([1, 1])),
        ];
        let chart = profiles_chart("a mixture", "z", 3, &table, &species, None);
        let shown: Vec<usize> = chart.panels.iter().map(|panel| panel.series.len()).collect();
        assert_eq!(shown, [3, 1]);
        assert_eq!(chart.panels[0].series[2].name, "B");
        assert_eq!(chart.panels[0].series[2].ink, SeriesInk::Species([1, 1]));
        assert!(chart.panels[0].series[0].errors.is_none() && chart.panels[1].references.is_empty());
        assert_all_told_apart(&chart);
    }
}
