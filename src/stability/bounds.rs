//! Where laws say that the edges of a row are.

use super::range::Spacing;
use super::request::Request;
use crate::families::{self, Beyond};
use crate::scene::SceneError;
use crate::study::each_once;
use serde::{Deserialize, Serialize};

/// Halvings of the distance to a bound.
const ROUNDS: usize = 16;

/// How many times a row is made wider, by its own width where values differ by ratios and twice as much each time where they differ by
/// differences, to find a bound outside of it.
const WIDTHS: usize = 6;

/// Where a law puts the edge of a row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bound {
    /// The law, in a few words.
    pub law: String,
    /// Whether no run is stable beyond it; else runs are said to be biased.
    pub is_of_stability: bool,
    /// The value of the key along the row.
    pub at: f64,
}

/// The bounds of a row: those between its ends, and those below or above them that are not far, each by their value.
///
/// # Errors
/// [`SceneError`] when a file that scenes start from cannot be read, or is not what it was.
pub(super) fn bounds(request: &Request, row: usize) -> Result<[Vec<Bound>; 2], SceneError> {
    let along = &request.along;
    let of_value = |value: &f64| Ok(limits(request, row, *value)?.unwrap_or_default());
    let limits_of: Vec<Vec<families::Limit>> = along.values.iter().map(of_value).collect::<Result<_, SceneError>>()?;
    let share = |limits: &[families::Limit], law: &str| {
        limits.iter().find(|limit| limit.law == law).map_or(0.0, |limit| limit.share)
    };
    let [mut within, mut outside] = [Vec::new(), Vec::new()];
    for (law, beyond) in each_once(limits_of.iter().flatten().map(|limit| (limit.law, limit.beyond))) {
        let is_within = |value: f64| Ok(limits(request, row, value)?.map(|limits| share(&limits, law) < 1.0));
        let shares: Vec<f64> = limits_of.iter().map(|limits| share(limits, law)).collect();
        let crossing = shares.windows(2).position(|pair| (pair[0] < 1.0) != (pair[1] < 1.0));
        let inside = crossing.map(|place| [along.values[place], along.values[place + 1]]);
        let ends = match inside {
            Some(ends) => Some(ends),
            // What is never strained has no bound.
            None if shares.iter().all(|share| *share == 0.0) => None,
            None => ends_outside(&along.values, along.spacing, &is_within)?,
        };
        let Some([mut low, mut high]) = ends else { continue };
        let at_low = is_within(low)?.unwrap_or(true);
        for _ in 0..ROUNDS {
            let middle = along.spacing.middle(low, high);
            if is_within(middle)?.unwrap_or(true) == at_low { low = middle } else { high = middle }
        }
        let at = along.spacing.middle(low, high);
        let bound = Bound { law: law.to_owned(), is_of_stability: beyond == Beyond::Unstable, at };
        if inside.is_some() { within.push(bound) } else { outside.push(bound) }
    }
    for bounds in [&mut within, &mut outside] {
        bounds.sort_by(|a: &Bound, b| a.at.total_cmp(&b.at));
    }
    Ok([within, outside])
}

/// Two values outside of a row, one beyond the other, between which a law changes its mind, on whichever side that is nearer. None where it
/// does not.
fn ends_outside(
    values: &[f64],
    spacing: Spacing,
    is_within: &dyn Fn(f64) -> Result<Option<bool>, SceneError>,
) -> Result<Option<[f64; 2]>, SceneError> {
    let [Some(first), Some(last)] = [values.first().copied(), values.last().copied()] else { return Ok(None) };
    let Some(inside) = is_within(first)? else { return Ok(None) };
    // Ratios of a single value, or of a narrow row, would lead nowhere.
    let mut step = spacing.distance(first, last).max(spacing.least());
    let [mut low, mut high] = [first, last];
    for _ in 0..WIDTHS {
        let [lower, higher] = [spacing.moved(low, -step), spacing.moved(high, step)];
        // Most keys are above zero, and so are their bounds.
        let lower = if low > 0.0 && lower <= 0.0 { low / 8.0 } else { lower };
        // What is no scene says nothing.
        if is_within(higher)? == Some(!inside) {
            return Ok(Some([high, higher]));
        }
        if is_within(lower)? == Some(!inside) {
            return Ok(Some([lower, low]));
        }
        [low, high] = [lower, higher];
        if spacing == Spacing::Linear {
            step *= 2.0;
        }
    }
    Ok(None)
}

/// What laws say of one scene; none where it is none.
fn limits(request: &Request, row: usize, value: f64) -> Result<Option<Vec<families::Limit>>, SceneError> {
    match request.varied(row, value, 0) {
        Ok(scene) => Ok(Some(families::limits(&scene))),
        // That says nothing about the scene.
        Err(error @ (SceneError::Read { .. } | SceneError::StateChanged { .. })) => Err(error),
        Err(_) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// An oscillator of frequency ω in a Verlet scheme is stable up to ω dt = 2.
    #[test]
    fn the_bound_of_tethered_particles_is_that_of_an_oscillator() {
        let scene = r#"{
            "title": "Oscillators", "space": {"box": [5, 5, 5]}, "time": {"step": 0.01, "steps": 100},
            "temperature": 1, "particles": [{"species": "A", "count": 10}],
            "interactions": [{"type": "tether", "stiffness": 16}], "integrator": {"type": "cotter-reich"}
        }"#;
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("oscillators.json");
        std::fs::write(&path, scene).unwrap();
        let request = Request::load(path.to_str().unwrap(), &[], None, &["time.step=0.01..2/6".to_owned()]).unwrap();
        let [within, outside] = bounds(&request, 0).unwrap();
        assert_eq!((within.len(), outside.len()), (1, 0), "{within:?} {outside:?}");
        assert!((within[0].at - 0.5).abs() < 1e-3 && within[0].is_of_stability, "{within:?}");
        // It does not vanish where it lies beyond the values, or below them.
        for range in ["0.01..0.1/3", "0.8..2/3", "0.1..0.2/2:linear", "0.3,0.4"] {
            let request = Request::load(path.to_str().unwrap(), &[], None, &[format!("time.step={range}")]).unwrap();
            let [within, outside] = bounds(&request, 0).unwrap();
            assert_eq!((within.len(), outside.len()), (0, 1), "{range}: {within:?} {outside:?}");
            assert!((outside[0].at - 0.5).abs() < 1e-3, "{range}: {outside:?}");
        }
    }
}
