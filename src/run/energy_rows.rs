//! The rows of the table of energies, and the means of its columns.

use super::settling;
use crate::families::{Checked, Column, TimeAxis, column};
use crate::measure::Observables;
use crate::measure::statistics::{Estimate, estimate};
use crate::output::{Summary, files};
use crate::table::Table;
use std::ops::Range;

/// All rows of a run so far.
pub(super) struct EnergyRows {
    columns: Vec<Column>,
    rows: Vec<Vec<f64>>,
    /// Σ|∇V|² and Σ∇²V of every row after equilibration: an average of the configurational temperature needs both.
    pub configuration: Vec<[f64; 2]>,
    time: TimeAxis,
    pub equilibration: u64,
}

impl EnergyRows {
    /// No rows yet.
    pub(super) fn new(scene: &Checked) -> Self {
        Self::continued(scene, Vec::new(), Vec::new())
    }

    /// The rows of a run that goes on, and the sums behind the configurational temperature.
    pub(super) fn continued(scene: &Checked, rows: Vec<Vec<f64>>, configuration: Vec<[f64; 2]>) -> Self {
        let model = scene.model();
        let columns = model.physics().columns(model);
        Self { columns, rows, configuration, time: model.time, equilibration: scene.time.equilibration }
    }

    /// Leaves the rows before a step out of means, as those before equilibration: something else was measured there.
    pub(super) fn begin_anew(&mut self, step: u64) {
        self.equilibration = self.equilibration.max(step);
        self.configuration.clear();
    }

    /// Adds a row, and gives its numbers without the step.
    pub(super) fn add(&mut self, observables: &Observables) -> Vec<f64> {
        let time = self.time.at(observables.step);
        let cells: Vec<f64> = self.columns.iter().map(|column| column.value(observables, time)).collect();
        self.rows.push(std::iter::once(observables.step as f64).chain(cells.iter().copied()).collect());
        if observables.step >= self.equilibration {
            self.configuration.push([observables.gradient_squared, observables.laplacian]);
        }
        cells
    }

    /// The last value of a column.
    pub(super) fn last(&self, name: &str) -> Option<f64> {
        let column = 1 + self.columns.iter().position(|column| column.name == name)?;
        self.rows.last().map(|row| row[column])
    }

    /// The step of the last row.
    pub(super) fn last_step(&self) -> Option<u64> {
        self.rows.last().map(|row| row[0] as u64)
    }

    /// The means of all columns after equilibration.
    pub(super) fn means(&self) -> Vec<(&'static str, Option<Estimate>)> {
        let columns = self.columns.iter().enumerate().filter(|(_, column)| column.name != "time");
        columns
            .map(|(index, Column { name, .. })| {
                let mean = if *name == column::CONFIGURATIONAL_TEMPERATURE.name {
                    ratio_of_means(&self.configuration)
                } else {
                    self.mean_of(index, &(self.equilibration..u64::MAX))
                };
                (*name, mean)
            })
            .collect()
    }

    /// The means of the columns over the rows of some steps, but for the configurational temperature, whose sums are not kept.
    pub(super) fn means_of(&self, steps: Range<u64>) -> Vec<(&'static str, Option<Estimate>)> {
        let is_kept = |name| ![column::TIME.name, column::CONFIGURATIONAL_TEMPERATURE.name].contains(&name);
        let columns = self.columns.iter().enumerate().filter(|(_, column)| is_kept(column.name));
        columns.map(|(index, column)| (column.name, self.mean_of(index, &steps))).collect()
    }

    /// The mean of a column over the rows of some steps.
    fn mean_of(&self, index: usize, steps: &Range<u64>) -> Option<Estimate> {
        let rows = self.rows.iter().filter(|row| steps.contains(&(row[0] as u64)));
        estimate(&rows.map(|row| row[index + 1]).collect::<Vec<_>>())
    }

    /// Adds the means after equilibration to a summary, and warns of those that include the way to it where the scene
    /// is about equilibrium.
    pub(super) fn summarise(&self, is_about_equilibrium: bool, summary: &mut Summary) {
        for (name, mean) in self.means() {
            summary.add_mean(name, mean.as_ref());
        }
        if self.are_before_equilibration() {
            let text = format!("`{}` has no row after equilibration, so there are no means", files::ENERGIES);
            summary.warnings.push(text);
        }
        if is_about_equilibrium {
            summary.unequilibrated = settling::unequilibrated(&self.table(), self.equilibration);
            summary.warnings.extend(summary.unequilibrated.as_ref().map(ToString::to_string));
        }
    }

    /// Whether no row is after equilibration.
    pub(super) fn are_before_equilibration(&self) -> bool {
        self.rows.iter().all(|row| row[0] < self.equilibration as f64)
    }

    /// All rows as a table.
    pub(super) fn table(&self) -> Table {
        self.table_of(self.rows.clone())
    }

    /// Those after equilibration.
    pub(super) fn settled(&self) -> Table {
        self.table_of(self.rows.iter().filter(|row| row[0] >= self.equilibration as f64).cloned().collect())
    }

    fn table_of(&self, rows: Vec<Vec<f64>>) -> Table {
        let names = std::iter::once("step").chain(self.columns.iter().map(|column| column.name));
        Table::new(names, rows)
    }
}

/// ⟨a⟩/⟨b⟩. Its error to first order is that of the mean of (a - ⟨a⟩b/⟨b⟩)/⟨b⟩, which is [`estimate`]d.
fn ratio_of_means(pairs: &[[f64; 2]]) -> Option<Estimate> {
    let total = |index: usize| pairs.iter().map(|pair| pair[index]).sum::<f64>();
    let mean_below = total(1) / pairs.len() as f64;
    let ratio = total(0) / total(1);
    if !ratio.is_finite() {
        return None;
    }
    let deviations: Vec<f64> = pairs.iter().map(|[above, below]| (above - ratio * below) / mean_below).collect();
    estimate(&deviations).map(|error| Estimate { value: ratio, ..error })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::statistics::student;

    #[test]
    fn a_mean_ratio_weighs_by_its_denominator() {
        let found = ratio_of_means(&[[1.0, 1.0], [9.0, 3.0]]).unwrap();
        assert_eq!(found.value, 2.5);
        // Deviations (1 - 2.5)/2 and (9 - 7.5)/2: ±0.75, whose mean has the error 0.75.
        assert!((found.error.unwrap() - 0.75 * student(1.0)).abs() < 1e-15);
        assert_eq!(found.samples, 2);
        assert_eq!(ratio_of_means(&[]), None);
        assert_eq!(ratio_of_means(&[[0.0, 0.0]]), None);
    }
}
