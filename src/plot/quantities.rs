//! What the quantities of a run are called, what they are measured in, and how they look, wherever they are shown.

use super::chart::{Chart, Mean, Panel, ReferenceLine, Series, SeriesInk};
use crate::families::EnergyChart;
use crate::numbers::{short, with_error};
use crate::quantity::{Quantity, Unit};
use crate::table::Table;
use std::fmt;

/// The label of an axis of time.
pub(super) const TIME: &str = "Time (time units)";

/// The name of a mean from few samples, whose error may be larger, ends in this in a legend.
const FEW_SAMPLES: &str = "*";
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

    /// The words below a title about the means.
    fn note(&self) -> String {
        let part = if self.from.is_some() { "after equilibration (shaded)" } else { "of the whole run" };
        means_note(self.means.iter().map(|(_, mean)| *mean), part)
    }
}

/// Curves whose values vary by less than this part of the distance between the outermost of them are drawn as
/// deviations.
const FLAT: f64 = 0.2;

/// Energies, temperatures and pressures over time, with their means; a panel none of whose columns exist is left out.
///
/// The columns are `time` and those of `QUANTITIES` with a look, of which each has its
/// panel by its unit. Energies that vary by less than a fifth of the distance between the outermost of their curves
/// would be flat lines: they are drawn as deviations from their means, or without means as changes since the first row.
///
/// ```
/// use mesoscope::families::EnergyChart;
/// use mesoscope::plot::{Averages, energies_chart};
/// use mesoscope::table::Table;
///
/// let columns = ["time", "kinetic_energy", "temperature"];
/// let table = Table::new(columns, vec![vec![0.0, 30.0, 1.1], vec![0.5, 27.0, 0.9]]);
/// let of = EnergyChart { temperature: Some(1.0), ..EnergyChart::of("particle", 20, 3) };
/// let chart = energies_chart("A fluid", &table, &of, &Averages::default());
/// // There is no pressure in the table, and no panel for it.
/// assert_eq!(chart.panels.len(), 2);
/// assert_eq!(chart.panels[0].series[0].points, [[0.0, 1.5], [0.5, 1.35]]);
/// assert_eq!(chart.panels[1].references[0].value, 1.0);
/// ```
#[must_use]
pub fn energies_chart(title: &str, table: &Table, of: &EnergyChart, averages: &Averages) -> Chart {
    let mut panels = Vec::new();
    for (name, unit) in [("energy", Unit::Energy), ("temperature", Unit::Temperature), ("pressure", Unit::Pressure)] {
        if unit == Unit::Temperature && of.is_athermal {
            continue;
        }
        let (noun, count) = of.per.filter(|_| unit == Unit::Energy).unwrap_or_default();
        let divisor = count.max(1) as f64;
        let mut panel = Panel { averaged_from: averages.from, ..Panel::new(TIME, "").settled() };
        for (quantity, look) in Quantity::shown_in(unit) {
            let Some(points) = table.over_time(quantity.name, divisor) else { continue };
            let series = Series::line(look.legend, points).with_ink(SeriesInk::Numbered(look.ink));
            panel.series.push(Series { mean: averages.of(quantity.name, divisor), ..series });
        }
        let [before, after] = if unit == Unit::Energy { relative_to_levels(&mut panel) } else { [""; 2] };
        let per = if noun.is_empty() { String::new() } else { format!(" per {noun}") };
        let words = of.unit.filter(|_| unit != Unit::Pressure).unwrap_or(unit.in_words(Some(of.dimension)));
        panel.y.label = capitalised(&format!("{before}{name}{per}{after} ({words})"));
        if let Some(set) = of.temperature.filter(|set| unit == Unit::Temperature && set.is_finite()) {
            panel = panel.with_reference(&format!("set, kT = {}", short(set)), set);
        }
        panels.push(panel);
        if unit == Unit::Energy && of.is_conserved {
            panels.push(energy_drift(table));
        }
    }
    let notes = [of.subtitle.clone(), averages.note()].into_iter().filter(|note| !note.is_empty());
    Chart::of_found(title, &notes.collect::<Vec<_>>().join("; "), panels)
}

