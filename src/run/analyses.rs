//! What is gathered from the samplers beside the observables, and what comes out in the end.

use super::RunError;
use super::circulations::Circulations;
use crate::engine::Sample;
use crate::measure::correlation::{
    ShearViscosity, TransverseMode, WindowedAverage, diffusion_from_displacement, diffusion_from_velocity,
    shear_viscosity,
};
use crate::model::Model;
use crate::output::{RunDirectory, Summary, Table, files, write_table};
use crate::plan::Plan;
use crate::scene::Scene;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// Real numbers as bytes of a checkpoint.
pub(super) fn bytes(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(f64::to_le_bytes).collect()
}

/// The numbers that [`bytes`] wrote.
pub(super) fn numbers(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks_exact(8).map(|word| f64::from_bits(bytemuck::pod_read_unaligned::<u64>(word).to_le())).collect()
}

const RADIAL_DISTRIBUTION: &str = "radial_distribution";
const DIFFUSION: &str = "diffusion";
const VISCOSITY: &str = "viscosity";
const CIRCULATION: &str = "tracers";

/// The analyses that a scene asks for.
pub(super) struct Analyses {
    particles: f64,
    volume: f64,
    dimension: usize,
    mass: f64,
    gathered: Vec<(usize, Gathered)>,
}

/// Sums of one sampler.
enum Gathered {
    RadialDistribution { range: f64, samples: f64, counts: Vec<f64> },
    Diffusion { interval: f64, window: usize, scales: [f64; 2], displacement: Vec<f64>, velocity: Vec<f64> },
    Viscosity { interval: f64, window: usize, unit: f64, modes: Vec<TransverseMode> },
    Circulation(Circulations),
}

impl Analyses {
    /// Begins the analyses, or goes on from the sections of a checkpoint.
    pub(super) fn new(scene: &Scene, model: &Model, plan: &Plan, sections: &[(String, Vec<u8>)]) -> Self {
        let mut gathered = Vec::new();
        for (index, sampler) in plan.samplers.iter().enumerate() {
            let interval = sampler.every as f64 * scene.time.step;
            let mut entry = match sampler.name {
                RADIAL_DISTRIBUTION => Gathered::RadialDistribution {
                    range: scene.output.radial_distribution.as_ref().map_or(0.0, |asked| asked.range),
                    samples: 0.0,
                    counts: vec![0.0; sampler.quantities],
                },
                DIFFUSION => Gathered::Diffusion {
                    interval,
                    window: scene.output.diffusion.as_ref().map_or(2, |asked| asked.window as usize),
                    scales: [plan.quanta.length_squared, plan.quanta.velocity_squared],
                    displacement: Vec::new(),
                    velocity: Vec::new(),
                },
                VISCOSITY => Gathered::Viscosity {
                    interval,
                    window: scene.output.viscosity.as_ref().map_or(8, |asked| asked.window as usize),
                    unit: model.units.momentum,
                    modes: transverse_modes(model),
                },
                CIRCULATION => match &model.shallow_water {
                    Some(water) => Gathered::Circulation(Circulations::new(model, water)),
                    None => continue,
                },
                _ => continue,
            };
            if let Some((_, section)) = sections.iter().find(|(name, _)| name == entry.name()) {
                entry.restore(&numbers(section));
            }
            gathered.push((index, entry));
        }
        Self {
            particles: plan.particles as f64,
            volume: model.units.volume(),
            dimension: model.units.dimension,
            mass: model.species.iter().map(|species| species.mass * species.count as f64).sum(),
            gathered,
        }
    }

    /// Adds a sample of any sampler but the first.
    pub(super) fn add(&mut self, sample: &Sample) {
        if let Some((_, gathered)) = self.gathered.iter_mut().find(|(index, _)| *index == sample.sampler) {
            gathered.add(sample, self.particles);
        }
    }

    /// What a checkpoint has to keep.
    pub(super) fn sections(&self) -> Vec<(String, Vec<u8>)> {
        self.gathered.iter().map(|(_, gathered)| (gathered.name().to_owned(), gathered.section())).collect()
    }

    /// Whether a resumed run measures anything otherwise than an uninterrupted one.
    pub(super) fn restarts_windows(&self) -> bool {
        self.gathered.iter().any(|(_, gathered)| matches!(gathered, Gathered::Diffusion { .. }))
    }

    /// Writes the tables and adds the results, or why there are none, to the summary.
    pub(super) fn conclude(&self, directory: &RunDirectory, summary: &mut Summary) -> Result<(), RunError> {
        for (_, gathered) in &self.gathered {
            let (table, name, result) = match gathered {
                Gathered::RadialDistribution { range, samples, counts } => {
                    let (table, result) = self.radial_distribution(*range, *samples, counts);
                    (table, files::RADIAL_DISTRIBUTION, result)
                }
                Gathered::Diffusion { interval, window, displacement, velocity, .. } => {
                    let (table, result) = self.diffusion(*interval, *window, displacement, velocity);
                    (table, files::DIFFUSION, result)
                }
                Gathered::Viscosity { interval, window, modes, .. } => {
                    let (table, result) = self.viscosity(*interval, *window, modes);
                    (table, files::VISCOSITY, result)
                }
                Gathered::Circulation(circulations) if circulations.is_empty() => continue,
                Gathered::Circulation(circulations) => {
                    (circulations.table(), files::CIRCULATION, Ok(circulations.result()))
                }
            };
            match result {
                Ok(result) => {
                    summary.results.insert(gathered.name().to_owned(), result);
                }
                Err(reason) => summary.warnings.push(format!("no result for `output.{}`: {reason}", gathered.name())),
            }
            write_table(&directory.file(name), &table)?;
        }
        Ok(())
    }

