//! The radial distribution function.

use super::pair_histogram::PairHistogram;
use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting};
use crate::engine::Sample;
use crate::families::Checked;
use crate::plan::Need;
use crate::plot::{Chart, radial_distribution_chart};
use crate::scene::Output;
use crate::table::Table;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Columns of the table, and names in the result.
const DISTANCE: &str = "distance";
const VALUE: &str = "radial_distribution";
const PEAK_DISTANCE: &str = "peak_distance";
const PEAK_HEIGHT: &str = "peak_height";

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
        };
        histogram.add(planner, ordered);
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        // Samples, and pairs by distance.
        vec![Part::sums(1 + scene.output.radial_distribution.as_ref().map_or(0, |asked| asked.bins as usize))]
    }

    fn numbers_of_sample(&self, _: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        Some(std::iter::once(1.0).chain(sample.sums.iter().map(|count| *count as f64)).collect())
    }

    fn conclude(&self, Setting { scene, plan }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let range = scene.output.radial_distribution.as_ref()?.range;
        let (samples, counts) = gathered.part(0).split_first()?;
        let (units, particles) = (&model.units, (plan.particles - model.frozen_particles()) as f64);
        // Distances of walls that face each other.
        let gaps: Vec<f64> = model.particles().walls.iter().map(|walls| units.edges()[walls.axis]).collect();
        let width = range / counts.len() as f64;
        let pairs = 0.5 * particles * (particles - 1.0);
        let ball = |radius: f64| ball(radius, units.dimension, &gaps);
        let rows = counts.iter().enumerate().map(|(bin, count)| {
            let inner = bin as f64 * width;
            let expected = samples * pairs * (ball(inner + width) - ball(inner)) / units.volume();
            vec![inner + 0.5 * width, count / expected]
        });
        let rows: Vec<Vec<f64>> = rows.collect();
        let [distance, height] = peak(&rows).map_or([None; 2], |peak| peak.map(Some));
        let result = if *samples == 0.0 {
            Err(NO_SAMPLE.to_owned())
        } else if pairs <= 0.0 {
            Err("there are no pairs of particles".to_owned())
        } else {
            Ok(json!({ "samples": samples, PEAK_DISTANCE: distance, PEAK_HEIGHT: height }))
        };
        Some(Conclusion::new(Table::new([DISTANCE, VALUE], rows), result))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        radial_distribution_chart(drawn.title(), &drawn.column(DISTANCE), &drawn.column(VALUE))
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let Some(height) = result[PEAK_HEIGHT].as_f64() else { return Vec::new() };
        let distance = result[PEAK_DISTANCE].as_f64().unwrap_or(f64::NAN);
        vec![("g(r) peak".to_owned(), format!("{height:.3} at {distance:.3}"))]
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        vec![PEAK_DISTANCE, PEAK_HEIGHT]
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

/// Bins on each side of the highest that a parabola is fitted to: noise makes the highest single bin too high.
const PEAK_BINS: usize = 4;

/// Place and height of the maximum of (x, y) rows; none without a positive value. At the edges the highest bin is taken.
fn peak(rows: &[Vec<f64>]) -> Option<[f64; 2]> {
    let highest =
        (0..rows.len()).filter(|bin| rows[*bin][1] > 0.0).max_by(|a, b| rows[*a][1].total_cmp(&rows[*b][1]))?;
    let plain = Some([rows[highest][0], rows[highest][1]]);
    let Some(first) = highest.checked_sub(PEAK_BINS) else { return plain };
    let Some(window) = rows.get(first..=highest + PEAK_BINS) else { return plain };
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
        let rows: Vec<Vec<f64>> = (0..40)
            .map(|bin| 0.02 * (f64::from(bin) + 0.5))
            .map(|x| vec![x, 1.2 - 3.0 * (x - 0.433_f64).powi(2)])
            .collect();
        let [place, height] = peak(&rows).unwrap();
        assert!((place - 0.433).abs() < 1e-12 && (height - 1.2).abs() < 1e-12, "{place} {height}");
        assert_eq!(peak(&[vec![1.0, 2.0], vec![2.0, 1.0]]), Some([1.0, 2.0]));
        assert_eq!(peak(&[vec![1.0, 0.0]]), None);
        assert_eq!(peak(&[vec![1.0, f64::NAN]]), None);
    }
}