/// Draws curves that would be flat lines far apart relative to a level each, and returns the words before and after
/// their name.
fn relative_to_levels(panel: &mut Panel) -> [&'static str; 2] {
    let from = panel.averaged_from.unwrap_or(f64::NEG_INFINITY);
    let ranges = panel.series.iter().filter_map(|series| {
        let late = series.points.iter().filter(|[time, value]| *time >= from && value.is_finite());
        late.map(|point| [point[1]; 2]).reduce(|range, [value, _]| [range[0].min(value), range[1].max(value)])
    });
    let ranges: Vec<[f64; 2]> = ranges.collect();
    let middles = ranges.iter().map(|[low, high]| 0.5 * (low + high));
    let outermost = middles.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], value| [a.min(value), b.max(value)]);
    let widest = ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    // Of curves that do not vary at all nothing is seen either way.
    if ranges.len() < 2 || widest == 0.0 || widest >= FLAT * (outermost[1] - outermost[0]) {
        return [""; 2];
    }
    let of_means = panel.series.iter().all(|series| series.mean.is_some());
    for series in &mut panel.series {
        let first = series.points.iter().map(|point| point[1]).find(|value| value.is_finite());
        let mean = series.mean.take().filter(|_| of_means);
        let level = mean.map(|mean| mean.value).or(first).unwrap_or(f64::NAN);
        let named = mean.map_or_else(|| format!("from {}", with_error(level, None)), |mean| format!("mean {mean}"));
        series.name = format!("{}, {named}", series.name);
        series.points.iter_mut().for_each(|point| point[1] -= level);
    }
    panel.references.push(ReferenceLine { label: String::new(), value: 0.0 });
    if of_means { ["", " less its mean"] } else { ["change of ", ""] }
}

/// The change of the total energy relative to its first value, where motion conserves that.
fn energy_drift(table: &Table) -> Panel {
    let points = table.over_time("total_energy", 1.0).unwrap_or_default();
    let first = points.first().map_or(f64::NAN, |point| point[1]);
    let panel = Panel::new(TIME, "Relative change of the total energy").with_reference("", 0.0);
    let change = points.iter().map(|point| [point[0], point[1] / first - 1.0]).collect();
    if first == 0.0 || points.is_empty() {
        return panel;
    }
    panel.with(Series::line("", change).with_ink(SeriesInk::Numbered(2)))
}

/// The words about means over a part of a run, with their marks; nothing without a mean.
pub(crate) fn means_note(means: impl IntoIterator<Item = Mean>, part: &str) -> String {
    let means: Vec<Mean> = means.into_iter().collect();
    if means.is_empty() {
        return String::new();
    }
    let few = if means.iter().any(|mean| mean.from_few_samples) { ", * error from few samples" } else { "" };
    let way = means.iter().any(|mean| mean.unequilibrated);
    let way = if way { format!(", {UNEQUILIBRATED} with the way to equilibrium") } else { String::new() };
    format!("means ± errors {part}{few}{way}")
}

impl fmt::Display for Mean {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let few = if self.from_few_samples { FEW_SAMPLES } else { "" };
        let way = if self.unequilibrated { UNEQUILIBRATED } else { "" };
        write!(formatter, "{}{few}{way}", with_error(self.value, self.standard_error))
    }
}

/// A word with a capital.
pub(crate) fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// The label of an axis of a unit in a box of this dimension.
pub(super) fn axis_label(name: &str, unit: Unit, dimension: usize) -> String {
    format!("{name} ({})", unit.in_words(Some(dimension)))
}

