//! Pair forces of dissipative particle dynamics, doi:10.1063/1.474784.

use crate::document::{Bath, DpdInteraction};
use crate::families::BathStep;
use crate::families::Species;

/// Soft repulsion, friction and noise between all pairs of species.
#[derive(Debug, Clone, PartialEq)]
pub struct PairForce {
    /// Range of the force.
    pub cutoff: f64,
    /// Exponent of the friction weight ω = (1 - r/rc)^exponent.
    pub weight_exponent: f64,
    /// Temperature kT of the bath.
    pub temperature: f64,
    /// The bath of every pair.
    pub bath: Bath,
    /// Margin of a neighbour list beyond the cutoff.
    pub skin: f64,
    species: usize,
    repulsion: Vec<f64>,
    friction: Vec<f64>,
}

impl PairForce {
    pub(crate) fn new(interaction: &DpdInteraction, species: &[Species], temperature: f64) -> Self {
        let count = species.len();
        let mut force = Self {
            cutoff: interaction.cutoff,
            weight_exponent: interaction.weight_exponent,
            temperature: interaction.bath.temperature(temperature),
            bath: interaction.bath.clone(),
            skin: interaction.skin,
            species: count,
            repulsion: vec![interaction.repulsion; count * count],
            friction: vec![interaction.friction; count * count],
        };
        for pair in &interaction.pairs {
            let index = |name: &str| species.iter().position(|species| species.name == name);
            let (Some(a), Some(b)) = (index(&pair.between[0]), index(&pair.between[1])) else { continue };
            for entry in [a * count + b, b * count + a] {
                if let Some(repulsion) = pair.repulsion {
                    force.repulsion[entry] = repulsion;
                }
                if let Some(friction) = pair.friction {
                    force.friction[entry] = friction;
                }
            }
        }
        force
    }

    /// No force: nothing reaches further than half the shortest edge.
    pub(crate) fn none(units: &crate::state::Units, species: usize) -> Self {
        let zeros = vec![0.0; species * species];
        Self {
            cutoff: 0.5 * units.shortest_length(),
            weight_exponent: 2.0,
            temperature: 0.0,
            bath: Bath::default(),
            skin: 0.0,
            species,
            repulsion: zeros.clone(),
            friction: zeros,
        }
    }

    /// Repulsion a between two species.
    #[must_use]
    pub fn repulsion(&self, a: usize, b: usize) -> f64 {
        self.repulsion[a * self.species + b]
    }

    /// rc |V''| of the conservative force between two species, at most.
    #[must_use]
    pub fn stiffness(&self, a: usize, b: usize) -> f64 {
        self.repulsion(a, b).abs()
    }

    /// Friction γ between two species.
    #[must_use]
    pub fn friction(&self, a: usize, b: usize) -> f64 {
        self.friction[a * self.species + b]
    }

    /// Whether the bath of pairs has a memory, and any effect.
    #[must_use]
    pub fn remembers(&self) -> bool {
        matches!(self.bath, Bath::Memory { .. }) && self.has_friction()
    }

    /// The bath step of a pair of species, coupled to φ(r).
    #[must_use]
    pub fn bath_step(&self, a: usize, b: usize, time_step: f64) -> BathStep {
        BathStep::of(&self.bath, self.friction(a, b), time_step)
    }

    /// Whether any pair of species has friction, with memory or without.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.bath.acts(self.largest_friction())
    }

    /// Whether any pair of species has a force at all.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.largest_repulsion() > 0.0 || self.has_friction()
    }

    /// The largest magnitude of any repulsion.
    #[must_use]
    pub fn largest_repulsion(&self) -> f64 {
        self.repulsion.iter().fold(0.0, |most: f64, a| most.max(a.abs()))
    }

    /// The largest friction.
    #[must_use]
    pub fn largest_friction(&self) -> f64 {
        self.friction.iter().fold(0.0, |most: f64, a| most.max(*a))
    }
}
