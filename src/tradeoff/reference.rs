//! What the measures are compared with.

use super::fields::{DISTANCE, FROM_EXACT};
use super::measures::{CIRCULATION_DRIFT, ENERGY_DRIFT, LIMITED_EXCHANGES, Measured};
use crate::families::{self, Checked, ExactMean, KeptQuantity, Model, column};
use crate::state::State;
use serde::{Deserialize, Serialize};

/// The value that a measure should have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// The measure.
    pub measure: String,
    /// Its value.
    pub value: f64,
    /// Its standard error and what is known of its bias; none where nothing is.
    pub uncertainty: Option<f64>,
    /// Where it is from.
    pub source: Source,
}

impl Reference {
    /// A value that a law gives exactly.
    pub(crate) fn exact(measure: &str, value: f64, law: &str) -> Self {
        let source = Source::Predicted(law.to_owned());
        Self { measure: measure.to_owned(), value, uncertainty: Some(0.0), source }
    }

    /// Whether it is zero for all that is known of it, so that nothing is a part of it.
    pub(crate) fn is_zero(&self) -> bool {
        self.value.abs() <= 2.0 * self.uncertainty.unwrap_or(0.0)
    }
}

/// Where a reference is from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// The user.
    Given,
    /// A law that the scene has to obey, in words.
    Predicted(String),
    /// A finer run of this name.
    Finer(String),
}

/// References that the user gives.
///
/// ```
/// use mesoscope::tradeoff::References;
///
/// let given = References::parse(&["pressure=23.635".to_owned(), "diffusion.einstein=0.306+-0.002".to_owned()])?;
/// assert_eq!(given.find("diffusion.einstein").map(|found| (found.value, found.uncertainty)), Some((0.306, Some(0.002))));
/// assert!(References::parse(&["pressure=much".to_owned()]).is_err());
/// # Ok::<(), Vec<String>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct References(Vec<Reference>);

impl References {
    /// Reads `measure=value` or `measure=value+-error`, where `±` may stand for `+-`.
    ///
    /// # Errors
    /// All mistakes, in words.
    pub fn parse(arguments: &[String]) -> Result<Self, Vec<String>> {
        let accepted = "accepted: measure=value or measure=value+-error, as in pressure=23.635+-0.005";
        let mut mistakes = Vec::new();
        let mut found: Vec<Reference> = Vec::new();
        for argument in arguments {
            let mistake = match Self::read(argument) {
                None => accepted.to_owned(),
                Some(given) if found.iter().any(|known| known.measure == given.measure) => {
                    format!("`{}` has one already", given.measure)
                }
                Some(given) => {
                    found.push(given);
                    continue;
                }
            };
            mistakes.push(format!("`--reference {argument}`: {mistake}"));
        }
        if mistakes.is_empty() { Ok(Self(found)) } else { Err(mistakes) }
    }

    /// Reads one of them.
    fn read(argument: &str) -> Option<Reference> {
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        let (measure, text) = argument.split_once('=').filter(|(measure, _)| !measure.trim().is_empty())?;
        let text = text.replace('±', "+-");
        let (value, error) = text.split_once("+-").unwrap_or((text.as_str(), "0"));
        let uncertainty = Some(number(error).filter(|error| *error >= 0.0)?);
        let (measure, value) = (measure.trim().to_owned(), number(value)?);
        Some(Reference { measure, value, uncertainty, source: Source::Given })
    }

    /// The one of a measure.
    #[must_use]
    pub fn find(&self, measure: &str) -> Option<&Reference> {
        self.0.iter().find(|known| known.measure == measure)
    }

    /// The one of a measure, else what the measure has if equations of motion are solved exactly, where that is known.
    pub(crate) fn known(&self, measure: &str, scene: &Checked) -> Option<Reference> {
        self.find(measure).cloned().or_else(|| predicted(measure, scene))
    }

    /// The measures that have one.
    pub(crate) fn measures(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|reference| reference.measure.as_str())
    }
}

