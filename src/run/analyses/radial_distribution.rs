//! The radial distribution function.

use super::pair_histogram::PairHistogram;
use super::species_pairs::{SPECIES, SpeciesPairs, names, pair_in_words, printed_peaks, results_of};
use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting, species_of};
use crate::engine::Sample;
use crate::families::Checked;
use crate::measure::blocks::BlockSums;
use crate::measure::peak::peak;
use crate::measure::statistics::Estimate;
use crate::plan::Need;
use crate::plot::{Chart, Series, radial_distribution_chart};
use crate::scene::Output;
use crate::table::Table;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Columns of the table, and names in the result.
const DISTANCE: &str = "distance";
const VALUE: &str = "radial_distribution";
const COUNTED: &str = "pairs";
const PEAK_DISTANCE: &str = "peak_distance";
const PEAK_HEIGHT: &str = "peak_height";

/// Bins with fewer pairs, and fewer still if particles were spread evenly, are known to no better than a fifth: they are not shown, nor searched for
/// the peak.
const FEW: f64 = 25.0;

/// The radial distribution function.
pub(super) struct RadialDistribution;

impl Descriptor for RadialDistribution {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.radial_distribution.as_ref()?.every))
    }

    fn needs(&self, _: &Output) -> &'static [Need] {
        &[Need::Order]
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let (Some(asked), Some(ordered)) = (&planner.output.radial_distribution, planner.ordered) else { return };
        let model = planner.model;
        let histogram = PairHistogram {
            units: &model.units,
            walled: !model.particles().walls.is_empty(),
            grid: &ordered.grid,
            options: planner.options,
            asked,
            pairs: SpeciesPairs::of(asked.species.as_ref(), model),
        };
        histogram.add(planner, ordered);
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        // Pairs by distance. Their errors stand in a chart, where a tenth of them does not show.
        let asked = scene.output.radial_distribution.iter();
        asked
            .map(|asked| u64::from(asked.bins) * SpeciesPairs::of(asked.species.as_ref(), scene.model()).curves())
            .map(|bins| Part::Blocks(BlockSums::with_most(bins as usize, 64)))
            .collect()
    }

    fn numbers_of_sample(&self, _: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        Some(sample.sums.iter().map(|count| *count as f64).collect())
    }

    fn conclude(&self, Setting { scene, plan }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = scene.output.radial_distribution.as_ref()?;
        let pairs = SpeciesPairs::of(asked.species.as_ref(), model);
        let counts = gathered.blocks()?;
        let units = &model.units;
        // Distances of walls that face each other.
        let gaps: Vec<f64> = model.particles().walls.iter().map(|walls| units.edges()[walls.axis]).collect();
        let width = asked.range / f64::from(asked.bins);
        let ball = |radius: f64| ball(radius, units.dimension, &gaps);
        let shells: Vec<f64> = (0..asked.bins)
            .map(|bin| (ball(f64::from(bin + 1) * width) - ball(f64::from(bin) * width)) / units.volume())
            .collect();
        let of_species = |number: usize| model.species.get(number).filter(|species| !species.frozen);
        let particles = |number: usize| of_species(number).map_or(0.0, |species| species.count as f64);
        let species = pairs.species();
        let alike = (plan.particles - model.frozen_particles()) as f64;
        let within = |particles: f64| 0.5 * particles * (particles - 1.0);
        let number_of_pairs = |place: usize| match species.get(place) {
            None => within(alike),
            Some([a, b]) if a == b => within(particles(*a)),
            Some([a, b]) => particles(*a) * particles(*b),
        };
        let curve = |place: usize| Curve { place, counts, pairs: number_of_pairs(place), shells: &shells, width };
        let curves: Vec<Curve<'_>> = (0..pairs.curves() as usize).map(curve).collect();
        // A pair of species without particles has no curve, beside others that have one.
        let some = curves.iter().any(|curve| curve.pairs > 0.0);
        let curves: Vec<Curve<'_>> = curves.into_iter().filter(|curve| !some || curve.pairs > 0.0).collect();
        let rows = (0..shells.len()).map(|bin| {
            let cells = curves.iter().flat_map(|curve| curve.cells(bin));
            std::iter::once((bin as f64 + 0.5) * width).chain(cells).collect()
        });
        let columns = curves.iter().map(|curve| pairs.suffix(curve.place)).flat_map(|suffix| {
            [format!("{VALUE}{suffix}"), format!("{VALUE}{suffix}_error"), format!("{COUNTED}{suffix}")]
        });
        let table = Table::new([DISTANCE.to_owned()].into_iter().chain(columns), rows.collect());
        let mut warnings = Vec::new();
        let result = if counts.samples() == 0 {
            Err(NO_SAMPLE.to_owned())
        } else if !some {
            Err("there are no pairs of particles".to_owned())
        } else {
            let mut found: Vec<Value> = Vec::new();
            for curve in &curves {
                let [distance, height] = [0, 1].map(|part| counts.jackknife(|means| Some(curve.peak(means)?[part])));
                let mut result = json!({ "samples": counts.samples(), PEAK_DISTANCE: distance, PEAK_HEIGHT: height });
                let pair = pairs.names(curve.place, model);
                if let Some(pair) = pair {
                    result[SPECIES] = json!(pair);
                }
                found.push(result);
                if (0..shells.len()).all(|bin| curve.has_few(bin)) {
                    let of = pair_in_words(pair.into_iter().flatten()).map(|pair| format!(" of {pair}"));
                    warnings.push(format!(
                        "no bin of g(r){} holds {FEW} pairs: take more samples or fewer bins",
                        of.unwrap_or_default()
                    ));
                }
            }
            Ok(pairs.result(found))
        };
        Some(Conclusion { warnings, ..Conclusion::new(table, result) })
    }

    fn species_of(&self, scene: &Checked, numbers: &[usize]) -> Vec<String> {
        species_of(scene, numbers)
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let columns = drawn.table.columns.iter().filter(|name| name.starts_with(VALUE) && !name.ends_with("_error"));
        let curve = |(column, result): (&String, &Value)| {
            let counted = drawn.column(&column.replacen(VALUE, COUNTED, 1));
            let values = drawn.column(column);
            // Counted pairs over g are those of an ideal gas, of which shells have the fewer the smaller they are.
            let has_few = |(value, count): (&f64, &f64)| *count > 0.0 && *count < FEW && count / value < FEW;
            let few = values.iter().zip(&counted).rposition(has_few).map_or(0, |row| row + 1);
            let is_shown = |row: usize| row >= few || counted.get(row).is_none_or(|count| *count >= FEW);
            let shown = values.iter().enumerate().map(|(row, value)| if is_shown(row) { *value } else { f64::NAN });
            let points = drawn.column(DISTANCE).into_iter().zip(shown).map(|(distance, value)| [distance, value]);
            let name = pair_in_words(names(result)).unwrap_or_else(|| "g(r)".to_owned());
            Series::line(&name, points.collect())
                .with_band(drawn.column(&format!("{column}_error")))
                .with_ink(drawn.ink(result))
        };
        radial_distribution_chart(drawn.title(), columns.zip(results_of(drawn.result)).map(curve).collect())
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        printed_peaks(result, "g(r)", [PEAK_HEIGHT, PEAK_DISTANCE])
    }

    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let asked = scene.output.radial_distribution.as_ref();
        let pairs = asked.map(|asked| SpeciesPairs::of(asked.species.as_ref(), scene.model()));
        pairs.filter(|pairs| !pairs.are_all()).map_or_else(Vec::new, |_| vec![PEAK_DISTANCE, PEAK_HEIGHT])
    }
}

