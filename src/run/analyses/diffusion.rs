//! Mean squared displacement and velocity autocorrelation, and the diffusion coefficients they give.

use super::{
    Analysis, Conclusion, Descriptor, Drawn, Gathering, Planner, Sampling, Setting, SumSampler, bytes, found,
    windows_missing,
};
use crate::engine::Sample;
use crate::families::Model;
use crate::measure::correlation::WindowedAverage;
use crate::measure::diffusion::DiffusionWindows;
use crate::plan::paths::PATH;
use crate::plan::{Need, Paths, Window};
use crate::plot::{Chart, diffusion_chart};
use crate::scene::{AnalysisId, Output, Scene};
use crate::shaders::{Array, Constant, Entry};
use crate::table::Table;
use serde_json::json;

/// The buffer of what is known of each particle.
const TRACKERS: Array = Array::Trackers;

/// Names of the coefficients in the result.
const EINSTEIN: &str = "diffusion_einstein";
const GREEN_KUBO: &str = "diffusion_green_kubo";

/// Mean squared displacement and velocity autocorrelation.
pub(super) struct Diffusion;

impl Descriptor for Diffusion {
    fn asked(&self, scene: &Scene, _: &Model) -> Option<Sampling> {
        let asked = scene.output.diffusion.as_ref()?;
        Some(Sampling::after_equilibration(scene, asked.every).in_windows(asked.window))
    }

    fn needs(&self, _: &Output) -> &'static [Need] {
        &[Need::Particles]
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.diffusion else { return };
        let unit = planner.model.units.momentum;
        let measured = planner.measured();
        let mut constants = planner.of_all_particles();
        let plan = &mut *planner.plan;
        plan.add_buffer(TRACKERS, 48 * measured);
        let of_all_ranks = plan.part.is_some();
        if of_all_ranks {
            plan.add_buffer(Array::GatheredPaths, PATH * measured);
        }
        constants.extend([
            (Constant::Window, asked.window as f64),
            (Constant::Displacement, 1.0 / plan.quanta.length_squared),
            (Constant::Velocity, unit * unit / plan.quanta.velocity_squared),
        ]);
        let buffers = [Array::DiffusionSums, Array::DiffusionSamples];
        planner.add_sums(&SumSampler {
            constants,
            renamed: of_all_ranks.then_some((Paths::BUFFER, Array::GatheredPaths)).into_iter().collect(),
            window: Some(Window { buffer: TRACKERS, samples: asked.window.max(1) }),
            ..SumSampler::new(AnalysisId::Diffusion, Entry::TrackParticles, buffers, 2, asked.every)
        });
    }

    fn begin(&self, setting: &Setting<'_>) -> Option<Gathering> {
        let (asked, model) = (setting.scene.output.diffusion.as_ref()?, setting.model);
        let quanta = setting.plan.quanta;
        Some(Gathering::Samples(Box::new(Averages {
            particles: model.mobile_particles() as f64,
            dimension: model.units.dimension,
            interval: asked.every as f64 * model.time_step,
            window: asked.window as usize,
            scales: [quanta.length_squared, quanta.velocity_squared],
            displacement: Vec::new(),
            velocity: Vec::new(),
        })))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let [einstein, green_kubo] = [EINSTEIN, GREEN_KUBO].map(|key| found(&drawn.result[key]));
        let dimension = drawn.scene.space.lengths.len();
        diffusion_chart(drawn.title(), drawn.table, dimension, einstein, green_kubo)
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("diffusion (Einstein)", EINSTEIN), ("diffusion (Green-Kubo)", GREEN_KUBO)]
    }
}

/// Means over the particles that can move, sample by sample.
struct Averages {
    particles: f64,
    dimension: usize,
    interval: f64,
    window: usize,
    scales: [f64; 2],
    displacement: Vec<f64>,
    velocity: Vec<f64>,
}

impl Analysis for Averages {
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

    fn restore(&mut self, numbers: &[f64], _: u64) {
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
        let table = Table::new(columns, rows.collect());
        if let Some(missing) = windows_missing(&displacement, self.particles) {
            return Conclusion::new(table, Err(missing));
        }
        let mut result = json!({ "windows": displacement.windows().len() });
        let windows = DiffusionWindows { displacement, velocity, interval: self.interval, dimension: self.dimension };
        let mut warnings = Vec::new();
        for (name, found) in [(EINSTEIN, windows.einstein()), (GREEN_KUBO, windows.green_kubo())] {
            result[name] = json!(found.as_ref().ok());
            warnings.extend(found.err().map(|error| format!("no `{name}`: {error}")));
        }
        Conclusion { warnings, ..Conclusion::new(table, Ok(result)) }
    }
}