/// The value that a measure has if equations of motion are solved exactly, where that is known.
pub(crate) fn predicted(measure: &str, scene: &Checked) -> Option<Reference> {
    let model = scene.model();
    let (value, law) = match measure {
        ENERGY_DRIFT => (0.0, "the energy of the exact motion is constant"),
        CIRCULATION_DRIFT => (0.0, "a loop that moves with the flow keeps its circulation"),
        LIMITED_EXCHANGES => (0.0, "a limit that never acts changes nothing"),
        "temperature" | "configurational_temperature" if model.physics().has_thermostat(model) => {
            (scene.temperature, "the temperature of the bath")
        }
        _ if measure.ends_with(DISTANCE) => (0.0, "no distance from the finer run"),
        _ if measure.ends_with(FROM_EXACT) => (0.0, "no distance from the exact flow, which is steady"),
        _ if column::axis_of_momentum(measure).is_some() => {
            (kept_momentum(measure, scene)?, "the total momentum at the start, which is constant")
        }
        _ => (exact_mean(measure, model)?.continuous, "the mean of the exact motion in equilibrium"),
    };
    Some(Reference::exact(measure, value, law))
}

/// A component of the total momentum that a scene starts with, if it keeps it.
fn kept_momentum(measure: &str, scene: &Checked) -> Option<f64> {
    let model = scene.model();
    let axis = column::axis_of_momentum(measure)?;
    // What is kept does not depend on the state; its sums do.
    let is_kept = |state: &State| {
        let kept = model.physics().kept(model, state).into_iter();
        kept.filter(|sum| sum.quantity == KeptQuantity::MOMENTUM).nth(axis).map(|sum| sum.total as f64 * sum.unit)
    };
    is_kept(&State::default())?;
    is_kept(&families::initial_state(scene))
}

/// The exact mean of a column in equilibrium, where it is known.
fn exact_mean(measure: &str, model: &Model) -> Option<ExactMean> {
    model.physics().exact_means(model).into_iter().find(|mean| mean.column == measure)
}

/// The value that the scheme of a scene gives a measure with its time step, noise apart, where that is known exactly.
pub(super) fn of_scheme(measure: &str, scene: &Checked) -> Option<f64> {
    exact_mean(measure, scene.model())?.discrete
}

