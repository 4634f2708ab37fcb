//! Friction and noise on every particle by itself: Langevin dynamics and the generalised Langevin equation.

use crate::document::{FrictionVelocity, LangevinInteraction};
use crate::families::BathStep;
use crate::families::Species;

/// A heat bath on every coordinate of every particle.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionBath {
    /// Temperature kT of the bath.
    pub temperature: f64,
    /// Bath step of a coordinate, for each species.
    pub steps: Vec<BathStep>,
    /// Whether the bath remembers.
    pub memory: bool,
    /// Friction is relative to the mean flow of a sheared box, not to the box.
    pub peculiar: bool,
}

impl PositionBath {
    pub(crate) fn new(
        interaction: &LangevinInteraction,
        species: &[Species],
        temperature: f64,
        time_step: f64,
        sheared: bool,
    ) -> Self {
        let friction = |name: &str| {
            let own = interaction.species.iter().find(|entry| entry.name == name);
            own.map_or(interaction.friction, |entry| entry.friction)
        };
        // What is held gains nothing from a bath.
        let step = |species: &Species| {
            let step = BathStep::of(&interaction.bath, friction(&species.name), time_step);
            if species.fixed { step.uncoupled() } else { step }
        };
        Self {
            temperature: interaction.bath.temperature(temperature),
            steps: species.iter().map(step).collect(),
            memory: interaction.bath.remembers(),
            peculiar: sheared && interaction.velocity != Some(FrictionVelocity::Laboratory),
        }
    }
}
