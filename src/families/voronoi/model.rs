//! Voronoi DPD: cells of a tessellation with mass, momentum and internal energy.
//!
//! Flekkøy, Coveney and De Fabritiis, doi:10.1103/PhysRevE.62.2140.

use crate::document::{CellIntegrator, FrictionSolver, InitialMasses, Scene, VoronoiForm, VoronoiInteraction};
use crate::families::Species;

/// Voronoi DPD.
#[derive(Debug, Clone, PartialEq)]
pub struct Voronoi {
    /// Integrator.
    pub integrator: CellIntegrator,
    /// How forces and mass exchange follow from the tessellation.
    pub form: VoronoiForm,
    /// Viscosity η of the law of friction.
    pub viscosity: f64,
    /// Mass m of a molecule.
    pub molecular_mass: f64,
    /// Heat conductivity over k, of cells that keep account of their energy.
    pub conductivity: Option<f64>,
    /// The largest part of a cell's mass or energy that crosses a face in a step.
    pub exchange_limit: f64,
    /// Conjugate gradients of the friction.
    pub solver: FrictionSolver,
    /// The masses of cells at the start.
    pub initial_masses: InitialMasses,
    /// Value of one unit of integer mass; a power of two.
    pub mass_unit: f64,
    /// Value of one unit of integer energy; a power of two.
    pub energy_unit: f64,
}

impl Voronoi {
    /// Voronoi DPD of a scene with such species.
    pub(crate) fn new(
        interaction: &VoronoiInteraction,
        integrator: CellIntegrator,
        scene: &Scene,
        species: &[Species],
    ) -> Self {
        let heaviest = species.iter().map(|species| species.mass).fold(0.0, f64::max);
        // Range for a hundred times the heaviest cell and its energy, in steps small against f32's.
        let unit = |scale: f64| if scale > 0.0 { (scale.log2().ceil() - 24.0).exp2() } else { 2_f64.powi(-24) };
        let energy = interaction.hottest(scene.temperature) * (1.0 + heaviest / interaction.molecular_mass);
        Self {
            integrator,
            form: interaction.form,
            viscosity: interaction.friction_viscosity(),
            molecular_mass: interaction.molecular_mass,
            conductivity: interaction.energy.as_ref().map(|energy| energy.conductivity),
            exchange_limit: interaction.exchange_limit,
            solver: interaction.friction_solver,
            initial_masses: interaction.initial_masses,
            mass_unit: unit(heaviest),
            energy_unit: unit(energy),
        }
    }

    /// Whether cells exchange mass.
    pub(crate) fn exchanges_mass(&self) -> bool {
        self.form != VoronoiForm::Gradient
    }

    /// Whether the limit on what crosses a face may act, on mass, heat or the volume that a turning face sweeps over:
    /// always, but for cells without any pressure.
    pub(crate) fn has_limits(&self, temperature: f64) -> bool {
        self.exchanges_mass() || self.keeps_energy() || temperature > 0.0
    }

    /// Whether the velocities after friction are solved for.
    pub(crate) fn solves(&self) -> bool {
        self.viscosity > 0.0 && self.integrator != CellIntegrator::Euler {}
    }

    /// Whether cells keep account of their internal energy; else all are at the temperature of the scene.
    #[must_use]
    pub fn keeps_energy(&self) -> bool {
        self.conductivity.is_some()
    }
}