    fn radial_distribution(&self, range: f64, samples: f64, counts: &[f64]) -> (Table, Result<Value, String>) {
        let width = range / counts.len() as f64;
        let pairs = 0.5 * self.particles * (self.particles - 1.0);
        let ball =
            |radius: f64| if self.dimension == 3 { 4.0 / 3.0 * PI * radius.powi(3) } else { PI * radius * radius };
        let mut rows = Vec::new();
        for (bin, count) in counts.iter().enumerate() {
            let inner = bin as f64 * width;
            let expected = samples * pairs * (ball(inner + width) - ball(inner)) / self.volume;
            rows.push(vec![inner + 0.5 * width, count / expected]);
        }
        let result = match peak(&rows) {
            _ if samples == 0.0 => Err("no sample was taken after equilibration".to_owned()),
            _ if pairs <= 0.0 => Err("there are no pairs of particles".to_owned()),
            Some([distance, height]) => {
                Ok(json!({ "samples": samples, "peak_distance": distance, "peak_height": height }))
            }
            None => Ok(json!({ "samples": samples, "peak_distance": null, "peak_height": null })),
        };
        (Table { columns: ["distance", "radial_distribution"].map(str::to_owned).to_vec(), rows }, result)
    }

    fn diffusion(
        &self,
        interval: f64,
        window: usize,
        displacement: &[f64],
        velocity: &[f64],
    ) -> (Table, Result<Value, String>) {
        let average = |samples: &[f64]| {
            let mut average = WindowedAverage::new(window);
            for sample in samples {
                average.push(*sample);
            }
            average
        };
        let (displacement, velocity) = (average(displacement), average(velocity));
        let averages = displacement.average().into_iter().zip(velocity.average());
        let rows = averages.enumerate().map(|(lag, (far, kept))| {
            let [far_error, kept_error] = [far.standard_error, kept.standard_error].map(|e| e.unwrap_or(f64::NAN));
            vec![lag as f64 * interval, far.mean, far_error, kept.mean, kept_error]
        });
        let columns = [
            "time",
            "mean_squared_displacement",
            "mean_squared_displacement_error",
            "velocity_autocorrelation",
            "velocity_autocorrelation_error",
        ];
        let table = Table { columns: columns.map(str::to_owned).to_vec(), rows: rows.collect() };
        let windows = displacement.windows().len();
        let result = if windows == 0 {
            Err(format!("the run ends before a window of {window} samples is full"))
        } else if self.particles == 0.0 {
            Err("there are no particles".to_owned())
        } else {
            Ok(json!({
                "windows": windows,
                "diffusion_einstein": diffusion_from_displacement(&displacement, interval, self.dimension),
                "diffusion_green_kubo": diffusion_from_velocity(&velocity, interval, self.dimension),
            }))
        };
        (table, result)
    }

    fn viscosity(&self, interval: f64, window: usize, modes: &[TransverseMode]) -> (Table, Result<Value, String>) {
        let density = self.mass / self.volume;
        let found = shear_viscosity(modes, density, interval, window).map_err(|error| error.to_string());
        let columns = ["wave_number", "time", "autocorrelation"].map(str::to_owned).to_vec();
        let rows = found.iter().flat_map(|found| autocorrelations(found, interval)).collect();
        let result = found.map(|found| {
            let waves: Vec<Value> = found
                .waves
                .iter()
                .map(
                    |wave| json!({ "wave_number": wave.wave_number, "modes": wave.modes, "viscosity": wave.viscosity }),
                )
                .collect();
            json!({
                "shear_viscosity": found.viscosity,
                "kinematic_viscosity": found.kinematic_viscosity,
                "waves": waves,
            })
        });
        (Table { columns, rows }, result)
    }
}

fn autocorrelations(found: &ShearViscosity, interval: f64) -> Vec<Vec<f64>> {
    let row = |wave_number: f64, (lag, value): (usize, &f64)| vec![wave_number, lag as f64 * interval, *value];
    let wave = |wave: &crate::measure::correlation::WaveViscosity| {
        let wave_number = wave.wave_number;
        wave.autocorrelation.iter().enumerate().map(|point| row(wave_number, point)).collect::<Vec<_>>()
    };
    found.waves.iter().flat_map(wave).collect()
}

/// Empty series in the order in which the kernel sums them: for each axis the momenta across it.
fn transverse_modes(model: &Model) -> Vec<TransverseMode> {
    let axes = &model.units.lengths[..model.units.dimension];
    let modes = axes.iter().flat_map(|length| (1..axes.len()).map(move |_| TAU / length));
    modes.map(|wave_number| TransverseMode { wave_number, amplitudes: Vec::new() }).collect()
}

