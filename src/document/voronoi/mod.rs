//! Voronoi DPD: what a scene says about it.

use super::defaults::{hundredths, one};
use super::{Scene, Velocities};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shear viscosity of a network of cells over the viscosity η of their friction: the middle of what is measured, 1.22 to
/// 1.25. What cells carry by moving about, half of density times self-diffusion, comes on top.
pub const NETWORK_VISCOSITY: f64 = 1.235;

/// Dissipative particles that are the cells of a Voronoi tessellation of a periodic plane: Flekkøy, Coveney and De
/// Fabritiis, doi:10.1103/PhysRevE.62.2140. The only interaction of a scene.
///
/// Cells push each other with their pressures. At their faces act the friction that follows from the viscosity of the fluid, and the noise
/// that belongs to it. Without `energy` every cell is at the temperature of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VoronoiInteraction {
    /// How forces and mass exchange follow from the tessellation.
    #[serde(default)]
    pub form: VoronoiForm,
    /// Viscosity η of the law of friction between faces; left out, 1, unless `shear_viscosity` is given. The shear
    /// viscosity of the network of cells is 1.22 to 1.25 η. Half of density times self-diffusion adds to it, and so does pressure where
    /// cells hold many molecules. Zero switches friction and noise off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub viscosity: Option<f64>,
    /// The desired shear viscosity of the network of cells, in place of `viscosity`, which is then this divided by 1.235. Transport by the
    /// motion of cells, half of density times self-diffusion, and their pressure add to it: measure the sum with `output.viscosity` or
    /// `output.shear_wave`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub shear_viscosity: Option<f64>,
    /// Mass m of a molecule, of which a cell holds M/m.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub molecular_mass: f64,
    /// The equation of state.
    #[serde(default)]
    pub equation_of_state: EquationOfState,
    /// Internal energies of cells: heat conduction, viscous heating and random heat flux, with the total energy constant to the last bit.
    /// Left out, cells are at the temperature of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<CellEnergy>,
    /// The masses of cells at the start; `mass` of the particles is their mean.
    #[serde(default)]
    pub initial_masses: InitialMasses,
    /// The largest part of a cell's mass, of its internal energy, by conduction and with mass each, and of its volume by the
    /// turning face of close cells, that crosses one face in one step: in a finite step more could cross than there is. The
    /// run counts how often the limit acted.
    #[serde(default = "hundredths::<10>")]
    #[schemars(range(max = 0.5), extend("exclusiveMinimum" = 0))]
    pub exchange_limit: f64,
    /// How the integrator `splitting` solves for the velocities after friction.
    #[serde(default)]
    pub friction_solver: FrictionSolver,
}

/// How forces and mass exchange follow from the tessellation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VoronoiForm {
    /// Cells of constant mass pushed by the gradient of their free energy (default): exactly canonical.
    #[default]
    Gradient,
    /// Cells exchange mass as their faces turn, at the rate that follows from the geometry and with the logarithmic mean density.
    Consistent,
    /// The same as printed: half the rate of mass exchange, and the arithmetic mean density. The temperature is too high unless
    /// the Reynolds number of a cell and its number of molecules are small.
    Paper,
}

/// How pressure and temperature follow from mass, volume and internal energy.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum EquationOfState {
    /// The ideal gas in two dimensions: pV = E, kT = mE/M.
    #[default]
    IdealGas,
}

/// Internal energies of cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellEnergy {
    /// Heat conductivity, in units of k: `conductivity (l/r)(T_l - T_k)` flows through a face. Zero switches
    /// conduction and the random heat flux off.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub conductivity: f64,
    /// Regions that start hotter or colder than the temperature of the scene; where they overlap the last one counts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256))]
    pub initial_temperatures: Vec<TemperatureRegion>,
}

/// A disc of cells with a temperature of their own at the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemperatureRegion {
    /// Centre.
    pub center: [f64; 2],
    /// Radius.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
    /// Temperature kT.
    #[schemars(range(min = 0.0))]
    pub temperature: f64,
}

/// The masses of cells at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InitialMasses {
    /// Every cell of a group has the group's mass (default).
    #[default]
    Equal,
    /// In proportion to the volume of the cell: a fluid of the same density everywhere.
    UniformDensity,
    /// In proportion to volume over temperature: a fluid of the same pressure everywhere, however hot.
    UniformPressure,
}

/// Conjugate gradients for the velocities after friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FrictionSolver {
    /// The most iterations of a step; the device skips those that are not needed once the tolerance is reached.
    #[schemars(range(min = 1, max = 1000))]
    pub iterations: u32,
    /// The residual, relative to the right-hand side, at which to stop. Momentum is conserved to the last bit whatever it is.
    #[schemars(range(max = 0.1), extend("exclusiveMinimum" = 0))]
    pub tolerance: f64,
}

impl Default for FrictionSolver {
    fn default() -> Self {
        Self { iterations: 40, tolerance: 1e-5 }
    }
}

impl VoronoiInteraction {
    /// Viscosity η of the law of friction.
    pub(crate) fn friction_viscosity(&self) -> f64 {
        self.viscosity.or_else(|| Some(self.shear_viscosity? / NETWORK_VISCOSITY)).unwrap_or(1.0)
    }

    /// The highest temperature kT at the start, in a scene of a temperature.
    pub(crate) fn hottest(&self, temperature: f64) -> f64 {
        let regions = self.energy.iter().flat_map(|energy| &energy.initial_temperatures);
        regions.fold(temperature, |most, region| most.max(region.temperature))
    }
}

/// Groups that start with a shear wave, with its amplitude and number of periods.
pub(crate) fn shear_waves(scene: &Scene) -> impl Iterator<Item = (usize, f64, u32)> {
    scene.particles.iter().enumerate().filter_map(|(index, group)| match group.velocities {
        Velocities::ShearWave { amplitude, periods } => Some((index, amplitude, periods)),
        _ => None,
    })
}
