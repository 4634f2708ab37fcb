//! Voronoi DPD: what a scene says about it.

mod analyses;

pub use analyses::{Neighbours, ShearWave};

use crate::families::NETWORK_VISCOSITY;
use crate::scene::{
    CorrelatedQuantity, CountedQuantity, Integrator, Interaction, Problem, Problems, Scene, SnapshotColor, Velocities,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// The most iterations of a step: all are recorded in advance, and skipped on the device once the tolerance is reached.
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
    #[must_use]
    pub fn friction_viscosity(&self) -> f64 {
        self.viscosity.or_else(|| Some(self.shear_viscosity? / NETWORK_VISCOSITY)).unwrap_or(1.0)
    }

    /// The highest temperature kT at the start, in a scene of a temperature.
    #[must_use]
    pub(crate) fn hottest(&self, temperature: f64) -> f64 {
        let regions = self.energy.iter().flat_map(|energy| &energy.initial_temperatures);
        regions.fold(temperature, |most, region| most.max(region.temperature))
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

/// Faces name the neighbour in this many bits.
const NEIGHBOUR_BITS: u32 = 28;

/// The lightest species may have this part of the mass of the heaviest, in the units of which all are counted.
pub(crate) const LIGHTEST: f64 = 1e-4;

/// Checks a scene whose interaction at `path` is Voronoi DPD.
pub(crate) fn check(scene: &Scene, voronoi: &VoronoiInteraction, path: &str, problems: &mut Problems) {
    if scene.interactions.len() > 1 {
        let accepted = "`voronoi` as the only interaction of a scene";
        problems.push(Problem::new(path, "found together with another interaction", accepted));
    }
    if scene.space.lengths.len() != 2 {
        let found = format!("found {} edges", scene.space.lengths.len());
        problems.push(Problem::new("space.box", found, "two edges: Voronoi cells are those of a plane"));
    }
    // Those of shallow water are refused with all scenes without it.
    if matches!(scene.integrator, Integrator::GrootWarren { .. } | Integrator::CotterReich {}) {
        let found = format!("found `{}`", scene.integrator.name());
        problems.push(Problem::new("integrator.type", found, "`splitting` or `euler`, the integrators of Voronoi DPD"));
    }
    check_fluid(scene, voronoi, path, problems);
    check_groups(scene, problems);
    check_output(scene, voronoi, problems);
    check_shear_wave(scene, problems);
}

fn check_fluid(scene: &Scene, voronoi: &VoronoiInteraction, path: &str, problems: &mut Problems) {
    if voronoi.viscosity.is_some() && voronoi.shear_viscosity.is_some() {
        let accepted = "one of `viscosity`, of the law of friction, and `shear_viscosity`, of the network of cells";
        problems.push(Problem::new(path, "both `viscosity` and `shear_viscosity` are given", accepted));
    }
    if voronoi.initial_masses == InitialMasses::UniformPressure {
        let regions = voronoi.energy.iter().flat_map(|energy| &energy.initial_temperatures);
        if voronoi.energy.is_none() {
            let accepted = "`uniform-density` in a scene without `energy`: at one temperature it is the same";
            let path = format!("{path}.initial_masses");
            problems.push(Problem::new(path, "found `uniform-pressure` without `energy`", accepted));
        } else if scene.temperature == 0.0 || regions.into_iter().any(|region| region.temperature == 0.0) {
            let found = "found `uniform-pressure` with a temperature of 0, at which there is no pressure";
            let accepted = "temperatures above 0 everywhere, or masses `equal` or of `uniform-density`";
            problems.push(Problem::new(format!("{path}.initial_masses"), found, accepted));
        }
    }
}

fn check_groups(scene: &Scene, problems: &mut Problems) {
    let heaviest = scene.particles.iter().map(|group| group.mass).fold(0.0, f64::max);
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}]");
        if group.fixed {
            let accepted = "cells that move: one that is held would take up momentum and energy of the others";
            problems.push(Problem::new(format!("{path}.fixed"), "found true", accepted));
        }
        if group.chain.is_some() {
            let accepted = "no chains in Voronoi DPD: its cells have no forces but those at their faces";
            problems.push(Problem::new(format!("{path}.chain"), "found a chain", accepted));
        }
        if group.mass < LIGHTEST * heaviest {
            let accepted = format!(
                "at least {:e}, {LIGHTEST:e} of the heaviest species: masses are counted in units of 2⁻²⁴ of that",
                LIGHTEST * heaviest
            );
            problems.push(Problem::new(format!("{path}.mass"), format!("found {}", group.mass), accepted));
        }
    }
    let cells: u64 =
        scene.particles.iter().fold(0, |sum, group| sum.saturating_add(group.resolved_count(scene.space.volume())));
    // A cell between its own images, many of them within its length, takes the longer to cut out the more they are.
    let least = 1e-3 * (scene.space.volume() / cells.max(1) as f64).sqrt();
    for (axis, length) in scene.space.lengths.iter().enumerate() {
        if scene.space.lengths.len() == 2 && *length < least {
            let accepted = format!("at least {least:.3e}, a thousandth of the width of a cell on average");
            problems.push(Problem::new(format!("space.box[{axis}]"), format!("found {length}"), accepted));
        }
    }
    // More than can be numbered at all is a mistake by itself.
    if cells > 1 << NEIGHBOUR_BITS && u32::try_from(cells).is_ok() {
        let accepted = format!(
            "at most {} cells, since faces name their neighbours in {NEIGHBOUR_BITS} bits",
            1 << NEIGHBOUR_BITS
        );
        problems.push(Problem::new("particles", format!("found {cells} cells in the scene"), accepted));
    }
}