impl Gathered {
    fn name(&self) -> &'static str {
        match self {
            Self::RadialDistribution { .. } => RADIAL_DISTRIBUTION,
            Self::Diffusion { .. } => DIFFUSION,
            Self::Viscosity { .. } => VISCOSITY,
            Self::Circulation(_) => "circulation",
        }
    }

    fn add(&mut self, sample: &Sample, particles: f64) {
        let sums = sample.sums.iter().map(|sum| *sum as f64);
        match self {
            Self::Circulation(circulations) => circulations.add(sample),
            Self::RadialDistribution { samples, counts, .. } => {
                *samples += 1.0;
                counts.iter_mut().zip(sums).for_each(|(count, found)| *count += found);
            }
            Self::Diffusion { scales, displacement, velocity, .. } => {
                for ((series, sum), scale) in [displacement, velocity].into_iter().zip(sums).zip(scales) {
                    series.push(sum * *scale / particles);
                }
            }
            Self::Viscosity { unit, modes, .. } => {
                let sums: Vec<f64> = sums.map(|sum| sum * *unit).collect();
                for (mode, pair) in modes.iter_mut().zip(sums.chunks_exact(2)) {
                    // exp(-ikr) = cos kr - i sin kr.
                    mode.amplitudes.push([pair[0], -pair[1]]);
                }
            }
        }
    }

    fn section(&self) -> Vec<u8> {
        match self {
            Self::Circulation(circulations) => circulations.section(),
            Self::RadialDistribution { samples, counts, .. } => {
                bytes(std::iter::once(*samples).chain(counts.iter().copied()))
            }
            Self::Diffusion { window, displacement, velocity, .. } => {
                // Where the particles were when a window began is not kept: a resumed run begins a new window.
                let full = displacement.len() / window * window;
                bytes(displacement[..full].iter().chain(&velocity[..full]).copied())
            }
            Self::Viscosity { modes, .. } => {
                bytes(modes.iter().flat_map(|mode| mode.amplitudes.as_flattened()).copied())
            }
        }
    }

    fn restore(&mut self, numbers: &[f64]) {
        match self {
            Self::Circulation(circulations) => circulations.restore(numbers),
            Self::RadialDistribution { samples, counts, .. } => {
                if let Some((first, rest)) = numbers.split_first()
                    && rest.len() == counts.len()
                {
                    *samples = *first;
                    counts.copy_from_slice(rest);
                }
            }
            Self::Diffusion { displacement, velocity, .. } => {
                let (first, second) = numbers.split_at(numbers.len() / 2);
                *displacement = first.to_vec();
                *velocity = second.to_vec();
            }
            Self::Viscosity { modes, .. } => {
                let length = numbers.len() / modes.len().max(1);
                for (mode, part) in modes.iter_mut().zip(numbers.chunks_exact(length.max(1))) {
                    mode.amplitudes = part.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
                }
            }
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
    fn numbers_survive_a_checkpoint() {
        let values = [0.0, -1.5, 1e300, f64::MIN_POSITIVE];
        assert_eq!(numbers(&bytes(values.into_iter())), values);
    }

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

    #[test]
    fn sections_restore_what_was_gathered() {
        let sample = |sums: &[i64]| Sample { sampler: 1, step: 0, sums: sums.to_vec() };
        let fresh = || {
            [
                Gathered::RadialDistribution { range: 1.0, samples: 0.0, counts: vec![0.0; 2] },
                Gathered::Diffusion {
                    interval: 1.0,
                    window: 2,
                    scales: [0.5, 0.25],
                    displacement: Vec::new(),
                    velocity: Vec::new(),
                },
                Gathered::Viscosity {
                    interval: 1.0,
                    window: 8,
                    unit: 2.0,
                    modes: vec![TransverseMode { wave_number: 1.0, amplitudes: Vec::new() }; 2],
                },
            ]
        };
        for (mut gathered, mut restored) in fresh().into_iter().zip(fresh()) {
            gathered.add(&sample(&[4, 8, 1, 2]), 2.0);
            gathered.add(&sample(&[0, 16, 3, 4]), 2.0);
            restored.restore(&numbers(&gathered.section()));
            assert_eq!(restored.section(), gathered.section());
            match restored {
                Gathered::RadialDistribution { samples, counts, .. } => {
                    assert_eq!((samples, counts), (2.0, vec![4.0, 24.0]));
                }
                Gathered::Diffusion { displacement, velocity, .. } => {
                    assert_eq!((displacement, velocity), (vec![1.0, 0.0], vec![1.0, 2.0]));
                }
                Gathered::Viscosity { modes, .. } => {
                    assert_eq!(modes[0].amplitudes, [[8.0, -16.0], [0.0, -32.0]]);
                    assert_eq!(modes[1].amplitudes, [[2.0, -4.0], [6.0, -8.0]]);
                }
                Gathered::Circulation(_) => unreachable!(),
            }
        }
    }
}
