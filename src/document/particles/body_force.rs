//! Forces that act on every particle from outside.

use crate::document::Axis;
use crate::document::defaults::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A force on every particle, whatever the others do: what drives a flow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyForceInteraction {
    /// How the force varies in space.
    #[serde(default, skip_serializing_if = "is_default")]
    pub profile: ForceProfile,
    /// The force on a particle, a component for each axis of the box; of a sine the amplitude.
    #[schemars(length(min = 1, max = 3))]
    pub force: Vec<f64>,
    /// The axis along which the force varies; with `opposed` and `sinusoidal` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Axis>,
    /// Number of waves in the box, 1 if left out; with `sinusoidal` only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 65536))]
    pub waves: Option<u32>,
    /// The species on which it acts; all if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 256))]
    pub species: Option<Vec<String>>,
}

/// How a body force varies in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ForceProfile {
    /// The same everywhere (default).
    #[default]
    Uniform,
    /// The opposite in the second half of the box along `axis`: periodic Poiseuille flow.
    Opposed,
    /// A sine along `axis`.
    Sinusoidal,
}

impl ForceProfile {
    /// Whether it is the same everywhere.
    pub(crate) fn is_uniform(self) -> bool {
        self == Self::Uniform
    }
}
