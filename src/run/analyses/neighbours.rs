//! Numbers of neighbours of the cells of a tessellation.

use super::{Analysis, Conclusion, Descriptor, Drawn, Gathering, NO_SAMPLE, Sampling, Setting, bytes};
use crate::families::Model;
use crate::measure::neighbours::{MOST_NEIGHBOURS, NeighbourCounts, RANDOM_POINTS};
use crate::measure::statistics::Estimate;
use crate::plot::{Chart, neighbours_chart};
use crate::scene::Scene;
use crate::state::Reported;
use crate::table::Table;
use crate::tessellation::Tessellation;
use serde_json::json;

/// Names in the result.
const MEAN: &str = "mean";
const VARIANCE: &str = "variance";

/// Numbers of neighbours of cells.
pub(super) struct Neighbours;

impl Descriptor for Neighbours {
    fn asked(&self, scene: &Scene, _: &Model) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.neighbours.as_ref()?.every))
    }

    fn begin(&self, _: &Setting<'_>) -> Option<Gathering> {
        Some(Gathering::States(Box::new(Counts::default())))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        neighbours_chart(drawn.title(), drawn.table)
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("neighbours of a cell", MEAN), ("their variance", VARIANCE)]
    }
}

/// Cells by their number of neighbours, over all samples.
#[derive(Debug, Clone, PartialEq, Default)]
struct Counts {
    /// Step of the last sample.
    last: Option<u64>,
    counts: NeighbourCounts,
}

impl Analysis for Counts {
    fn add_state(&mut self, state: &Reported, model: &Model) {
        if self.last.is_none_or(|last| last < state.step) {
            self.last = Some(state.step);
            let lengths = [model.units.lengths[0], model.units.lengths[1]];
            self.counts.push(&Tessellation::of_fractions(lengths, &state.positions));
        }
    }

    fn section(&self) -> Vec<u8> {
        let last = self.last.map(|last| last as f64);
        bytes(last.into_iter().chain(self.counts.numbers()))
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        let width = MOST_NEIGHBOURS as u64 + 1;
        if samples > 0 { samples.saturating_mul(width).saturating_add(1) } else { 0 }
    }

    fn restore(&mut self, numbers: &[f64], _: u64) {
        if let [last, counts @ ..] = numbers {
            *self = Self { last: Some(*last as u64), counts: NeighbourCounts::restored(counts) };
        }
    }

    fn conclude(&self) -> Conclusion {
        let counts = &self.counts;
        let result = if counts.is_empty() {
            Err(NO_SAMPLE.to_owned())
        } else {
            Ok(json!({ "samples": counts.len(), MEAN: counts.mean(), VARIANCE: counts.variance() }))
        };
        Conclusion::new(fractions(counts), result)
    }
}

/// Fractions of cells by their number of neighbours, from the smallest number found to the largest.
fn fractions(counts: &NeighbourCounts) -> Table {
    let found: Vec<(usize, Estimate)> =
        (0..=MOST_NEIGHBOURS).filter_map(|number| Some((number, counts.fraction(number)?))).collect();
    let there = |(_, fraction): &&(usize, Estimate)| fraction.mean > 0.0;
    let range = [found.iter().find(there), found.iter().rfind(there)].map(|end| end.map(|(number, _)| *number));
    let within =
        |number: usize| range[0].is_some_and(|low| low <= number) && range[1].is_some_and(|high| high >= number);
    let row = |(number, fraction): &(usize, Estimate)| {
        let error = fraction.standard_error.unwrap_or(f64::NAN);
        let random = RANDOM_POINTS.get(*number).copied().unwrap_or(0.0);
        vec![*number as f64, fraction.mean, error, random]
    };
    let rows = found.iter().filter(|(number, _)| within(*number)).map(row).collect();
    Table::new(["neighbours", "fraction", "fraction_error", "random_points"], rows)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::initial_state;

    #[test]
    fn samples_survive_a_checkpoint_and_come_once() {
        let scene = super::super::shear_wave::tests::scene();
        let model = Model::new(&scene);
        let mut state: Reported = initial_state(&scene, &model).into();
        let mut counts = Counts::default();
        for step in [0, 10, 10, 5] {
            state.step = step;
            counts.add_state(&state, &model);
        }
        assert_eq!(counts.counts.len(), 2);
        let mut restored = Counts::default();
        let section = counts.section();
        assert_eq!(section.len() as u64, 8 * counts.numbers_after(2));
        let numbers: Vec<f64> = section.as_chunks().0.iter().map(|word| f64::from_le_bytes(*word)).collect();
        restored.restore(&numbers, 2);
        assert_eq!(restored, counts);
        assert_ne!(restored, Counts::default());
        let table = fractions(&counts.counts);
        assert!((table.column("fraction").unwrap().iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}
