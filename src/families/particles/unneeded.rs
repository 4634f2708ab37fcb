//! Choices that cost time and change nothing that is likely to be measured.

use crate::document::{Distribution, PairRelaxation, brief};
use crate::families::{Checked, Particles};

/// All of them in a scene, in words.
pub(super) fn unneeded(particles: &Particles, scene: &Checked) -> Vec<String> {
    let model = scene.model();
    let Some(force) = particles.pair_force.as_ref().filter(|force| force.has_friction()) else { return Vec::new() };
    let staged = particles.relaxes_in_two_stages();
    let relaxed = model.largest_friction_rate(force).0 * scene.time.step;
    if relaxed > model.friction_limit() || model.advisable_relaxation() == PairRelaxation::TwoStages {
        return Vec::new();
    }
    let mut found = Vec::new();
    if staged {
        found.push(format!(
            "friction in two stages, 1.5 times the time of a step: a step relaxes {} of a velocity, and one stage has the temperature and the \
             viscosity within 1 %",
            brief(relaxed)
        ));
    }
    if scene.noise.distribution == Distribution::Gaussian && !staged && !force.remembers() {
        found.push(
            "Gaussian noise, 7 to 17 % of a step: uniform noise gives the same temperatures within .3 %, and is the default".to_owned(),
        );
    }
    found
}