/// One g(r), from the counts of pairs by distance.
struct Curve<'a> {
    place: usize,
    counts: &'a BlockSums,
    /// Pairs of particles, at all distances.
    pairs: f64,
    /// The part of the volume in each shell.
    shells: &'a [f64],
    width: f64,
}

impl Curve<'_> {
    /// The place of a bin among all counts.
    fn of(&self, bin: usize) -> usize {
        self.place * self.shells.len() + bin
    }

    /// Pairs of a sample in a bin, if particles were spread evenly.
    fn even(&self, bin: usize) -> f64 {
        self.pairs * self.shells[bin]
    }

    /// Value, error and counted pairs of a bin.
    fn cells(&self, bin: usize) -> [f64; 3] {
        let found = self.counts.mean(|row| row[self.of(bin)] / self.even(bin));
        let [value, error] = found.map_or([f64::NAN; 2], Estimate::cells);
        [value, error, self.counts.total(self.of(bin))]
    }

    fn has_few(&self, bin: usize) -> bool {
        let even = self.counts.samples() as f64 * self.even(bin);
        even.max(self.counts.total(self.of(bin))) < FEW
    }

    /// Place and height of the maximum, from mean counts; bins of a few pairs are left out.
    fn peak(&self, means: &[f64]) -> Option<[f64; 2]> {
        let bins = (0..self.shells.len()).skip_while(|bin| self.has_few(*bin));
        let row = |bin: usize| [(bin as f64 + 0.5) * self.width, means[self.of(bin)] / self.even(bin)];
        peak(&bins.map(row).collect::<Vec<_>>())
    }
}

/// The mean volume that particles spread evenly have within a radius around each other: of a ball, less what of it lies
/// behind walls at these distances from each other.
///
/// The part of the places whose copy displaced by `d` is still between the walls is the product of `1 − |dₐ|/Lₐ` over
/// the axes across which there are walls; its mean over all directions needs those of `|x|`, `|x y|` and `|x y z|` on a
/// sphere or a circle.
fn ball(radius: f64, dimension: usize, gaps: &[f64]) -> f64 {
    let inverse: Vec<f64> = gaps.iter().map(|gap| 1.0 / gap).collect();
    let singles: f64 = inverse.iter().sum();
    let pairs: f64 = inverse.iter().enumerate().flat_map(|(i, a)| inverse[..i].iter().map(move |b| a * b)).sum();
    let triple: f64 = if inverse.len() == 3 { inverse.iter().product() } else { 0.0 };
    let r = radius;
    match dimension {
        1 => 2.0 * r - singles * r * r,
        2 => PI * r * r - 4.0 / 3.0 * singles * r.powi(3) + 0.5 * pairs * r.powi(4),
        _ => {
            4.0 / 3.0 * PI * r.powi(3) - 0.5 * PI * singles * r.powi(4) + 8.0 / 15.0 * pairs * r.powi(5)
                - triple * r.powi(6) / 6.0
        }
    }
}
