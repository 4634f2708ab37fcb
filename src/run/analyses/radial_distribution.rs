//! The radial distribution function.

use super::pair_histogram::{PairHistogram, SpeciesPairs};
use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting};
use crate::engine::Sample;
use crate::families::Checked;
use crate::plan::Need;
use crate::plot::{Chart, radial_distribution_chart};
use crate::printable;
use crate::scene::{Output, SpeciesNames};
use crate::table::Table;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::f64::consts::PI;

/// Columns of the table, and names in the result.
const DISTANCE: &str = "distance";
const VALUE: &str = "radial_distribution";
const PEAK_DISTANCE: &str = "peak_distance";
const PEAK_HEIGHT: &str = "peak_height";
/// The pairs of species of a result, and the two species of a pair.
const PAIRS: &str = "pairs";
const SPECIES: &str = "species";

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
            pairs: SpeciesPairs::of(asked, model),
        };
        histogram.add(planner, ordered);
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        // Samples, and pairs by distance.
        let bins = scene
            .output
            .radial_distribution
            .as_ref()
            .map_or(0, |asked| u64::from(asked.bins) * SpeciesPairs::of(asked, scene.model()).histograms());
        vec![Part::sums(1 + bins as usize)]
    }

    fn numbers_of_sample(&self, _: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        Some(std::iter::once(1.0).chain(sample.sums.iter().map(|count| *count as f64)).collect())
    }

    fn conclude(&self, Setting { scene, plan }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = scene.output.radial_distribution.as_ref()?;
        let pairs = SpeciesPairs::of(asked, model);
        let (samples, counts) = gathered.part(0).split_first()?;
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
        let exist = |place: &usize| number_of_pairs(*place) > 0.0;
        let places = 0..counts.len() / shells.len();
        // A pair of species without particles has no curve, beside others that have one.
        let some = places.clone().any(|place| exist(&place));
        let places: Vec<usize> = places.filter(|place| !some || exist(place)).collect();
        let curve = |&place: &usize| -> Vec<[f64; 2]> {
            let counts = &counts[place * shells.len()..][..shells.len()];
            let expected = shells.iter().map(|shell| samples * number_of_pairs(place) * shell);
            let values = counts.iter().zip(expected).map(|(count, expected)| count / expected);
            values.enumerate().map(|(bin, value)| [(bin as f64 + 0.5) * width, value]).collect()
        };
        let curves: Vec<Vec<[f64; 2]>> = places.iter().map(curve).collect();
        let rows = (0..shells.len()).map(|bin| {
            let values = curves.iter().map(|curve| curve[bin][1]);
            std::iter::once((bin as f64 + 0.5) * width).chain(values).collect()
        });
        let is_of_all_pairs = matches!(pairs, SpeciesPairs::All(_));
        let column = |place: &usize| if is_of_all_pairs { column_of(species[*place]) } else { VALUE.to_owned() };
        let table = Table::new([DISTANCE.to_owned()].into_iter().chain(places.iter().map(column)), rows.collect());
        let result = if *samples == 0.0 {
            Err(NO_SAMPLE.to_owned())
        } else if !some {
            Err("there are no pairs of particles".to_owned())
        } else {
            let name = |number: usize| model.species.get(number).map_or("", |species| &species.name);
            let found = places.iter().zip(&curves).map(|(place, curve)| {
                let [distance, height] = peak(curve).map_or([None; 2], |peak| peak.map(Some));
                let mut found = json!({ "samples": samples, PEAK_DISTANCE: distance, PEAK_HEIGHT: height });
                if let Some(pair) = species.get(*place) {
                    found[SPECIES] = json!(pair.map(name));
                }
                found
            });
            let mut found: Vec<Value> = found.collect();
            Ok(if is_of_all_pairs { json!({ PAIRS: found }) } else { found.swap_remove(0) })
        };
        Some(Conclusion::new(table, result))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let species = SpeciesNames::of(drawn.scene);
        let label = |column: &String| {
            let numbers: Option<Vec<usize>> =
                column.strip_prefix(VALUE)?.split('_').skip(1).map(|number| number.parse().ok()).collect();
            let names: Option<Vec<&&str>> = numbers?.into_iter().map(|number| species.names().get(number)).collect();
            pair_in_words(names?.into_iter().copied())
        };
        let curve = |column: &String| {
            let label = label(column).or_else(|| pair_in_words(names(drawn.result)));
            (label.unwrap_or_else(|| "g(r)".to_owned()), drawn.column(column))
        };
        let curves: Vec<(String, Vec<f64>)> =
            drawn.table.columns.iter().filter(|column| column.starts_with(VALUE)).map(curve).collect();
        radial_distribution_chart(drawn.title(), &drawn.column(DISTANCE), &curves)
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let line = |peaks: &Value| {
            let [distance, height] = [PEAK_DISTANCE, PEAK_HEIGHT].map(|key| peaks[key].as_f64());
            let pair = pair_in_words(names(peaks)).map(|pair| format!(" of {pair}")).unwrap_or_default();
            Some((format!("g(r) peak{pair}"), format!("{:.3} at {:.3}", height?, distance?)))
        };
        match result[PAIRS].as_array() {
            Some(pairs) => pairs.iter().filter_map(line).collect(),
            None => line(result).into_iter().collect(),
        }
    }

    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let asked = scene.output.radial_distribution.as_ref();
        match asked.map(|asked| SpeciesPairs::of(asked, scene.model())) {
            Some(SpeciesPairs::All(_)) => Vec::new(),
            _ => vec![PEAK_DISTANCE, PEAK_HEIGHT],
        }
    }
}