fn check_output(scene: &Scene, voronoi: &VoronoiInteraction, problems: &mut Problems) {
    let output = &scene.output;
    if output.snapshot.color == SnapshotColor::Temperature && voronoi.energy.is_none() {
        let accepted = "`density`, `speed` or `species`; or an `energy` in the interaction";
        let found = "found `temperature` in a scene of one temperature";
        problems.push(Problem::new("output.snapshot.color", found, accepted));
    }
    if let Some(radius) = output.snapshot.radius {
        let accepted = "no `radius` in Voronoi DPD: pictures show cells, not discs";
        problems.push(Problem::new("output.snapshot.radius", format!("found {radius}"), accepted));
    }
    if output.radial_distribution.is_some() {
        let accepted = "`neighbours`, which counts the neighbours of cells; pairs have no range here";
        let found = "found in a scene of Voronoi DPD";
        problems.push(Problem::new("output.radial_distribution", found, accepted));
    }
    for (index, asked) in output.autocorrelations.iter().enumerate() {
        if asked.quantity == CorrelatedQuantity::Force {
            let path = format!("output.autocorrelations[{index}].quantity");
            let accepted = "\"velocity\" in Voronoi DPD, where momentum moves with mass";
            problems.push(Problem::new(path, "found \"force\"", accepted));
        }
    }
    for (index, asked) in output.histograms.iter().enumerate() {
        if asked.quantity == CountedQuantity::Acceleration {
            let path = format!("output.histograms[{index}].quantity");
            let accepted = "\"velocity\" or \"speed\" in Voronoi DPD, where momentum moves with mass";
            problems.push(Problem::new(path, "found \"acceleration\"", accepted));
        }
    }
}

/// A wave can be measured only where there is one.
fn check_shear_wave(scene: &Scene, problems: &mut Problems) {
    if scene.output.shear_wave.is_none() {
        return;
    }
    let waves: Vec<(usize, u32)> = shear_waves(scene).map(|(index, _, periods)| (index, periods)).collect();
    match waves.first() {
        None => {
            let accepted = "a scene in which some particles start with velocities of type `shear-wave`";
            problems.push(Problem::new("output.shear_wave", "found in a scene without a shear wave", accepted));
        }
        Some((first, periods)) => {
            for (index, other) in waves.iter().filter(|(_, other)| other != periods) {
                let accepted = format!("{periods} as in particles[{first}]: one wave is measured");
                let path = format!("particles[{index}].velocities.periods");
                problems.push(Problem::new(path, format!("found {other}"), accepted));
            }
        }
    }
}

/// Groups that start with a shear wave, with its amplitude and number of periods.
pub fn shear_waves(scene: &Scene) -> impl Iterator<Item = (usize, f64, u32)> {
    scene.particles.iter().enumerate().filter_map(|(index, group)| match group.velocities {
        Velocities::ShearWave { amplitude, periods } => Some((index, amplitude, periods)),
        _ => None,
    })
}

/// Refuses what has a meaning for Voronoi cells only.
pub(crate) fn check_absence(scene: &Scene, problems: &mut Problems) {
    let only = "a scene with a `voronoi` interaction only";
    let mut refuse = |path: &str, found: &str| problems.push(Problem::new(path, found, only));
    if scene.integrator == (Integrator::Euler {}) {
        refuse("integrator.type", "found `euler`");
    }
    for (index, _, _) in shear_waves(scene) {
        refuse(&format!("particles[{index}].velocities.type"), "found `shear-wave`");
    }
    let output = &scene.output;
    match output.snapshot.color {
        SnapshotColor::Density => refuse("output.snapshot.color", "found `density`"),
        SnapshotColor::Temperature => refuse("output.snapshot.color", "found `temperature`"),
        SnapshotColor::Species | SnapshotColor::Speed => {}
    }
    let without = "found in a scene without Voronoi cells";
    if output.neighbours.is_some() {
        refuse("output.neighbours", without);
    }
    if output.shear_wave.is_some() {
        refuse("output.shear_wave", without);
    }
}
