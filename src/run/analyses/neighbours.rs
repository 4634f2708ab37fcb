//! Numbers of neighbours of the cells of a tessellation.

use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Sampling, Setting};
use crate::families::Checked;
use crate::measure::neighbours::{MOST_NEIGHBOURS, NeighbourCounts, RANDOM_POINTS};
use crate::measure::statistics::Estimate;
use crate::plot::{Chart, neighbours_chart};
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
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.neighbours.as_ref()?.every))
    }

    fn takes_states(&self) -> bool {
        true
    }

    fn parts(&self, _: &Checked) -> Vec<Part> {
        // The step, and the cells with each number of neighbours.
        vec![Part::Last(1, Vec::new()), Part::series(MOST_NEIGHBOURS + 1)]
    }

    fn numbers_of_state(&self, Setting { scene, .. }: &Setting<'_>, state: &Reported) -> Option<Vec<f64>> {
        let model = scene.model();
        let lengths = [model.units.lengths[0], model.units.lengths[1]];
        let counts = NeighbourCounts::of_cells(&Tessellation::of_fractions(lengths, &state.positions));
        Some([&[state.step as f64], &counts[..]].concat())
    }

    fn conclude(&self, _: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let counts = NeighbourCounts::from_samples(gathered.part(1).as_chunks().0);
        let result = if counts.is_empty() {
            Err(NO_SAMPLE.to_owned())
        } else {
            Ok(json!({ "samples": counts.len(), MEAN: counts.mean(), VARIANCE: counts.variance() }))
        };
        Some(Conclusion::new(fractions(&counts), result))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        neighbours_chart(drawn.title(), drawn.table)
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("neighbours of a cell", MEAN), ("their variance", VARIANCE)]
    }
}

/// Fractions of cells by their number of neighbours, from the smallest number found to the largest.
fn fractions(counts: &NeighbourCounts) -> Table {
    let found: Vec<(usize, Estimate)> =
        (0..=MOST_NEIGHBOURS).filter_map(|number| Some((number, counts.fraction(number)?))).collect();
    let there = |(_, fraction): &&(usize, Estimate)| fraction.value > 0.0;
    let range = [found.iter().find(there), found.iter().rfind(there)].map(|end| end.map(|(number, _)| *number));
    let within =
        |number: usize| range[0].is_some_and(|low| low <= number) && range[1].is_some_and(|high| high >= number);
    let row = |(number, fraction): &(usize, Estimate)| {
        let error = fraction.error.unwrap_or(f64::NAN);
        let random = RANDOM_POINTS.get(*number).copied().unwrap_or(0.0);
        vec![*number as f64, fraction.value, error, random]
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
    fn fractions_of_all_cells_add_up() {
        let scene = super::super::shear_wave::tests::scene();
        let model = scene.model();
        let state: Reported = initial_state(&scene).into();
        let cells = Tessellation::of_fractions([model.units.lengths[0], model.units.lengths[1]], &state.positions);
        let table = fractions(&NeighbourCounts::from_samples(&[NeighbourCounts::of_cells(&cells)]));
        assert!((table.column("fraction").unwrap().iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}
