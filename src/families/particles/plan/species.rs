//! How kernels know what species are like: by constants where there are few, else by a table.

use crate::families::particles::terms::pairs::law::have_ranges;
use crate::families::{self, Model};
use crate::plan::switch;
use crate::shaders::space::{Coefficients, MassOfParticle, RelativeMotion};
use crate::shaders::{Choices, Constant};

/// Where kernels find the coefficients of pairs and the masses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Species {
    count: usize,
    /// The mass that all particles have; nothing if they differ or some are held.
    mass: Option<f64>,
    /// True if pairs of species have cutoffs or exponents of their own, or several repulsions.
    ranges: bool,
    /// Whether particles may be copies that shear gives another velocity.
    sheared: bool,
    /// Whether some are held.
    held: bool,
}

impl Species {
    pub(crate) fn of(model: &Model) -> Self {
        let mut masses = model.species.iter().map(|species| (!species.fixed).then_some(species.mass));
        let first = masses.next().unwrap_or(Some(1.0));
        let mass = first.filter(|mass| masses.all(|other| other == Some(*mass)));
        let ranges = model.particles().pair_force.as_ref().is_some_and(have_ranges);
        let (sheared, held) = (model.particles().shear.is_some(), model.species.iter().any(|species| species.fixed));
        Self { count: model.species.len(), mass, ranges, sheared, held }
    }

    /// True if there is a table: all coefficients of a single species that can move are constants, unless it has
    /// several cutoffs.
    pub(crate) fn have_table(self) -> bool {
        self.count > 1 || self.mass.is_none() || self.ranges
    }

    /// Whether all particles have the same mass. Friction then acts on differences of momentum, else of velocity.
    pub(crate) fn have_one_mass(self) -> bool {
        self.mass.is_some()
    }

    /// The mass in the constants: that of all particles, or 1 where they differ.
    pub(crate) fn mass(self) -> f64 {
        self.mass.unwrap_or(1.0)
    }

    /// The inverse mass of a species in the table: zero if it is fixed, and negative if it is frozen and moves with its
    /// wall.
    pub(crate) fn inverse_mass(species: &families::Species) -> f64 {
        match (species.fixed, species.frozen) {
            (_, true) => -1.0 / species.mass,
            (true, false) => 0.0,
            (false, false) => 1.0 / species.mass,
        }
    }

    /// Where kernels find coefficients.
    pub(crate) fn choices(self) -> Choices {
        Choices::new()
            .with_if(self.sheared, RelativeMotion::Sheared)
            .with(MassOfParticle::OfSpecies)
            .with(if self.have_table() { Coefficients::Table } else { Coefficients::Single })
    }

    /// The constants that say whose masses differ, and whether some particles do not move.
    pub(crate) fn constants(self) -> [(Constant, f64); 2] {
        [switch(Constant::OneMass, self.have_one_mass()), switch(Constant::Held, self.held)]
    }
}
