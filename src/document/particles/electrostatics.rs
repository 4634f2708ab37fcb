//! Forces between charged particles.

use crate::document::defaults::{hundredths, is_default, whole};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The electrostatic force between charged particles: clouds of a Gaussian density e^(-r²/2σ²), which interact as
/// kT lB q q' erf(r/2σ)/r, or of Slater's, in a periodic box with a conducting medium around it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElectrostaticsInteraction {
    /// Bjerrum length lB: two unit charges far from each other have the energy kT lB/r, kT being the temperature of the scene.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bjerrum_length: f64,
    /// Width σ of a Gaussian charge, the standard deviation of its density along each axis; .6076 where `decay` is left out too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width: Option<f64>,
    /// Decay β of Slater's charges, in place of Gaussian ones: they interact as kT lB q q' [1 - (1 + βr) e^(-2βr)]/r, and need a finer mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub decay: Option<f64>,
    /// The largest distance of neighbouring nodes of the mesh; the mesh has the fewest nodes that its Fourier transform takes. Of `waves` half of the
    /// shortest wavelength.
    #[serde(default = "hundredths::<50>")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// The way to sum over waves.
    #[serde(default, skip_serializing_if = "is_default")]
    pub method: ElectrostaticsMethod,
    /// Points of the splines that spread charges over nodes along each axis, and of the differences that make forces: 4 or 6. Of
    /// no matter for `waves`.
    #[serde(default = "whole::<6>")]
    #[schemars(range(min = 4, max = 6))]
    pub order: u32,
    /// A uniform background that neutralizes the charges of the particles, if true; without it they have to add up to zero.
    #[serde(default, skip_serializing_if = "is_default")]
    pub background: bool,
}

/// A way to sum over the waves of charges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ElectrostaticsMethod {
    /// A mesh and its Fourier transform.
    #[default]
    Mesh,
    /// Every wave by itself, with exact phases: for few charges in small boxes, and to compare with.
    Waves,
}

impl ElectrostaticsInteraction {
    /// Width of Gaussian charges that have none: they have the contact energy of the charges that Groot introduced,
    /// doi:10.1063/1.1574800: 52/(35 · 1.6).
    pub(crate) const WIDTH: f64 = 0.6076;
}

/// An electric field from outside, the same everywhere: a force on every particle with a `charge`, beside what charges do to each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElectricFieldInteraction {
    /// The force on a unit charge, a component for each axis of the box; of an oscillating field the amplitude.
    #[schemars(length(min = 1, max = 3))]
    pub field: Vec<f64>,
    /// Oscillations in a unit of time, the field being that of `field` times cos(2π `frequency` t); left out, it is constant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub frequency: Option<f64>,
}
