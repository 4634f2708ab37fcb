//! Where laws say that the edges of a row are.

use super::range::Spacing;
use super::request::Request;
use crate::families::{self, Beyond};
use crate::scene::SceneError;
use serde::{Deserialize, Serialize};

/// Halvings of the distance to a bound.
const ROUNDS: usize = 16;

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

/// The bounds of a row that lie between its ends.
///
/// # Errors
/// [`SceneError`] when a file that scenes start from cannot be read, or is not what it was.
pub(super) fn bounds(request: &Request, row: usize) -> Result<Vec<Bound>, SceneError> {
    let along = &request.along;
    let shares = along.values.iter().map(|value| limits(request, row, *value)).collect::<Result<Vec<_>, _>>()?;
    let mut laws: Vec<&'static str> = Vec::new();
    for limit in shares.iter().flatten() {
        if !laws.contains(&limit.law) {
            laws.push(limit.law);
        }
    }
    let share = |limits: &[families::Limit], law: &str| {
        limits.iter().find(|limit| limit.law == law).map_or(0.0, |limit| limit.share)
    };
    let mut found = Vec::new();
    for law in laws {
        let beyond = shares.iter().flatten().find(|limit| limit.law == law).map(|limit| limit.beyond);
        let crossing = shares.windows(2).position(|pair| (share(&pair[0], law) < 1.0) != (share(&pair[1], law) < 1.0));
        let Some(place) = crossing else { continue };
        let (low, high) = (along.values[place], along.values[place + 1]);
        let rises = share(&shares[place], law) < 1.0;
        let at = crossing_between(low, high, along.spacing, &|value| {
            Ok((share(&limits(request, row, value)?, law) < 1.0) == rises)
        })?;
        found.push(Bound { law: law.to_owned(), is_of_stability: beyond == Some(Beyond::Unstable), at });
    }
    found.sort_by(|a, b| a.at.total_cmp(&b.at));
    Ok(found)
}

/// What laws say of one scene; nothing where it is none.
fn limits(request: &Request, row: usize, value: f64) -> Result<Vec<families::Limit>, SceneError> {
    match request.varied(row, value) {
        Ok(scene) => Ok(families::limits(&scene)),
        // That says nothing about the scene.
        Err(error @ (SceneError::Read { .. } | SceneError::StateChanged { .. })) => Err(error),
        Err(_) => Ok(Vec::new()),
    }
}

fn crossing_between(
    mut low: f64,
    mut high: f64,
    spacing: Spacing,
    is_before: &dyn Fn(f64) -> Result<bool, SceneError>,
) -> Result<f64, SceneError> {
    for _ in 0..ROUNDS {
        let middle = spacing.middle(low, high);
        if is_before(middle)? { low = middle } else { high = middle }
    }
    Ok(spacing.middle(low, high))
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
        let request = Request::load(path.to_str().unwrap(), &[], &["time.step=0.01..2/6".to_owned()]).unwrap();
        let found = bounds(&request, 0).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].at - 0.5).abs() < 1e-3 && found[0].is_of_stability, "{found:?}");
    }
}
