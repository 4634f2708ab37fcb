//! Histograms of velocities, speeds and accelerations.

use super::histogram_range::range;
use super::{
    Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting, SumSampler, of_species,
};
use crate::engine::Sample;
use crate::families::Checked;
use crate::measure::histogram::{self, PowerMeans, gaussian_mean, maxwell_mean};
use crate::numbers::grouped;
use crate::plan::Need;
use crate::plot::{Chart, histogram_chart};
use crate::scene::{self, AnalysisId, CountedQuantity, Output};
use crate::shaders::analyses::{Counted, Sampled};
use crate::shaders::{Array, Choices, Constant, Entry};
use crate::table::Table;
use serde_json::{Map, Value, json};

/// Workgroups that count into one histogram: more of them write more often to the same entries.
const GROUPS: u64 = 1024;
/// Entries of a histogram beside its bins: values below, values above, particles far beyond.
const EXTRA: usize = 3;
/// Sums of powers after the counts.
const MOMENTS: usize = 5;
/// Particles further out than this, in ranges, do not enter the sums of powers.
const FARTHEST: f64 = 8.0;

/// Columns of the densities to compare with.
const BELOW: &str = "below";
const ABOVE: &str = "above";
const MEAN: &str = "mean";
const DEVIATION: &str = "standard_deviation";
const KURTOSIS: &str = "kurtosis";
const MEAN_SQUARE: &str = "mean_square";
const VARIANCE_OF_SQUARE: &str = "variance_of_square";
const MAXWELL: &str = "maxwell";
const GAUSSIAN: &str = "gaussian";

/// The histogram of a quantity.
pub(super) struct Histogram(pub CountedQuantity);

impl Histogram {
    fn of<'a>(&self, output: &'a Output) -> Option<&'a scene::Histogram> {
        output.histograms.iter().find(|asked| asked.quantity == self.0)
    }
}

