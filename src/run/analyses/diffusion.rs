//! Mean squared displacement and velocity autocorrelation, and the diffusion coefficients they give.

use super::{Analysis, Conclusion, Setting, bytes, windows_missing};
use crate::engine::Sample;
use crate::measure::correlation::{WindowedAverage, diffusion_from_displacement, diffusion_from_velocity};
use crate::output::files;
use crate::scene;
use crate::table::Table;
use serde_json::json;

/// Means over particles, sample by sample.
pub(super) struct Diffusion {
    particles: f64,
    dimension: usize,
    interval: f64,
    window: usize,
    scales: [f64; 2],
    displacement: Vec<f64>,
    velocity: Vec<f64>,
}

impl Diffusion {
    pub(super) fn new(setting: &Setting<'_>, asked: &scene::Diffusion) -> Self {
        let quanta = setting.plan.quanta;
        Self {
            particles: setting.plan.particles as f64,
            dimension: setting.model.units.dimension,
            interval: asked.every as f64 * setting.model.time_step,
            window: asked.window as usize,
            scales: [quanta.length_squared, quanta.velocity_squared],
            displacement: Vec::new(),
            velocity: Vec::new(),
        }
    }
}

impl Analysis for Diffusion {
    fn name(&self) -> &'static str {
        "diffusion"
    }

    fn add(&mut self, sample: &Sample) {
        let [displacement, velocity] = &mut [&mut self.displacement, &mut self.velocity];
        for ((series, sum), scale) in [displacement, velocity].into_iter().zip(&sample.sums).zip(self.scales) {
            series.push(*sum as f64 * scale / self.particles);
        }
    }

    fn section(&self) -> Vec<u8> {
        bytes(self.displacement.iter().chain(&self.velocity).copied())
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        samples.saturating_mul(2)
    }

    fn restore(&mut self, numbers: &[f64]) {
        let (first, second) = numbers.split_at(numbers.len() / 2);
        self.displacement = first.to_vec();
        self.velocity = second.to_vec();
    }

    fn conclude(&self) -> Conclusion {
        let [displacement, velocity] =
            [&self.displacement, &self.velocity].map(|samples| WindowedAverage::of(self.window, samples));
        let averages = displacement.average().into_iter().zip(velocity.average());
        let rows = averages.enumerate().map(|(lag, (far, kept))| {
            let [far_error, kept_error] = [far.standard_error, kept.standard_error].map(|e| e.unwrap_or(f64::NAN));
            vec![lag as f64 * self.interval, far.mean, far_error, kept.mean, kept_error]
        });
        let columns = [
            "time",
            "mean_squared_displacement",
            "mean_squared_displacement_error",
            "velocity_autocorrelation",
            "velocity_autocorrelation_error",
        ];
        let table = Table { columns: columns.map(str::to_owned).to_vec(), rows: rows.collect() };
        let result = windows_missing(&displacement, self.particles).map_or_else(
            || {
                Ok(json!({
                    "windows": displacement.windows().len(),
                    "diffusion_einstein": diffusion_from_displacement(&displacement, self.interval, self.dimension),
                    "diffusion_green_kubo": diffusion_from_velocity(&velocity, self.interval, self.dimension),
                }))
            },
            Err,
        );
        Conclusion::new(files::DIFFUSION, table, result)
    }
}
