//! Boundaries that shear what is in the box.

use super::Axis;
use super::defaults::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Periodic boundaries that move past each other (Lees and Edwards, doi:10.1088/0022-3719/5/15/006): the copy of the box above it along
/// `gradient` moves along `flow`, and what is between flows with a velocity that grows linearly in between.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shear {
    /// Change of the velocity along `flow` per length along `gradient`; of either sign. Zero is as good as no shear.
    pub rate: f64,
    /// The axis along which boundaries and fluid move: `x`.
    #[serde(default = "along_x")]
    pub flow: Axis,
    /// The axis along which the velocity grows: `y` or `z`.
    pub gradient: Axis,
    /// How far the copy of the box above it is displaced along `flow` at the start. A run that starts from the state of one with shear
    /// takes it from there.
    #[serde(default, skip_serializing_if = "is_default")]
    pub displacement: f64,
}

impl Shear {
    /// The largest velocity of the linear profile in a box with such edges, that at a boundary.
    pub(crate) fn speed(&self, edges: &[f64]) -> f64 {
        0.5 * (self.rate * edges.get(self.gradient as usize).copied().unwrap_or(1.0)).abs()
    }

    /// The displacement at the start in 2⁻³² of the edge along the flow, of boxes with such edges.
    pub(crate) fn first_shift(&self, edges: &[f64]) -> u32 {
        let boxes = (self.displacement / edges.first().copied().unwrap_or(1.0)).fract();
        (boxes * 4_294_967_296.0).round_ties_even() as i64 as u32
    }
}

fn along_x() -> Axis {
    Axis::X
}