impl Descriptor for Histogram {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let asked = self.of(&scene.output)?;
        let detail = Some(format!("{} bins", grouped(asked.bins.into())));
        Some(Sampling { detail, ..Sampling::after_equilibration(scene, asked.every) })
    }

    fn needs(&self, _: &Output) -> &'static [Need] {
        match self.0 {
            CountedQuantity::Velocity | CountedQuantity::Speed => &[Need::Particles, Need::Momenta],
            CountedQuantity::Acceleration => &[Need::Particles, Need::Forces],
        }
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = self.of(planner.output) else { return };
        let buffers = match self.0 {
            CountedQuantity::Velocity => [Array::VelocityCounts, Array::VelocityCountSamples],
            CountedQuantity::Speed => [Array::SpeedCounts, Array::SpeedCountSamples],
            CountedQuantity::Acceleration => [Array::AccelerationCounts, Array::AccelerationCountSamples],
        };
        let (unit, (choices, before)) = match self.0 {
            CountedQuantity::Velocity | CountedQuantity::Speed => {
                (planner.model.units.momentum, planner.velocities(asked.frame))
            }
            CountedQuantity::Acceleration => {
                (planner.plan.force_unit, (Choices::new().with(Sampled::Acceleration), Vec::new()))
            }
        };
        let groups = planner.groups().min(GROUPS);
        let (particles, species) = planner.particles_of(asked.species.as_deref());
        let (mut constants, counted) = counting(asked, planner, unit, groups);
        constants.extend(species);
        let choices = choices.with(counted).with_any(particles);
        let (id, entries) = (AnalysisId::Histogram(self.0), asked.bins as usize + EXTRA + MOMENTS);
        let sampler = SumSampler::new(id, Entry::CountHistogram, buffers, entries, asked.every);
        planner.add_counts(&SumSampler { choices, constants, before, ..sampler }, groups);
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        // Samples, values below, values above, particles far beyond, powers, and counts.
        vec![Part::sums(1 + EXTRA + MOMENTS + self.of(&scene.output).map_or(0, |asked| asked.bins as usize))]
    }

    fn numbers_of_sample(&self, Setting { scene, plan, .. }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let (counts, rest) = sample.sums.split_at_checked(self.of(&scene.output)?.bins as usize)?;
        let (extra, powers) = rest.split_at_checked(EXTRA)?;
        let quantum = moment_quantum(plan.particles);
        let powers = powers.iter().map(|power| *power as f64 * quantum);
        let [extra, counts] = [extra, counts].map(|found| found.iter().map(|count| *count as f64));
        Some(std::iter::once(1.0).chain(extra).chain(powers).chain(counts).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = self.of(&scene.output)?;
        let ([samples, below, above, far], rest) = gathered.part(0).split_first_chunk()?;
        let (powers, counts) = rest.split_first_chunk()?;
        let (name, speed, range) = (self.0.to_string(), self.0 == CountedQuantity::Speed, range(model, asked));
        let low = if speed { 0.0 } else { -range };
        let histogram =
            histogram::Histogram { range: [low, range], counts: counts.to_vec(), below: *below, above: *above };
        let dimension = model.units.dimension;
        let components = if speed || asked.axis.is_some() { 1.0 } else { dimension as f64 };
        let particles = samples * model.mobile_particles_of(asked.species.as_deref()) as f64 - far;
        let [value, magnitude] = means(powers, range, [particles * components, particles]);
        let densities = histogram.density();
        let rows = histogram.counts.iter().enumerate().map(|(bin, count)| {
            let compared = if speed {
                maxwell_mean(histogram.edges(bin), magnitude.second, dimension)
            } else {
                gaussian_mean(histogram.edges(bin), value.first, value.standard_deviation())
            };
            vec![histogram.centre(bin), densities[bin], *count, compared]
        });
        let compared = if speed { MAXWELL } else { GAUSSIAN };
        let table = Table::new([name.as_str(), "density", "count", compared], rows.collect());
        let total = histogram.total();
        let outside = (histogram.below + histogram.above) / total;
        let mut warnings = Vec::new();
        if outside > 1e-3 {
            warnings.push(format!(
                "{:.2} % of the values of the {name} histogram lie beyond its range of {range:.4}; give it a larger \
                 `output.histograms` range",
                100.0 * outside
            ));
        }
        if *far > 0.0 {
            warnings.push(format!(
                "{far} times a particle was further than {FARTHEST} times the range of the {name} histogram, and is \
                 not in its moments"
            ));
        }
        let result = if *samples == 0.0 {
            Err(NO_SAMPLE.to_owned())
        } else if total == 0.0 {
            Err("there are no particles".to_owned())
        } else {
            let numbers = [
                ("samples", *samples),
                ("values", total),
                ("range", range),
                (BELOW, histogram.below),
                (ABOVE, histogram.above),
                (MEAN, value.first),
                (DEVIATION, value.standard_deviation()),
                (KURTOSIS, value.kurtosis()),
                (MEAN_SQUARE, magnitude.second),
                (VARIANCE_OF_SQUARE, magnitude.variance_of_square()),
            ];
            // Nothing is below a magnitude, of which a kurtosis about zero says nothing.
            let is_found = |name: &str| !speed || ![BELOW, KURTOSIS].contains(&name);
            let found = numbers.into_iter().filter(|(name, _)| is_found(name));
            let result: Map<String, Value> = found.map(|(name, value)| (name.to_owned(), json!(value))).collect();
            Ok(of_species(asked.species.as_deref(), Value::Object(result)))
        };
        Some(Conclusion { warnings, ..Conclusion::new(table, result) })
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        drawn.of_species(density_chart(drawn.title(), drawn.table))
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        let of_components = [BELOW, KURTOSIS].into_iter().filter(|_| self.0 != CountedQuantity::Speed);
        [ABOVE, MEAN, DEVIATION, MEAN_SQUARE, VARIANCE_OF_SQUARE].into_iter().chain(of_components).collect()
    }
}

