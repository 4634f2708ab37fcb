//! What the quantities of a run are called, what they are measured in, and how they look, wherever they are shown.

use super::chart::{Mean, Panel, Series, SeriesInk};
use crate::numbers::short;
use crate::quantity::{Look, Quantity, Unit};
use crate::table::Table;

/// The label of an axis of time.
pub(super) const TIME: &str = "Time (time units)";
/// The label of an axis of temperatures.
pub(super) const TEMPERATURE: &str = "Temperature (energy units)";

/// The name of a mean from few samples, whose error may be larger, ends in this in a legend.
pub(super) const FEW_SAMPLES: &str = "*";
/// The name of a mean that includes the way to equilibrium ends in this.
pub(crate) const UNEQUILIBRATED: &str = "†";

/// Means of columns of the table of energies, taken over the end of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Averages {
    /// Time from which on they are taken; left out, all of the run.
    pub from: Option<f64>,
    /// Means by the name of their column, in the units of the table.
    pub means: Vec<(String, Mean)>,
}

impl Averages {
    /// The mean of a column over a divisor.
    fn of(&self, column: &str, divisor: f64) -> Option<Mean> {
        let (_, mean) = self.means.iter().find(|(name, _)| name == column)?;
        Some(Mean { value: mean.value / divisor, standard_error: mean.standard_error.map(|e| e / divisor), ..*mean })
    }
}

/// A series of a column in its own ink.
pub(super) fn series(column: &str, points: Vec<[f64; 2]>) -> Series {
    match Quantity::of_column(column).and_then(|quantity| quantity.look) {
        Some(Look { legend, ink }) => Series::line(legend, points).with_ink(SeriesInk::Numbered(ink)),
        None => Series::line(column, points),
    }
}

/// A panel over time of the quantities of a unit that a table has, over a divisor, with their means; empty without any.
pub(super) fn panel(label: &str, table: &Table, unit: Unit, divisor: f64, averages: &Averages) -> Panel {
    let mut panel = Panel::new(TIME, label).settled();
    panel.averaged_from = averages.from;
    for column in Quantity::columns_shown_in(unit) {
        if let Some(points) = table.over_time(column, divisor) {
            panel.series.push(Series { mean: averages.of(column, divisor), ..series(column, points) });
        }
    }
    panel
}

/// The panel with the set temperature to compare with, if that is known.
pub(super) fn with_set_temperature(panel: Panel, temperature: f64) -> Panel {
    if !temperature.is_finite() {
        return panel;
    }
    panel.with_reference(&format!("set, kT = {}", short(temperature)), temperature)
}

/// What to say below the title about the means that a chart shows; nothing if it shows none.
#[must_use]
pub fn averages_note(averages: &Averages) -> String {
    if averages.means.is_empty() {
        return String::new();
    }
    let few = averages.means.iter().any(|(_, mean)| mean.from_few_samples);
    let few = if few { format!(", {FEW_SAMPLES} from few samples") } else { String::new() };
    let way = averages.means.iter().any(|(_, mean)| mean.unequilibrated);
    let way = if way { format!(", {UNEQUILIBRATED} with the way to equilibrium") } else { String::new() };
    let part = if averages.from.is_some() { "after equilibration (shaded)" } else { "of the whole run" };
    format!("means ± errors {part}{few}{way}")
}

pub(super) fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// The label of an axis of pressures in a number of dimensions.
pub(super) fn pressure_label(dimension: usize) -> String {
    format!("Pressure ({})", Unit::Pressure.in_words(Some(dimension)))
}

/// The label of an axis for a column of the table of energies, with its unit.
///
/// ```
/// use mesoscope::plot::quantity_label;
/// assert_eq!(quantity_label("total_energy", false), "Total energy (energy units)");
/// assert_eq!(quantity_label("total_energy", true), "Total energy relative to its first value");
/// ```
#[must_use]
pub fn quantity_label(quantity: &str, relative: bool) -> String {
    let name = capitalised(&quantity.replace("center", "centre").replace('_', " "));
    if relative {
        return format!("{name} relative to its first value");
    }
    let unit = Quantity::of_column(quantity).map_or("reduced units", |known| known.unit.in_words(None));
    format!("{name} ({unit})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_a_unit() {
        for (quantity, label) in [
            ("configurational_temperature", "Configurational temperature (energy units)"),
            ("pressure", "Pressure (energy units/volume)"),
            ("momentum_x", "Momentum x (mass units × length units/time unit)"),
            ("center_of_mass_velocity_y", "Centre of mass velocity y (length units/time unit)"),
        ] {
            assert_eq!(quantity_label(quantity, false), label);
        }
    }

    #[test]
    fn a_quantity_looks_the_same_beside_all_others_and_alone() {
        let columns = ["time", "kinetic_energy", "potential_energy", "total_energy"];
        let table = Table::new(columns, vec![vec![0.0, 1.0, 2.0, 3.0]]);
        let all = panel("E", &table, Unit::Energy, 1.0, &Averages::default());
        let columns = ["time", "kinetic_energy", "total_energy"];
        let table = Table::new(columns, vec![vec![0.0, 1.0, 1.0]]);
        let ideal = panel("E", &table, Unit::Energy, 1.0, &Averages::default());
        assert_eq!(ideal.series[1].ink, all.series[2].ink);
        assert_ne!(ideal.series[1].ink, all.series[1].ink);
    }

    #[test]
    fn means_are_those_of_the_panel() {
        let columns = ["time", "kinetic_energy"];
        let table = Table::new(columns, vec![vec![0.0, 30.0]]);
        let mean = Mean { value: 30.0, standard_error: Some(2.0), from_few_samples: true, unequilibrated: true };
        let averages = Averages { from: Some(4.0), means: vec![("kinetic_energy".to_owned(), mean)] };
        let panel = panel("E", &table, Unit::Energy, 20.0, &averages);
        assert_eq!(panel.series[0].mean, Some(Mean { value: 1.5, standard_error: Some(0.1), ..mean }));
        assert_eq!(panel.averaged_from, Some(4.0));
        assert!(averages_note(&averages).ends_with("(shaded), * from few samples, † with the way to equilibrium"));
    }
}
