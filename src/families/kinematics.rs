//! Velocities and masses of particles, from the integers of a state.

use super::Model;
use crate::state::Reported;

/// The numbers that velocities and masses follow from.
#[derive(Debug, Clone, Default)]
pub(crate) struct Kinematics {
    /// Value of one unit of integer momentum.
    momentum: f64,
    /// Masses of the species.
    masses: Vec<f64>,
    /// Value of one unit of integer mass, where every particle has a mass of its own.
    mass_unit: Option<f64>,
    /// True if momenta are per unit of mass, as in shallow water.
    specific_momenta: bool,
}

impl Kinematics {
    pub(crate) fn new(model: &Model) -> Self {
        Self {
            momentum: model.units.momentum,
            masses: model.species.iter().map(|species| species.mass).collect(),
            mass_unit: model.physics().mass_unit(),
            specific_momenta: model.physics().has_specific_momenta(),
        }
    }

    /// The mass of a particle.
    pub(crate) fn mass(&self, state: &Reported, particle: usize) -> f64 {
        match (self.mass_unit, state.masses.get(particle)) {
            (Some(unit), Some(mass)) => f64::from(*mass) * unit,
            _ => self.masses[state.species[particle] as usize],
        }
    }

    /// The velocity of a particle.
    pub(crate) fn velocity(&self, state: &Reported, particle: usize) -> [f64; 3] {
        let mass = if self.specific_momenta { 1.0 } else { self.mass(state, particle) };
        state.momenta[particle].map(|units| f64::from(units) * self.momentum / mass)
    }

    /// Units of integer momentum that a velocity of a particle is, before rounding.
    pub(crate) fn units_of(&self, velocity: f64, state: &Reported, particle: usize) -> f64 {
        let mass = if self.specific_momenta { 1.0 } else { self.mass(state, particle) };
        velocity * mass / self.momentum
    }
}