/// Constants of the kernel that counts values of such a unit in so many workgroups, and what of a vector it counts.
fn counting(
    asked: &scene::Histogram,
    planner: &Planner<'_>,
    unit: f64,
    groups: u64,
) -> (Vec<(Constant, f64)>, Counted) {
    let magnitude = asked.quantity == CountedQuantity::Speed;
    let range = range(planner.model, asked);
    let bins = f64::from(asked.bins);
    let mut constants = vec![
        (Constant::Bins, bins),
        (Constant::Counts, bins + EXTRA as f64),
        // From minus to plus the range there are twice as many half bins as from zero.
        (Constant::HalfBins, if magnitude { 2.0 } else { 1.0 } * bins * unit / range),
        (Constant::HalfBelow, if magnitude { 0.0 } else { bins }),
        (Constant::Fraction, unit / range),
        (Constant::Moment, 1.0 / moment_quantum(planner.plan.particles)),
        (Constant::Groups, groups as f64),
    ];
    if magnitude {
        return (constants, Counted::Magnitude);
    }
    let axes = match asked.axis {
        Some(axis) => [axis as usize, axis as usize + 1],
        None => [0, planner.model.units.dimension],
    };
    constants.extend([(Constant::FirstAxis, axes[0] as f64), (Constant::EndAxis, axes[1] as f64)]);
    (constants, Counted::Components)
}

/// The value of one unit of the powers that are summed, in powers of the range.
pub(super) fn moment_quantum(particles: u64) -> f64 {
    let largest = FARTHEST.powi(4).log2();
    let values = (3.0 * particles.max(1) as f64).log2().ceil();
    (-(62.0 - largest - values).min(40.0)).exp2()
}

/// A histogram from its table: centres of bins, densities, counts, and the density to compare with.
fn density_chart(title: &str, table: &Table) -> Chart {
    let name = |index: usize| table.columns.get(index).map_or("", String::as_str);
    let centres: Vec<f64> = table.column_at(0).collect();
    // A single bin does not tell its width, but its density does, unless nothing was counted.
    let width = match centres.as_slice() {
        [first, .., last] => (last - first) / (centres.len() - 1) as f64,
        _ => 1.0 / table.column_at(1).sum::<f64>(),
    };
    let first = centres.first().map_or(0.0, |first| first - 0.5 * width);
    let edges: Vec<f64> = if width.is_finite() && width > 0.0 {
        (0..=centres.len()).map(|edge| first + edge as f64 * width).collect()
    } else {
        Vec::new()
    };
    let compared: Vec<[f64; 2]> =
        centres.iter().zip(table.column_at(3)).map(|(centre, density)| [*centre, density]).collect();
    let densities: Vec<f64> = table.column_at(1).collect();
    let label = match name(3) {
        MAXWELL => "Maxwell's density",
        _ => "Gaussian of the same variance",
    };
    histogram_chart(title, name(0), &edges, &densities, (label, &compared))
}

/// Means of powers of values and of magnitudes of vectors, of which there are so many, from Σx, Σx², Σx⁴ over values
/// and Σr², Σr⁴ over magnitudes, in units of the range.
fn means(sums: &[f64; MOMENTS], range: f64, [values, particles]: [f64; 2]) -> [PowerMeans; 2] {
    let mean = |sum: usize, power: i32, count: f64| sums[sum] * range.powi(power) / count;
    let of_values = PowerMeans { first: mean(0, 1, values), second: mean(1, 2, values), fourth: mean(2, 4, values) };
    let of_magnitudes = PowerMeans { first: f64::NAN, second: mean(3, 2, particles), fourth: mean(4, 4, particles) };
    [of_values, of_magnitudes]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_powers_fit_64_bits_however_many_particles() {
        for particles in [1, 1000, u64::from(u32::MAX)] {
            let largest = 3.0 * particles as f64 * FARTHEST.powi(4) / moment_quantum(particles);
            assert!(largest <= 2_f64.powi(62), "{particles}: {largest}");
            // And a fourth power at a sixth of the range is still many units.
            assert!(6_f64.powi(-4) / moment_quantum(particles) > 10.0, "{particles}");
        }
    }
}
