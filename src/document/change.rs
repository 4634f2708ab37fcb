//! Changes to a simulation between its steps.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A change to a simulation, as its checkpoints keep it.
///
/// ```
/// use mesoscope::prelude::*;
///
/// let scene = scene::load("dpd-fluid", &["space.box=[4,4,4]", "output={}"].map(str::to_owned))?;
/// let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
/// let rounding: Rounding = simulation.set("temperature", 0.5)?;
/// let [Change { step, key, value, .. }] = simulation.changes() else { return Ok(()) };
/// assert_eq!((*step, key.as_str(), value.as_f64(), rounding.momentum), (0, "temperature", Some(0.5), [0.0; 3]));
/// # Ok::<(), RunError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// The step before which it was made.
    pub step: u64,
    /// The key of the scene, or `positions` or `velocities`.
    pub key: String,
    /// The new value; none of arrays.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    pub value: Value,
    /// The rounding that it cost.
    pub rounding: Rounding,
}

/// Rounding of a change to whole units of positions or momenta.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Rounding {
    /// The largest deviation of a component from what was given, in units of the scene.
    pub largest: f64,
    /// The change of the total momentum by a change of the unit, in units of the scene: zero where no unit changes.
    pub momentum: [f64; 3],
}

/// Name of the section of a checkpoint that keeps changes.
const SECTION: &str = "changes";

impl Change {
    /// True if a number of the scene was changed, and no array.
    pub(crate) fn is_of_number(&self) -> bool {
        !self.value.is_null()
    }

    /// The section of a checkpoint, if anything was changed.
    pub(crate) fn section(changes: &[Self]) -> Option<(String, Vec<u8>)> {
        (!changes.is_empty()).then(|| (SECTION.to_owned(), serde_json::to_vec(changes).unwrap_or_default()))
    }

    /// The changes in the sections of a checkpoint.
    pub(crate) fn from_sections(sections: &[(String, Vec<u8>)]) -> Vec<Self> {
        let found = sections.iter().find(|(name, _)| name == SECTION);
        found.and_then(|(_, bytes)| serde_json::from_slice(bytes).ok()).unwrap_or_default()
    }
}