/// The reference that the first of these runs gives. Its own bias is taken to be what its time step, halved once, has changed, noise included:
/// that is the bias of a scheme of first order, and more than that of one of a higher. What tells further runs from it counts as much.
pub(super) fn finer(measure: &str, name: &str, runs: &[&[Measured]]) -> Option<Reference> {
    let (first, others) = runs.split_first()?;
    let find = |run: &[Measured]| run.iter().find(|found| found.measure == measure).cloned();
    let fine = find(first)?;
    let squares = others.iter().map(|other| Some((fine.value - find(other)?.value).powi(2)));
    let bias: Option<f64> = squares.sum::<Option<f64>>().filter(|_| !others.is_empty()).map(f64::sqrt);
    let uncertainty = fine.uncertainty().zip(bias).map(|(own, bias)| own.hypot(bias));
    let source = Source::Finer(name.to_owned());
    Some(Reference { measure: measure.to_owned(), value: fine.value, uncertainty, source })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene;

    fn measured(value: f64, standard_error: f64) -> Vec<Measured> {
        let standard_error = Some(standard_error);
        let measure = "pressure".to_owned();
        vec![Measured { measure, value, standard_error, fluctuates: true, from_few_samples: false }]
    }

    #[test]
    fn a_finer_run_is_as_uncertain_as_its_noise_and_its_last_change() {
        let (fine, coarse, still) = (measured(20.0, 0.03), measured(20.5, 0.04), measured(20.2, 0.1));
        let of = |runs: &[&[Measured]]| finer("pressure", "finer", runs).unwrap();
        assert!((of(&[&fine, &coarse]).uncertainty.unwrap() - 0.03_f64.hypot(0.5)).abs() < 1e-12);
        // A still finer run adds what it changes.
        let found = of(&[&fine, &coarse, &still]);
        assert_eq!(found.value, 20.0);
        assert!((found.uncertainty.unwrap() - 0.03_f64.hypot(0.5).hypot(0.2)).abs() < 1e-12);
        for lacks in [&[&fine[..]][..], &[&fine, &[]], &[&fine, &coarse, &[]]] {
            assert_eq!(of(lacks).uncertainty, None);
        }
        assert_eq!(finer("energy", "finer", &[&fine, &coarse]), None);
        assert_eq!(finer("pressure", "finer", &[]), None);
        let few: Vec<Measured> =
            measured(20.0, 0.03).into_iter().map(|found| Measured { from_few_samples: true, ..found }).collect();
        let found = of(&[&few, &measured(20.0, 0.04)]);
        assert!((found.uncertainty.unwrap() - 0.09).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn baths_predict_temperatures_and_nothing_else() {
        let fluid = scene::load("dpd-fluid", &["temperature=0.7".to_owned()]).unwrap();
        assert_eq!(predicted("temperature", &fluid).unwrap().value, 0.7);
        assert_eq!(predicted("pressure", &fluid), None);
        let water = scene::load("jet-instability", &[]).unwrap();
        assert_eq!(predicted("temperature", &water), None);
        assert_eq!(predicted(CIRCULATION_DRIFT, &water).unwrap().value, 0.0);
        assert_eq!(predicted(ENERGY_DRIFT, &water).unwrap().value, 0.0);
    }

    #[test]
    fn still_water_has_the_temperature_of_its_bath_and_a_flow_has_none_of_its_own() {
        let load = |name: &str, set: &[&str]| {
            scene::load(name, &set.iter().map(|change| (*change).to_owned()).collect::<Vec<_>>()).unwrap()
        };
        let still = load("shallow-water-equilibrium", &[]);
        let value = |measure: &str, scene: &Checked| predicted(measure, scene).map(|found| found.value);
        assert_eq!(value("temperature", &still), Some(0.04));
        // kT λ/c₀² with λ = π²/4 and c₀ = 2π: ε = 1 makes λ (c₀/4)² here.
        let square = value("bath_square", &still).unwrap();
        assert!((square / 0.0025 - 1.0).abs() < 1e-12, "{square}");
        assert_eq!(value(ENERGY_DRIFT, &still), Some(0.0));
        let white = load("shallow-water-equilibrium", &[r#"interactions.0.bath={"type":"white"}"#]);
        assert_eq!((value("temperature", &white), value("bath_square", &white)), (Some(0.04), None));
        for scene in [
            load("shallow-water-memory", &[]),
            load("shallow-water-equilibrium", &["particles.0.velocities.type=rest"]),
            load("shallow-water-equilibrium", &["interactions.0.bath=null"]),
            load("shallow-water-equilibrium", &["temperature=0"]),
        ] {
            assert_eq!((value("temperature", &scene), value("bath_square", &scene)), (None, None), "{}", scene.title);
        }
    }

    #[test]
    fn momentum_is_predicted_where_it_is_kept() {
        let fluid = |set: &str| scene::load("dpd-fluid", &[set.to_owned()]).unwrap();
        for measure in ["momentum_x", "momentum_y", "momentum_z"] {
            assert_eq!(predicted(measure, &fluid("seed=2")).map(|found| found.value), Some(0.0), "{measure}");
        }
        // A bath that acts on each particle alone keeps none.
        assert_eq!(predicted("momentum_x", &scene::load("langevin-gas", &[]).unwrap()), None);
    }

    #[test]
    fn references_are_read_or_refused_all_at_once() {
        let wrong = ["pressure", "=1", "a=x", "a=1+-x", "a=1+--1"].map(str::to_owned);
        assert_eq!(References::parse(&wrong).unwrap_err().len(), 5);
        let twice = ["a=1", "a=2"].map(str::to_owned);
        assert!(References::parse(&twice).unwrap_err()[0].contains("has one already"));
    }
}