/// The column of a pair of species, by their numbers.
fn column_of([a, b]: [usize; 2]) -> String {
    format!("{VALUE}_{a}_{b}")
}

/// The names of the species of a pair, if a result is of one.
fn names(result: &Value) -> impl Iterator<Item = &str> {
    result[SPECIES].as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// The names of two species for people; none if these are not two.
fn pair_in_words<'a>(names: impl Iterator<Item = &'a str>) -> Option<String> {
    let names: Vec<Cow<'_, str>> = names.map(printable::name).collect();
    (names.len() == 2).then(|| names.join("–"))
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

/// Bins on each side of the highest that a parabola is fitted to: noise makes the highest single bin too high.
const PEAK_BINS: usize = 4;

/// Place and height of the maximum of (x, y) rows; none without a positive value, nor where the last bins are the highest: what lies
/// beyond the range may be higher. Near contact the highest bin is taken.
fn peak(rows: &[[f64; 2]]) -> Option<[f64; 2]> {
    let highest =
        (0..rows.len()).filter(|bin| rows[*bin][1] > 0.0).max_by(|a, b| rows[*a][1].total_cmp(&rows[*b][1]))?;
    let plain = Some([rows[highest][0], rows[highest][1]]);
    let Some(first) = highest.checked_sub(PEAK_BINS) else { return plain };
    let window = rows.get(first..=highest + PEAK_BINS)?;
    // Least squares in units of bins from the middle, where odd moments vanish.
    let half = PEAK_BINS as f64;
    let offsets = || (0..window.len()).map(|bin| bin as f64 - half);
    let moment = |power: i32| offsets().map(|x| x.powi(power)).sum::<f64>();
    let product = |power: i32| offsets().zip(window).map(|(x, row)| x.powi(power) * row[1]).sum::<f64>();
    let (count, second, fourth) = (window.len() as f64, moment(2), moment(4));
    let curvature = (count * product(2) - second * product(0)) / (count * fourth - second * second);
    let level = (product(0) - curvature * second) / count;
    let slope = product(1) / second;
    let top = -slope / (2.0 * curvature);
    if curvature < 0.0 && top.abs() <= half {
        let bin = window[1][0] - window[0][0];
        Some([rows[highest][0] + top * bin, level + 0.5 * slope * top])
    } else {
        plain
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_peak_of_a_parabola_is_found_between_bins() {
        let rows: Vec<[f64; 2]> = (0..40)
            .map(|bin| 0.02 * (f64::from(bin) + 0.5))
            .map(|x| [x, 1.2 - 3.0 * (x - 0.433_f64).powi(2)])
            .collect();
        let [place, height] = peak(&rows).unwrap();
        assert!((place - 0.433).abs() < 1e-12 && (height - 1.2).abs() < 1e-12, "{place} {height}");
        assert_eq!(peak(&[[1.0, 2.0], [2.0, 1.0]]), Some([1.0, 2.0]));
        assert_eq!(peak(&[[1.0, 0.0]]), None);
        let rising: Vec<[f64; 2]> = (0..20).map(|bin| [f64::from(bin), f64::from(bin)]).collect();
        assert_eq!(peak(&rising), None);
        assert_eq!(peak(&[[1.0, f64::NAN]]), None);
    }
}
