//! Walls at the faces of the box.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pairs of plane walls that bound the box, where particles are reflected. An axis that is not named is periodic.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Walls {
    /// Walls across the x axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<WallPair>,
    /// Walls across the y axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y: Option<WallPair>,
    /// Walls across the z axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<WallPair>,
}

/// Two walls across an axis: the lower at the coordinate 0, the upper at the length of the box.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallPair {
    /// What becomes of the velocity of a particle that meets a wall.
    #[serde(default)]
    pub reflection: Reflection,
    /// The velocity of the lower wall, a component for each axis of the box, of which that across the wall is 0; at rest if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 3))]
    pub lower_velocity: Option<Vec<f64>>,
    /// The velocity of the upper wall, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 3))]
    pub upper_velocity: Option<Vec<f64>>,
}

/// What becomes of the velocity of a particle that meets a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reflection {
    /// The velocity relative to the wall is reversed (default): the fluid sticks to the wall, but for a slip that is measured.
    #[default]
    BounceBack,
    /// The component across the wall is reversed and the others are kept: the fluid slips without friction.
    Specular,
}

impl Walls {
    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.of_axes().iter().all(Option::is_none)
    }

    /// The walls across each axis.
    pub(crate) fn of_axes(&self) -> [Option<&WallPair>; 3] {
        [self.x.as_ref(), self.y.as_ref(), self.z.as_ref()]
    }
}

impl WallPair {
    /// The velocities of the lower and the upper wall, with zeros for axes that are not given.
    pub(crate) fn velocities(&self) -> [[f64; 3]; 2] {
        [&self.lower_velocity, &self.upper_velocity].map(|velocity| {
            let given = velocity.as_deref().unwrap_or_default();
            std::array::from_fn(|axis| given.get(axis).copied().unwrap_or(0.0))
        })
    }
}
