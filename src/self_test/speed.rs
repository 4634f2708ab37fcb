//! The speed of the standard fluid.

use super::Finding;
use crate::gpu::Gpu;
use crate::run::{self, RunError};
use crate::scene;

/// Particle-steps a second of the built-in `dpd-fluid`, from the steps that a prediction of its time takes.
pub(super) fn of_the_standard_fluid(gpu: &Gpu) -> Finding {
    let measure = || -> Result<String, RunError> {
        let scene = scene::load("dpd-fluid", &["output={}".to_owned()])?;
        let particles = scene.model().particle_count();
        let rate = particles as f64 / run::expected_time(&scene, gpu)?.step;
        Ok(format!("{:.2} million particle-steps a second with {particles} particles", rate / 1e6))
    };
    let check = "speed of `dpd-fluid`";
    match measure() {
        Ok(found) => Finding::noted(check, found),
        Err(error) => Finding::new(check, false, error.to_string()),
    }
}
