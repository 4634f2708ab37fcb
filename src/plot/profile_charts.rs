//! Charts of profiles along an axis of the box.

use super::chart::{Chart, Panel, Series, SeriesInk, SeriesStyle};
use super::points::{MOST_MARKERS, pairs};
use super::quantities::{TEMPERATURE, pressure_label};
use crate::numbers::short;
use crate::table::Table;

/// A species whose density has a column of its own.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ProfiledSpecies {
    /// Its name.
    pub name: String,
    /// The name of its column.
    pub column: String,
}

/// Profiles of density, velocity, temperature and normal pressures along an axis, with error bars; a column that is not in the table leaves its panel
/// out.
///
/// The columns are `position`, `number_density`, those of the species, `velocity_x` and so on, `temperature`, and `pressure_xx` and so on, each but the first
/// with another whose name ends in `_error`. `temperature` is that of the bath, if there is one.
///
/// ```
/// use mesoscope::plot::profiles_chart;
/// use mesoscope::table::Table;
///
/// let columns = ["position", "velocity_x", "velocity_x_error"];
/// let table = Table::new(columns, vec![vec![0.5, 0.9, 0.1], vec![1.5, -0.9, 0.1]]);
/// let chart = profiles_chart("Two streams", "y", &table, &[], Some(1.0));
/// assert_eq!(chart.panels.len(), 1);
/// assert_eq!(chart.panels[0].x.label, "Position along y (length units)");
/// assert_eq!(chart.panels[0].series[0].errors, Some(vec![0.1, 0.1]));
/// ```
#[must_use]
pub fn profiles_chart(
    title: &str,
    axis: &str,
    table: &Table,
    species: &[ProfiledSpecies],
    temperature: Option<f64>,
) -> Chart {
    let positions = table.values("position");
    let few = positions.len() <= MOST_MARKERS;
    let series = |column: &str, name: &str| {
        let values = table.column(column)?;
        let points = pairs(&positions, &values);
        let style = if few { SeriesStyle::LineMarkers } else { SeriesStyle::Band };
        let series = Series { style, ..Series::line(name, points) };
        Some(series.with_known_errors(table.values(&format!("{column}_error"))))
    };
    let along = format!("Position along {axis} (length units)");
    let panel = |label: &str, columns: &[(&str, &str)]| {
        let found = columns.iter().filter_map(|(column, name)| series(column, name)).enumerate();
        let series = found.map(|(number, series)| series.with_ink(SeriesInk::Numbered(number))).collect();
        Panel { series, ..Panel::new(&along, label) }
    };
    let mut densities: Vec<(&str, &str)> = vec![("number_density", "all particles")];
    densities.extend(species.iter().map(|species| (species.column.as_str(), species.name.as_str())));
    let density = panel("Number density (particles/unit volume)", &densities);
    let velocities = [("velocity_x", "v_{x}"), ("velocity_y", "v_{y}"), ("velocity_z", "v_{z}")];
    let velocity = panel("Velocity (length units/time unit)", &velocities);
    let mut thermal = panel(TEMPERATURE, &[("temperature", "about the velocity of the bin")]).settled();
    if let Some(temperature) = temperature {
        thermal = thermal.with_reference(&format!("kT = {}", short(temperature)), temperature);
    }
    let normal = [("pressure_xx", "P_{xx}"), ("pressure_yy", "P_{yy}"), ("pressure_zz", "P_{zz}")];
    let dimension = if table.column("pressure_zz").is_some() { 3 } else { 2 };
    let pressure = panel(&pressure_label(dimension), &normal);
    let subtitle = "means over time after equilibration, with standard errors";
    Chart::of_found(title, subtitle, [density, velocity, thermal, pressure])
}

#[cfg(test)]
mod tests {
    use super::super::series_look::assert_all_told_apart;
    use super::*;

    #[test]
    fn columns_decide_the_panels() {
        let columns = ["position", "number_density", "number_density_0", "number_density_1", "temperature"];
        let table = Table::new(columns, (0..80).map(|bin| vec![f64::from(bin), 3.0, 1.0, 2.0, 1.0]).collect());
        let species = ["A", "B"].map(str::to_owned).into_iter().enumerate();
        let species: Vec<ProfiledSpecies> = species
            .map(|(number, name)| ProfiledSpecies { name, column: format!("number_density_{number}") })
            .collect();
        let chart = profiles_chart("a mixture", "z", &table, &species, None);
        let shown: Vec<usize> = chart.panels.iter().map(|panel| panel.series.len()).collect();
        assert_eq!(shown, [3, 1]);
        assert_eq!(chart.panels[0].series[2].name, "B");
        assert!(chart.panels[0].series[0].errors.is_none() && chart.panels[1].references.is_empty());
        assert_all_told_apart(&chart);
    }
}
