//! Voronoi DPD: what a scene says about it.

use super::error::Problem;
use super::{Integrator, Interaction, Scene, Velocities};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Dissipative particles that are the cells of a Voronoi tessellation of a periodic plane: Flekkøy, Coveney and De
/// Fabritiis, doi:10.1103/PhysRevE.62.2140. The only interaction of a scene.
///
/// Cells push each other by their pressures, rub at their faces with the viscosity of the fluid, and are kicked by the
/// noise that goes with it. Without `energy` every cell is at the temperature of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VoronoiInteraction {
    /// How forces and mass exchange follow from the tessellation.
    #[serde(default)]
    pub form: VoronoiForm,
    /// Viscosity η of the law of friction between faces. The shear viscosity of the network of cells is
    /// 1.22 to 1.25 η, and half of density times self-diffusion on top. Zero leaves friction and noise out.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub viscosity: f64,
    /// Mass m of a molecule, of which a cell holds M/m.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub molecular_mass: f64,
    /// The equation of state.
    #[serde(default)]
    pub equation_of_state: EquationOfState,
    /// Internal energies that cells keep account of: heat conduction, viscous heating and random heat flux, with the
    /// total energy constant to the last bit. Left out, cells are at the temperature of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<CellEnergy>,
    /// The masses of cells at the start; `mass` of the particles is their mean.
    #[serde(default)]
    pub initial_masses: InitialMasses,
    /// The largest part of a cell's mass, and of its internal energy by conduction, that crosses one face in one step: a
    /// finite step could take more than there is. The run counts how often this acted.
    #[serde(default = "tenth")]
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
    /// Cells exchange mass as their faces turn, at the rate that the geometry asks for and with the logarithmic mean
    /// density.
    Consistent,
    /// The same as printed: half the rate of mass exchange, and the arithmetic mean density. Runs hot unless the Reynolds
    /// number of a cell and its number of molecules are small.
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

/// Cells that keep account of their internal energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellEnergy {
    /// Heat conductivity, in units of k: `conductivity (l/r)(T_l - T_k)` flows through a face. Zero leaves
    /// conduction and the random heat flux out.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub conductivity: f64,
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
}

/// Conjugate gradients for the velocities after friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FrictionSolver {
    /// The most iterations of a step: each is recorded ahead, and skipped on the device once the tolerance is reached.
    #[schemars(range(min = 1, max = 1000))]
    pub iterations: u32,
    /// Residual relative to the right-hand side at which to stop. Momentum is conserved to the last bit whatever it is.
    #[schemars(range(max = 0.1), extend("exclusiveMinimum" = 0))]
    pub tolerance: f64,
}

impl Default for FrictionSolver {
    fn default() -> Self {
        Self { iterations: 40, tolerance: 1e-5 }
    }
}

fn one() -> f64 {
    1.0
}

fn tenth() -> f64 {
    0.1
}

/// The Voronoi interaction of a scene, if it has one.
#[must_use]
pub(crate) fn voronoi(scene: &Scene) -> Option<&VoronoiInteraction> {
    scene.interactions.iter().find_map(|interaction| match interaction {
        Interaction::Voronoi(voronoi) => Some(voronoi),
        _ => None,
    })
}

/// Checks a scene whose interaction at `path` is Voronoi DPD.
pub(super) fn check(scene: &Scene, _voronoi: &VoronoiInteraction, path: &str, problems: &mut Vec<Problem>) {
    if scene.interactions.len() > 1 {
        let accepted = "`voronoi` as the only interaction of a scene";
        problems.push(Problem::new(path, "found another interaction beside it", accepted));
    }
    if scene.space.lengths.len() != 2 {
        let found = format!("found {} edges", scene.space.lengths.len());
        problems.push(Problem::new("space.box", found, "two edges: Voronoi cells are those of a plane"));
    }
    if !matches!(scene.integrator, Integrator::Splitting {} | Integrator::Euler {}) {
        let found = format!("found `{}`", scene.integrator.name());
        problems.push(Problem::new("integrator.type", found, "`splitting` or `euler`, the integrators of Voronoi DPD"));
    }
}

/// Refuses what has no meaning without Voronoi cells.
pub(super) fn check_absence(scene: &Scene, problems: &mut Vec<Problem>) {
    let only = "a scene with a `voronoi` interaction only";
    if scene.integrator == (Integrator::Euler {}) {
        problems.push(Problem::new("integrator.type", "found `euler`", only));
    }
    for (index, group) in scene.particles.iter().enumerate() {
        if matches!(group.velocities, Velocities::ShearWave { .. }) {
            let path = format!("particles[{index}].velocities.type");
            problems.push(Problem::new(path, "found `shear-wave`", only));
        }
    }
}