/// The label of an axis for a column of the table of energies, with its unit.
pub(crate) fn quantity_label(quantity: &str, relative: bool) -> String {
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
    use crate::quantity::QUANTITIES;

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

    fn table(columns: &[&str], rows: &[&[f64]]) -> Table {
        Table::new(columns.to_vec(), rows.iter().map(|row| row.to_vec()).collect())
    }

    fn chart(table: &Table, count: u64, averages: &Averages) -> Chart {
        energies_chart("a run", table, &EnergyChart::of("particle", count, 2), averages)
    }

    #[test]
    fn columns_decide_the_panels() {
        let table = table(&["step", "time", "pressure", "kinetic_energy"], &[&[1.0, 0.5, 23.0, 30.0], &[2.0, 1.0]]);
        let chart = chart(&table, 10, &Averages::default());
        assert_eq!(chart.panels.len(), 2);
        assert_eq!(chart.panels[0].series[0].points[0], [0.5, 3.0]);
        assert!(chart.panels[0].series[0].points[1][1].is_nan());
        assert_eq!(chart.panels[1].series[0].points[0], [0.5, 23.0]);
        assert_eq!(chart.subtitle, "10 particles");
        let labels: Vec<&str> = chart.panels.iter().map(|panel| panel.y.label.as_str()).collect();
        assert_eq!(labels, ["Energy per particle (energy units)", "Pressure (energy units/length unit²)"]);
    }

    #[test]
    fn the_set_temperature_is_a_reference() {
        let table = table(&["time", "temperature"], &[&[0.0, 1.1]]);
        let chart = |set: Option<f64>| {
            let of = EnergyChart { temperature: set, ..EnergyChart::of("particle", 0, 3) };
            energies_chart("a run", &table, &of, &Averages::default())
        };
        let reference = &chart(Some(1.5)).panels[0].references[0];
        assert_eq!((reference.label.as_str(), reference.value), ("set, kT = 1.5", 1.5));
        assert!([None, Some(f64::NAN)].iter().all(|set| chart(*set).panels[0].references.is_empty()));
    }

    #[test]
    fn all_lines_of_energies_are_told_apart() {
        let names = QUANTITIES.iter().filter(|quantity| quantity.look.is_some()).map(|quantity| quantity.name);
        let columns: Vec<&str> = ["time"].into_iter().chain(names).collect();
        let rows: Vec<Vec<f64>> = (0..2).map(|row| vec![1.0 + f64::from(row); columns.len()]).collect();
        let of = EnergyChart { temperature: Some(1.0), is_conserved: true, ..EnergyChart::of("particle", 1, 2) };
        let chart = energies_chart("a run", &Table::new(columns, rows), &of, &Averages::default());
        assert_eq!(chart.panels.len(), 4);
        crate::plot::series_look::assert_all_told_apart(&chart);
    }

    #[test]
    fn a_table_without_time_has_no_panels() {
        assert!(chart(&table(&["pressure"], &[&[1.0]]), 1, &Averages::default()).panels.is_empty());
    }

    #[test]
    fn a_quantity_looks_the_same_beside_all_others_and_alone() {
        let columns = ["time", "kinetic_energy", "potential_energy", "total_energy"];
        let all = chart(&table(&columns, &[&[0.0, 1.0, 2.0, 3.0]]), 1, &Averages::default());
        let columns = ["time", "kinetic_energy", "total_energy"];
        let ideal = chart(&table(&columns, &[&[0.0, 1.0, 1.0]]), 1, &Averages::default());
        let ink = |chart: &Chart, place: usize| chart.panels[0].series[place].ink;
        assert_eq!(ink(&ideal, 1), ink(&all, 2));
        assert_ne!(ink(&ideal, 1), ink(&all, 1));
    }

    #[test]
    fn means_are_those_of_the_panel() {
        let table = table(&["time", "kinetic_energy"], &[&[0.0, 30.0]]);
        let mean = Mean { value: 30.0, standard_error: Some(2.0), from_few_samples: true, unequilibrated: true };
        let averages = Averages { from: Some(4.0), means: vec![("kinetic_energy".to_owned(), mean)] };
        let chart = chart(&table, 20, &averages);
        let panel = &chart.panels[0];
        assert_eq!(panel.series[0].mean, Some(Mean { value: 1.5, standard_error: Some(0.1), ..mean }));
        assert_eq!(panel.averaged_from, Some(4.0));
        let marks = "(shaded), * error from few samples, † with the way to equilibrium";
        assert!(chart.subtitle.ends_with(marks), "{}", chart.subtitle);
    }

    /// Lines at 1.5 and 4.5 that vary by a quarter are flat, and by 1 are not.
    #[test]
    fn flat_energies_are_drawn_relative_to_their_levels() {
        let columns = ["time", "kinetic_energy", "potential_energy"];
        let rows = |size: f64| table(&columns, &[&[0.0, 1.5, 4.5], &[1.0, 1.5 + size, 4.5 - size]]);
        let mean = |value: f64| Mean { value, standard_error: Some(0.1), ..Mean::default() };
        let means = [("kinetic_energy", mean(1.75)), ("potential_energy", mean(4.25))];
        let means = means.map(|(name, mean)| (name.to_owned(), mean)).to_vec();
        let averages = Averages { from: None, means };
        let absolute = chart(&rows(1.0), 1, &averages);
        assert_eq!(absolute.panels[0].series[0].points[1], [1.0, 2.5]);
        let deviations = &chart(&rows(0.25), 1, &averages).panels[0];
        assert_eq!(deviations.y.label, "Energy per particle less its mean (energy units)");
        assert_eq!(deviations.series[0].points, [[0.0, -0.25], [1.0, 0.0]]);
        assert_eq!(deviations.series[1].name, "potential, mean 4.25 ± 0.10");
        assert!(deviations.series.iter().all(|series| series.mean.is_none()), "a bar would lie elsewhere");
        let changes = &chart(&rows(0.25), 1, &Averages::default()).panels[0];
        assert!(changes.y.label.starts_with("Change of energy per particle ("), "{}", changes.y.label);
        assert_eq!(
            (changes.series[1].points[1], changes.series[1].name.as_str()),
            ([1.0, -0.25], "potential, from 4.5")
        );
    }

    #[test]
    fn what_is_conserved_shows_its_drift() {
        let table = table(&["time", "kinetic_energy", "total_energy"], &[&[0.0, 1.0, 1000.0], &[1.0, 5.0, 1001.0]]);
        let of = EnergyChart { is_conserved: true, ..EnergyChart::of("particle", 1, 2) };
        let drift = &energies_chart("a vortex", &table, &of, &Averages::default()).panels[1].series[0].points;
        assert!(drift[0][1] == 0.0 && (drift[1][1] - 1e-3).abs() < 1e-12, "{drift:?}");
    }
}
