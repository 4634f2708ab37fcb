//! Sizes of chains: mean squared distance of the ends and radius of gyration.

use super::{Analysis, Conclusion, Setting, bytes};
use crate::engine::Sample;
use crate::families::ChainGroup;
use crate::measure::statistics::estimate;
use crate::output::files;
use crate::table::Table;
use serde_json::{Value, json};

/// Mean sizes of the chains of each group, sample by sample.
pub(super) struct ChainSizes {
    groups: Vec<ChainGroup>,
    /// Name of each group's species.
    names: Vec<String>,
    time_step: f64,
    scale: f64,
    /// A step, then two means for each group.
    rows: Vec<Vec<f64>>,
}

impl ChainSizes {
    pub(super) fn new(setting: &Setting<'_>) -> Self {
        let model = setting.model;
        Self {
            groups: model.chain_groups().to_vec(),
            names: model
                .chain_groups()
                .iter()
                .map(|group| model.species[group.species as usize].name.clone())
                .collect(),
            time_step: model.time_step,
            scale: setting.plan.quanta.length_squared,
            rows: Vec::new(),
        }
    }

    fn result(&self, number: usize) -> Value {
        let group = self.groups[number];
        let column = |index: usize| -> Value {
            let series: Vec<f64> = self.rows.iter().map(|row| row[1 + 2 * number + index]).collect();
            json!(estimate(&series))
        };
        json!({
            "species": self.names[number],
            "chains": group.chains,
            "beads": group.beads,
            // The last bead of a ring is next to its first, and their distance that of a bond.
            "end_to_end_squared": if group.closed { Value::Null } else { column(0) },
            "radius_of_gyration_squared": column(1),
        })
    }
}

impl Analysis for ChainSizes {
    fn name(&self) -> &'static str {
        "chain_sizes"
    }

    fn add(&mut self, sample: &Sample) {
        let means = sample.sums.iter().enumerate().map(|(index, sum)| {
            let chains = self.groups.get(index / 2).map_or(1, |group| group.chains.max(1));
            *sum as f64 * self.scale / f64::from(chains)
        });
        self.rows.push(std::iter::once(sample.step as f64).chain(means).collect());
    }

    fn section(&self) -> Vec<u8> {
        bytes(self.rows.iter().flatten().copied())
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        samples.saturating_mul(1 + 2 * self.groups.len() as u64)
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.rows = numbers.chunks_exact(1 + 2 * self.groups.len()).map(<[f64]>::to_vec).collect();
    }

    fn conclude(&self) -> Conclusion {
        let columns = (0..self.groups.len()).flat_map(|number| {
            ["end_to_end_squared", "radius_of_gyration_squared"].map(|quantity| format!("{quantity}_{number}"))
        });
        let timed = |row: &Vec<f64>| [&[row[0] * self.time_step], &row[1..]].concat();
        let table = Table {
            columns: std::iter::once("time".to_owned()).chain(columns).collect(),
            rows: self.rows.iter().map(timed).collect(),
        };
        let result = if self.rows.is_empty() {
            Err("no sample was taken after equilibration".to_owned())
        } else {
            Ok((0..self.groups.len()).map(|number| self.result(number)).collect())
        };
        Conclusion::new(files::CHAIN_SIZES, table, result)
    }
}
