//! What is known of the errors of scenes before they run: tradeoffs that were made once and are shipped with the program.

use crate::scene::{self, Scene};
use crate::tradeoff::{Choice, ChoiceState, Deviation, TradeoffSummary, error_in_words};
use std::fmt;
use std::sync::LazyLock;

/// Time steps are alike within this factor: errors of a second-order scheme then differ by half of themselves at most.
const ALIKE: f64 = 1.25;

/// Densities are alike within this factor.
const AS_DENSE: f64 = 1.05;

static SUMMARIES: LazyLock<Vec<TradeoffSummary>> =
    LazyLock::new(|| scene::CALIBRATIONS.iter().filter_map(|text| serde_json::from_str(text).ok()).collect());

/// Errors that were measured of a scene of the same physics, with the same integrator and about the same time step.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// Title of the scene that was measured.
    pub scene: String,
    /// Its time step.
    pub time_step: f64,
    /// The errors, measure by measure.
    pub errors: Vec<Deviation>,
    /// When it was measured, as year, month and day.
    pub date: String,
    /// The version of the program that measured it.
    pub version: String,
}

/// The errors to expect of a scene; none where nothing like it was measured.
///
/// ```
/// use mesoscope::{calibration, scene};
///
/// let fluid = scene::load("dpd-fluid", &["space.box=[20,20,20]".to_owned()])?;
/// assert!(calibration::expected(&fluid).is_some_and(|expected| expected.time_step == fluid.time.step));
/// let other = scene::load("dpd-fluid", &["interactions.0.repulsion=3".to_owned()])?;
/// assert_eq!(calibration::expected(&other), None);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn expected(scene: &Scene) -> Option<Expected> {
    let choices = SUMMARIES.iter().flat_map(|summary| summary.choices.iter().map(move |choice| (summary, choice)));
    let alike = choices.filter_map(|(summary, choice)| {
        let measured = measured_scene(summary, choice)?;
        is_alike(scene, &measured).then_some((apart(scene, &measured), summary, choice, measured.title))
    });
    let (_, summary, choice, title) = alike.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Expected {
        scene: title,
        time_step: choice.time_step,
        errors: choice.errors.clone(),
        date: summary.date.clone(),
        version: summary.mesoscope_version.clone(),
    })
}

/// The scene of a choice that was finished.
fn measured_scene(summary: &TradeoffSummary, choice: &Choice) -> Option<Scene> {
    if choice.state != ChoiceState::Finished {
        return None;
    }
    let (name, text, overrides) = summary.scene_of(choice);
    scene::parse(name, text, &overrides).ok()
}

/// By what factor time steps differ.
fn apart(one: &Scene, other: &Scene) -> f64 {
    let ratio = one.time.step / other.time.step;
    ratio.max(1.0 / ratio)
}

/// Whether two scenes simulate the same physics in the same way: the same interactions, temperature, integrator and particles in
/// another number, in a box of another size.
fn is_alike(one: &Scene, other: &Scene) -> bool {
    let volumes = [one, other].map(|scene| scene.space.volume());
    let groups = || one.particles.iter().zip(&other.particles);
    let as_dense = |(a, b): (&scene::ParticleGroup, &scene::ParticleGroup)| {
        let [a, b] =
            [a.resolved_count(&one.space) as f64 / volumes[0], b.resolved_count(&other.space) as f64 / volumes[1]];
        a.max(b) <= AS_DENSE * a.min(b)
    };
    let alike = |(a, b): (&scene::ParticleGroup, &scene::ParticleGroup)| {
        (a.mass, a.fixed, a.is_frozen(), a.tracer, &a.chain) == (b.mass, b.fixed, b.is_frozen(), b.tracer, &b.chain)
    };
    one.interactions == other.interactions
        && one.temperature == other.temperature
        && one.integrator == other.integrator
        && one.space.lengths.len() == other.space.lengths.len()
        && one.space.walls == other.space.walls
        && one.particles.len() == other.particles.len()
        && groups().all(alike)
        && groups().all(as_dense)
        && apart(one, other) <= ALIKE
}

impl fmt::Display for Expected {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words =
            self.errors.iter().map(|error| format!("{} {}", error.measure.replace('_', " "), error_in_words(error)));
        let words: Vec<String> = words.collect();
        write!(
            formatter,
            "{} off, as measured with a step of {} ({}, {}, version {})",
            words.join(", "),
            self.time_step,
            crate::printable::name(&self.scene),
            self.date,
            self.version
        )
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn all_calibrations_can_be_read_and_have_a_date() {
        assert_eq!(SUMMARIES.len(), scene::CALIBRATIONS.len());
        for summary in SUMMARIES.iter() {
            assert!(summary.date.len() == 10 && !summary.choices.is_empty(), "{}", summary.date);
            for choice in summary.choices.iter().filter(|choice| choice.state == ChoiceState::Finished) {
                assert!(measured_scene(summary, choice).is_some(), "{}", choice.name);
            }
        }
    }

    #[test]
    fn only_scenes_of_the_same_physics_are_alike() {
        let scene = |set: &[&str]| {
            let own = ["output={}"].into_iter().chain(set.iter().copied());
            scene::load("dpd-fluid", &own.map(str::to_owned).collect::<Vec<_>>()).unwrap()
        };
        let base = scene(&[]);
        for set in ["space.box=[30,30,30]", "time.steps=9000", "time.step=0.048", "seed=9"] {
            assert!(is_alike(&base, &scene(&[set])), "{set}");
        }
        for set in [
            "temperature=0.9",
            "time.step=0.06",
            "interactions.0.friction=9",
            "integrator.type=groot-warren",
            "particles.0.number_density=4",
            "particles.0.mass=2",
            "space.walls={\"z\":{\"reflection\":\"bounce-back\"}}",
        ] {
            assert!(!is_alike(&base, &scene(&[set])), "{set}");
        }
        // The error that is given is that of the nearest step.
        let [near, far] = ["time.step=0.042", "time.step=0.2"].map(|step| expected(&scene(&[step])));
        assert_eq!((near.unwrap().time_step, far), (0.04, None));
    }
}
