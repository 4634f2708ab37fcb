//! How far laws say that a scene may go.

use crate::document::Scene;
use crate::families::Checked;

/// A law that bounds what a scene may ask for, and how near to its bound the scene is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The law, in a few words.
    pub law: &'static str,
    /// The part of the bound that the scene takes: it grows with the time step, and is 1 at the bound.
    pub share: f64,
    /// What lies beyond.
    pub beyond: Beyond,
}

/// What lies beyond the bound of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// No run is stable.
    Unstable,
    /// Runs go on, but their results are known to be biased, or have not been measured.
    Biased,
}

/// The laws that bound a scene, and how near to their bounds it is.
///
/// ```
/// use mesoscope::families::{self, Beyond};
/// use mesoscope::scene;
///
/// // A standing wave of shallow water is stable while p < 1.
/// let share = |step: &str| {
///     let scene = scene::load("shallow-water", &[format!("time.step={step}")])?;
///     let limits = families::limits(&scene);
///     let unstable = limits.iter().filter(|limit| limit.beyond == Beyond::Unstable);
///     Ok::<_, scene::SceneError>(unstable.map(|limit| limit.share).fold(0.0, f64::max))
/// };
/// assert!(share("0.001")? < 1.0 && share("1")? > 1.0);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn limits(scene: &Checked) -> Vec<Limit> {
    let mut limits = scene.model().physics().limits(scene);
    limits.retain(|limit| limit.share > 0.0);
    limits
}

/// The largest time step that a law allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestStep {
    /// The law, in a few words.
    pub law: &'static str,
    /// The largest time step.
    pub step: f64,
    /// What lies beyond.
    pub beyond: Beyond,
}

/// The largest time steps that the laws allow a scene, the smallest first.
///
/// ```
/// use mesoscope::{families, scene};
///
/// // Oscillators of frequency 1 with B = dt² tanh(dt/2)/(dt/2).
/// let scene = scene::load("gle-oscillator", &[])?;
/// let largest = families::largest_steps(&scene)[0];
/// let dt = largest.step;
/// // The step is known to 2e-4 of itself, and its square to twice that.
/// assert!((dt * dt * (1.0 + (0.5 * dt).tanh() / (0.5 * dt)) / 4.0 - 1.0).abs() < 4e-4, "{}", largest.law);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn largest_steps(scene: &Checked) -> Vec<LargestStep> {
    let share = |law: &str, step: f64| {
        limits(&at_step(scene, step)).iter().find(|limit| limit.law == law).map_or(0.0, |limit| limit.share)
    };
    let largest = |limit: Limit| {
        let step = largest_step([scene.time.step, limit.share], 2e-4, &|step| share(limit.law, step))?;
        Some(LargestStep { law: limit.law, step, beyond: limit.beyond })
    };
    let mut found: Vec<LargestStep> = limits(scene).into_iter().filter_map(largest).collect();
    found.sort_by(|a, b| a.step.total_cmp(&b.step));
    found
}

/// A scene with another time step, whether that is accepted or not.
pub(super) fn at_step(scene: &Scene, step: f64) -> Checked {
    let mut other = scene.clone();
    other.time.step = step;
    Checked::presumed(other)
}

/// Where a share that grows with the step is 1, to a precision, from a step and its share; none where that is nowhere near.
pub(super) fn largest_step([step, share]: [f64; 2], precision: f64, share_of: &dyn Fn(f64) -> f64) -> Option<f64> {
    // An interval around it; shares grow no slower than the root of the step.
    let (mut low, mut high) = (step, step);
    let mut at_low = share;
    for _ in 0..60 {
        if at_low < 1.0 {
            break;
        }
        low *= if at_low.is_finite() { (0.5 / at_low).clamp(0.05, 0.5) } else { 0.5 };
        at_low = share_of(low);
    }
    let mut at_high = if low < high { f64::INFINITY } else { share };
    for _ in 0..60 {
        if at_high >= 1.0 {
            break;
        }
        high *= (2.0 / at_high).clamp(2.0, 20.0);
        at_high = share_of(high);
    }
    if at_low >= 1.0 || at_high < 1.0 {
        return None;
    }
    while high > (1.0 + precision) * low {
        let middle = (low * high).sqrt();
        if share_of(middle) < 1.0 { low = middle } else { high = middle }
    }
    Some(low)
}
