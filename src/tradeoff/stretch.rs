//! The same stretch of simulated time for every variant, whatever its time step.

use crate::families::Checked;
use crate::scene::{Scene, SceneError};
use crate::study::StudyError;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What of a scene says when to write rather than what to sample: it is left as it is.
const WRITTEN: [&str; 4] = ["checkpoint", "snapshot", "trajectory", "fields"];

/// The stress, and the most lags of its correlation.
const STRESS: &str = "stress";
const MOST_LAGS: u64 = 100_000;

/// A stretch of simulated time: what passes before means are taken, and what they are taken over.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Stretch {
    /// Time of equilibration.
    pub equilibration: f64,
    /// Time that means are taken over.
    pub averaged: f64,
    /// The time step of the scene, which its intervals of samples are numbers of.
    pub step: f64,
}

impl Stretch {
    /// That of a scene as it is.
    pub(crate) fn of(scene: &Scene) -> Self {
        let time = &scene.time;
        let equilibration = time.equilibration.min(time.steps);
        Self {
            equilibration: equilibration as f64 * time.step,
            averaged: (time.steps - equilibration) as f64 * time.step,
            step: time.step,
        }
    }

    /// The number of steps of a time step that covers all of it, to the next row of the table of energies.
    pub(super) fn steps(&self, scene: &Scene) -> u64 {
        let (step, every) = (scene.time.step, scene.output.energies.every.max(1));
        // Rounding must not add a row.
        let steps = (self.averaged / step * (1.0 - 1e-12)).ceil() as u64;
        scene.time.equilibration.saturating_add(steps.div_ceil(every).max(1).saturating_mul(every))
    }

    /// The numbers of steps before means are taken and in all with which a scene covers this stretch.
    pub(super) fn numbers(&self, scene: &Scene) -> (u64, u64) {
        let equilibration = (self.equilibration / scene.time.step).round() as u64;
        // Rounding must not add a step.
        let averaged = (self.averaged / scene.time.step * (1.0 - 1e-12)).ceil() as u64;
        (equilibration, equilibration.saturating_add(averaged))
    }

    /// A variant over this stretch, sampled at the same times as the scene as far as its step allows.
    ///
    /// # Errors
    /// [`StudyError::Variants`] where that is no scene: a window of an analysis that does not fit, say.
    pub(super) fn applied(&self, name: &str, variant: &Checked) -> Result<Checked, StudyError> {
        let wrong = |source: SceneError| StudyError::of_variant(name, source);
        let mismatch = |error: serde_json::Error| {
            wrong(SceneError::SchemaMismatch { name: name.to_owned(), message: error.to_string() })
        };
        let mut document = serde_json::to_value(variant).map_err(mismatch)?;
        let ratio = self.step / variant.time.step;
        if let Some(output) = document.get_mut("output").and_then(Value::as_object_mut) {
            for (key, section) in output.iter_mut().filter(|(key, _)| !WRITTEN.contains(&key.as_str())) {
                if key != STRESS || !keep_every_step(section, ratio) {
                    resample(section, ratio);
                }
            }
        }
        let mut scene: Scene = serde_json::from_value(document).map_err(mismatch)?;
        scene.time.equilibration = (self.equilibration / variant.time.step).round() as u64;
        scene.time.steps = self.steps(&scene);
        scene.kept = variant.kept.clone();
        scene.check_kept(name).map_err(wrong)
    }
}

/// The correlation of the stress takes samples of every step, whatever the step is: it is its window that covers the same time then.
/// Whether that is so.
fn keep_every_step(stress: &mut Value, ratio: f64) -> bool {
    let window = stress.get("window").and_then(Value::as_u64).filter(|_| stress["every"] == 1);
    if let Some(samples) = window {
        stress["window"] = ((samples as f64 * ratio).round() as u64).clamp(2, MOST_LAGS).into();
    }
    window.is_some()
}

/// Multiplies every number of steps between two samples.
fn resample(section: &mut Value, ratio: f64) {
    if let Some(list) = section.as_array_mut() {
        for entry in list {
            resample(entry, ratio);
        }
    } else if let Some(steps) = section["every"].as_u64().filter(|steps| *steps > 0) {
        section["every"] = ((steps as f64 * ratio).round() as u64).max(1).into();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn scene(step: &str) -> Checked {
        let set = [
            format!("time.step={step}"),
            r#"output={"energies":{"every":20},"radial_distribution":{"every":40,"range":2}}"#.to_owned(),
        ];
        crate::scene::load("dpd-fluid", &set).unwrap()
    }

    #[test]
    fn variants_cover_the_same_time_and_are_sampled_at_the_same_times() {
        let base = scene("0.04");
        let stretch = Stretch::of(&base);
        let all = stretch.equilibration + stretch.averaged;
        assert_eq!(stretch.applied("same", &base).unwrap(), base);
        for (step, every) in [("0.01", 80), ("0.02", 40), ("0.08", 10), ("0.05", 16)] {
            let found = stretch.applied("variant", &scene(step)).unwrap();
            let time = found.time.steps as f64 * found.time.step;
            let row = every as f64 * found.time.step;
            assert!(time >= all - 1e-9 && time < all + row + 1e-9, "{step}: {time}");
            assert_eq!(found.output.energies.every, every, "{step}");
            assert_eq!(found.output.radial_distribution.as_ref().unwrap().every, 2 * every, "{step}");
        }
        let sampled = |set: &str| {
            let set = [
                "output={}".to_owned(),
                format!("time.step={set}"),
                r#"output.stress={"every":1,"window":50}"#.to_owned(),
            ];
            let found = stretch.applied("variant", &crate::scene::load("dpd-fluid", &set).unwrap()).unwrap();
            found.output.stress.as_ref().map(|stress| (stress.every, stress.window))
        };
        assert_eq!(["0.04", "0.01"].map(sampled), [Some((1, Some(50))), Some((1, Some(200)))], "of every step");
        let longer = Stretch { averaged: 2.0 * stretch.averaged, ..stretch };
        assert_eq!(longer.applied("same", &base).unwrap().time.steps, 2 * base.time.steps - base.time.equilibration);
    }
}
