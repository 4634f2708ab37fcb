//! Mean squared displacement and velocity autocorrelation, and the diffusion coefficients they give.

use super::{
    Conclusion, Descriptor, Drawn, Gathered, Part, Planner, Sampling, Setting, SumSampler, found, of_species,
    windows_missing,
};
use crate::engine::Sample;
use crate::families::Checked;
use crate::measure::correlation::WindowedAverage;
use crate::measure::diffusion::DiffusionWindows;
use crate::plan::paths::PATH;
use crate::plan::{Paths, Window};
use crate::plot::{Chart, diffusion_chart};
use crate::scene::AnalysisId;
use crate::shaders::{Array, Choices, Constant, Entry};
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
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let asked = scene.output.diffusion.as_ref()?;
        Some(Sampling::after_equilibration(scene, asked.every).in_windows(asked.window))
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.diffusion else { return };
        let unit = planner.model.units.momentum;
        let measured = planner.measured();
        let (particles, species) = planner.particles_of(asked.species.as_deref());
        let mut constants = planner.of_all_particles();
        constants.extend(species);
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
            choices: Choices::new().with_any(particles),
            constants,
            renamed: of_all_ranks.then_some((Paths::BUFFER, Array::GatheredPaths)).into_iter().collect(),
            window: Some(Window { buffer: TRACKERS, samples: asked.window.max(1) }),
            ..SumSampler::new(AnalysisId::Diffusion, Entry::TrackParticles, buffers, 2, asked.every)
        });
    }

    fn parts(&self, _: &Checked) -> Vec<Part> {
        // Means over the particles that can move of squared displacements and of products of velocities.
        vec![Part::series(1), Part::series(1)]
    }

    fn numbers_of_sample(&self, Setting { scene, plan }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let scales = [plan.quanta.length_squared, plan.quanta.velocity_squared];
        let means = sample.sums.iter().zip(scales);
        let species = scene.output.diffusion.as_ref()?.species.as_deref();
        let particles = scene.model().mobile_particles_of(species) as f64;
        Some(means.map(|(sum, scale)| *sum as f64 * scale / particles).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = scene.output.diffusion.as_ref()?;
        let interval = asked.every as f64 * model.time_step;
        let [displacement, velocity] =
            [0, 1].map(|part| WindowedAverage::from_samples(asked.window as usize, gathered.part(part)));
        let averages = displacement.average().into_iter().zip(velocity.average());
        let rows = averages
            .enumerate()
            .map(|(lag, (far, kept))| [&[lag as f64 * interval], [far.cells(), kept.cells()].as_flattened()].concat());
        let columns = [
            "time",
            "mean_squared_displacement",
            "mean_squared_displacement_error",
            "velocity_autocorrelation",
            "velocity_autocorrelation_error",
        ];
        let table = Table::new(columns, rows.collect());
        if let Some(missing) = windows_missing(&displacement, model, asked.species.as_deref()) {
            return Some(Conclusion::new(table, Err(missing)));
        }
        let mut result = of_species(asked.species.as_deref(), json!({ "windows": displacement.windows().len() }));
        let windows = DiffusionWindows { displacement, velocity, interval, dimension: model.units.dimension };
        let mut warnings = Vec::new();
        for (name, found) in [(EINSTEIN, windows.einstein()), (GREEN_KUBO, windows.green_kubo())] {
            result[name] = json!(found.as_ref().ok());
            warnings.extend(found.err().map(|error| format!("no `{name}`: {error}")));
        }
        Some(Conclusion { warnings, ..Conclusion::new(table, Ok(result)) })
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let [einstein, green_kubo] = [EINSTEIN, GREEN_KUBO].map(|key| found(&drawn.result[key]));
        let dimension = drawn.scene.space.lengths.len();
        drawn.of_species(diffusion_chart(drawn.title(), drawn.table, dimension, einstein, green_kubo))
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("diffusion (Einstein)", EINSTEIN), ("diffusion (Green-Kubo)", GREEN_KUBO)]
    }
}
