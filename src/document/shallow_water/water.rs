//! Rotating shallow water: what a scene says about it.

use crate::document::BathScheme;
use crate::document::defaults::whole;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rotating shallow water on particles and a periodic mesh: Cotter and Reich, doi:10.1209/epl/i2003-00621-8.
///
/// The mean depth is 1; depth is measured as mass per mesh node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShallowWaterInteraction {
    /// Mesh nodes on each axis.
    #[schemars(extend("items" = serde_json::json!({"type": "integer", "minimum": 1, "maximum": 4096})))]
    pub mesh: [u32; 2],
    /// Order of the B-splines between particles and mesh: 1 linear, 2 quadratic, 3 cubic (default). A lower order is
    /// cheaper and rougher.
    #[serde(default = "whole::<3>")]
    #[schemars(range(min = 1, max = 3))]
    pub spline_order: u32,
    /// Speed c₀ of gravity waves.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wave_speed: f64,
    /// Coriolis parameter f₀, of du/dt = f₀v, dv/dt = -f₀u: positive in the northern hemisphere. The equations as Cotter and
    /// Reich print them turn the other way, which is a negative value here. Zero switches the rotation off.
    #[serde(default)]
    pub rotation: f64,
    /// The smoothing of the depth that drives the particles.
    #[serde(default)]
    pub smoothing: Smoothing,
    /// The smoothed surface at the start, as features that are added to a depth of 1; the masses of the particles follow
    /// from it. Left out, the water is flat.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub surface: Vec<SurfaceFeature>,
    /// A heat bath on every mesh node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bath: Option<MeshBath>,
}

/// The smoothing (1 - Λ²∇²)^-power of the depth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Smoothing {
    /// Length Λ; zero switches the smoothing off.
    #[schemars(range(min = 0.0))]
    pub length: f64,
    /// How often it is applied.
    #[schemars(range(min = 1, max = 2))]
    pub power: u32,
    /// How it is computed.
    pub solver: SmoothingSolver,
}

impl Default for Smoothing {
    fn default() -> Self {
        Self { length: 0.0, power: 1, solver: SmoothingSolver::default() }
    }
}

/// How the smoothing is computed: a fixed symmetric positive operator on the mesh in any case, so that energy is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SmoothingSolver {
    /// By fast Fourier transform, to rounding (default). Mesh edges are powers of two.
    Fft {
        /// The approximation of the Laplacian.
        #[serde(default)]
        symbol: LaplacianSymbol,
    },
    /// By a Chebyshev polynomial of the five-point Laplacian, started from zero and therefore positive at any length. Works on any
    /// mesh. The looser its tolerance, the cheaper it is; `fft` was cheaper still on all meshes that it accepts.
    Chebyshev {
        /// Bound on the relative error of every Fourier mode of (1 - Λ²∇²)⁻¹.
        #[serde(default = "millionth")]
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        tolerance: f64,
    },
}

impl Default for SmoothingSolver {
    fn default() -> Self {
        Self::Fft { symbol: LaplacianSymbol::default() }
    }
}

fn millionth() -> f64 {
    1e-6
}

/// The approximation of the Laplacian in Fourier space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LaplacianSymbol {
    /// The five-point difference: -Σ (2 sin(kΔx/2)/Δx)² (default).
    #[default]
    FivePoint,
    /// The exact derivative: -k².
    Spectral,
}

/// A heat bath on every mesh node, coupled to the depth there: equation (26) of Cotter and Reich,
/// doi:10.1209/epl/i2003-00621-8.
///
/// It acts on the mesh, through which the water flows, so it also slows a uniform flow down: it is not Galilean invariant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MeshBath {
    /// Exponential memory with coupling λ = εΛ² and rate α = εc₀/Λ.
    Memory {
        /// Strength ε. At fixed λ/α, a large value is the limit without memory.
        #[schemars(range(min = 0.0))]
        epsilon: f64,
        /// The scheme of the bath step.
        #[serde(default)]
        scheme: BathScheme,
        /// The definition of the rate.
        #[serde(default)]
        rate: BathRate,
    },
    /// White noise and friction γ = Λ³/c₀, the limit without memory: equations (18)-(21).
    White {},
}

/// The definition of the rate of a mesh bath.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BathRate {
    /// α = εc₀/Λ (default): then γ = λ/α = Λ³/c₀, as the paper says.
    #[default]
    WaveSpeed,
    /// α = εΛ/c₀, as the paper prints it.
    Printed,
}

/// A feature of the surface of shallow water, periodic in the box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SurfaceFeature {
    /// Two opposed fronts along x, amplitude·tanh(sin(η)/width) with η = y + meander·(sin 3x - sin 2x), where x and y
    /// run from 0 to 2π over the box. In geostrophic balance it is a pair of jets, which is unstable.
    Front {
        /// Depth on the higher side.
        amplitude: f64,
        /// Width of the fronts.
        #[schemars(extend("exclusiveMinimum" = 0))]
        width: f64,
        /// Amplitude of the disturbance.
        #[serde(default)]
        meander: f64,
    },
    /// A hill (a hollow if the amplitude is negative), Gaussian near its centre: amplitude·exp(-Σ(1 - cos κ(x - x₀))/(κ·radius)²)
    /// with κ = 2π over the edge of the box. In geostrophic balance it is a vortex.
    Bump {
        /// Centre.
        center: [f64; 2],
        /// Standard deviation.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
        /// Height.
        amplitude: f64,
    },
    /// A plane wave amplitude·cos(2π(n₁x/L₁ + n₂y/L₂)).
    Wave {
        /// Periods across the box on each axis.
        periods: [i32; 2],
        /// Height.
        amplitude: f64,
    },
}
