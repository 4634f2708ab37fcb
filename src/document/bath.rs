//! Heat baths, as all families have them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The heat bath of a coupling function h: doi:10.1209/epl/i2003-00621-8.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Bath {
    /// Friction and noise without memory: the force -∇h (γ dh/dt + √(2kTγ) dW/dt).
    White {
        /// Temperature kT of this bath; left out, that of the scene.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        temperature: Option<f64>,
    },
    /// Exponential memory: the force -s∇h with ds = -αs dt + λ dh + √(2kTλα) dW, where λ = αγ. For a fast bath the limit
    /// without memory.
    Memory {
        /// Rate α at which the bath forgets.
        #[schemars(range(min = 0.0))]
        rate: f64,
        /// Coupling λ, in place of a friction; required for a bath that never forgets (α = 0).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        coupling: Option<f64>,
        /// The scheme of the bath step.
        #[serde(default)]
        scheme: BathScheme,
        /// Temperature kT of this bath; left out, that of the scene.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        temperature: Option<f64>,
    },
}

impl Default for Bath {
    fn default() -> Self {
        Self::White { temperature: None }
    }
}

impl Bath {
    /// Whether it does anything to what has such a friction.
    pub(crate) fn acts(&self, friction: f64) -> bool {
        match self {
            Self::White { .. } => friction > 0.0,
            Self::Memory { rate, coupling, .. } => coupling.unwrap_or(rate * friction) > 0.0,
        }
    }

    /// The bath has memory.
    pub(crate) fn remembers(&self) -> bool {
        matches!(self, Self::Memory { .. })
    }

    /// The temperature of the bath in a scene of a temperature.
    #[must_use]
    pub fn temperature(&self, scene: f64) -> f64 {
        match self {
            Self::White { temperature } | Self::Memory { temperature, .. } => temperature.unwrap_or(scene),
        }
    }
}

/// The scheme of a bath step with memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, strum::Display)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum BathScheme {
    /// Equation (16) of Cotter and Reich, stable for any rate (default).
    #[default]
    CotterReich,
    /// Their symmetric variant, the implicit midpoint rule.
    Symmetric,
    /// The exact Ornstein-Uhlenbeck step.
    Exponential,
}
