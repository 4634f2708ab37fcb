//! Groups of particles: how many, where they start and how fast.

use super::defaults::{is_default, one, whole};
use super::{Axis, Scene, Space};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::fmt;

/// A group of particles of one species.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParticleGroup {
    /// Name of the species; groups of the same species share their mass.
    #[schemars(length(min = 1))]
    pub species: String,
    /// The type of its particles in the file of a `state`, by number or name; left out, the one that is called as the species, or where the
    /// file has numbers only, the one in the place that the species has in the scene.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub file_type: Option<FileType>,
    /// Number of particles; give this or `number_density`, or list `placement.positions`. With a `state`, its file knows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// Particles per unit volume (area in two dimensions), of the box or, behind walls, of their layer; the count is rounded to the nearest
    /// integer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub number_density: Option<f64>,
    /// Mass of one particle; left out, 1, or what the file of a `state` says. Left out in shallow water, where the surface determines it.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: f64,
    /// Charge of one particle in elementary charges, rounded to 2⁻¹⁶ of one, for the interaction `electrostatics`; groups of the same species
    /// share it.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(min = -1024.0, max = 1024.0), extend("x-of" = ["particles"], "x-instead" = {
        "shallow-water": "particles without a charge: nothing acts on charges in shallow water",
        "voronoi": "cells without a charge: nothing acts on charges in Voronoi DPD",
    }))]
    pub charge: f64,
    /// Shallow water: particles without mass that drift with the flow. The circulation of a tracer group on a circle is measured.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    #[schemars(extend("x-of" = ["shallow-water"]))]
    pub tracer: bool,
    /// Whether the particles stay where they start.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "shallow-water": "particles that move: in shallow water all of them carry the depth along",
        "voronoi": "cells that move: one that is held would absorb momentum and energy of the others",
    }))]
    pub fixed: bool,
    /// The chains that the particles form, one after the other; left out, none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "shallow-water": "no chains in shallow water: its particles have no forces between them",
        "voronoi": "no chains in Voronoi DPD: its cells have no forces but those at their faces",
    }))]
    pub chain: Option<Chain>,
    /// Where the particles start.
    #[serde(default)]
    pub placement: Placement,
    /// Their velocities at the start.
    #[serde(default)]
    pub velocities: Velocities,
}

/// A type of particles in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FileType {
    /// Its number.
    Number(u32),
    /// Its name.
    Name(String),
}

impl fmt::Display for FileType {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(formatter),
            Self::Name(name) => name.fmt(formatter),
        }
    }
}

/// Chains of particles with consecutive numbers; `bonds` and `angles` act along them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// Particles in a chain; the group has to be a whole number of chains.
    #[schemars(range(min = 2))]
    pub beads: u32,
    /// Distance of neighbours along a chain at the start.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// Whether the last particle of a chain is bonded to the first.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub closed: bool,
}

/// Where the particles of a group start.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Placement {
    /// Independent uniform positions.
    #[default]
    #[serde(rename_all = "kebab-case")]
    Random,
    /// The smallest nearly cubic (square) lattice that holds the group, filled evenly.
    Lattice {
        /// Largest random shift of a particle along each axis, as a part of the spacing. Not for chains.
        #[serde(default, skip_serializing_if = "is_default")]
        #[schemars(range(min = 0.0, max = 1.0))]
        jitter: f64,
    },
    /// Positions listed one by one; each is taken modulo the box.
    Listed {
        /// One position per particle.
        positions: Vec<Vec<f64>>,
    },
    /// Evenly on a circle, counterclockwise; two dimensions only.
    Circle {
        /// Centre.
        center: [f64; 2],
        /// Radius.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: f64,
    },
    /// In a layer behind the walls across an axis, evenly but in no order. The particles are frozen: they never move against their wall, and
    /// the wall absorbs what pairs give them.
    #[serde(rename_all = "kebab-case")]
    #[schemars(extend("x-of" = ["particles"]))]
    BehindWalls {
        /// The axis that the walls cross.
        axis: Axis,
        /// The wall; left out, both.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        wall: Option<WallSide>,
        /// Depth of the layer, in units of length: the largest cutoff makes it as good as one without an end.
        #[schemars(extend("exclusiveMinimum" = 0))]
        thickness: f64,
    },
}

/// One of the two walls across an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WallSide {
    /// At the coordinate 0.
    Lower,
    /// At the length of the box.
    Upper,
}

impl Placement {
    /// Volume (area) in which a density counts particles: that of the layers behind walls, else that of the box.
    pub(crate) fn volume(&self, space: &Space) -> f64 {
        let Self::BehindWalls { axis, wall, thickness } = self else { return space.volume() };
        let layers = if wall.is_some() { 1.0 } else { 2.0 };
        space.lengths.get(*axis as usize).map_or(0.0, |length| layers * thickness * space.volume() / length)
    }

    /// The place where a particle of a group starts, if the scene says so: by its number and the number of all.
    pub(crate) fn position(&self, number: u64, count: u64) -> Option<[f64; 3]> {
        match self {
            Self::Listed { positions } => {
                let position = positions.get(number as usize)?;
                Some(std::array::from_fn(|axis| position.get(axis).copied().unwrap_or(0.0)))
            }
            Self::Circle { center, radius } => {
                let (sine, cosine) = (TAU * number as f64 / count as f64).sin_cos();
                Some([center[0] + radius * cosine, center[1] + radius * sine, 0.0])
            }
            Self::Random | Self::Lattice { .. } | Self::BehindWalls { .. } => None,
        }
    }

    /// Whether the particles start on a lattice, shifted or not.
    pub(crate) fn is_lattice(&self) -> bool {
        matches!(self, Self::Lattice { .. })
    }
}

/// The velocities of the particles of a group at the start.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Velocities {
    /// Maxwell's distribution at the temperature of the scene; the net momentum of all thermal groups together is
    /// removed to the last bit.
    #[default]
    Thermal,
    /// At rest.
    Rest,
    /// Shallow water: in balance between rotation and the slope of the smoothed surface, V = (c₀²/f₀)(-∂H/∂y, ∂H/∂x).
    #[schemars(extend("x-of" = ["shallow-water"]))]
    Geostrophic,
    /// Voronoi DPD: a transverse wave `u_x = amplitude sin(2π periods y/L)` on top of Maxwell's distribution.
    #[schemars(extend("x-of" = ["voronoi"]))]
    ShearWave {
        /// The largest velocity.
        amplitude: f64,
        /// Number of waves in the box.
        #[serde(default = "whole::<1>")]
        #[schemars(range(min = 1, max = 64))]
        periods: u32,
    },
    /// Velocities listed one by one.
    Listed {
        /// One velocity per particle.
        velocities: Vec<Vec<f64>>,
    },
}

impl Chain {
    /// Number of links of a length along one chain. A closed one goes on from its last particle to its first, if it is long
    /// enough that no particle is its own neighbour and no link is met twice.
    pub(crate) fn links(&self, length: u64) -> u64 {
        let beads = u64::from(self.beads.max(1));
        if self.closed && beads > 2 { beads } else { beads.saturating_sub(length - 1) }
    }
}

/// A group with the numbers of its particles.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NumberedGroup<'a> {
    /// The group.
    pub group: &'a ParticleGroup,
    /// The number of its first particle; the others follow.
    pub first: u64,
    /// Number of its particles.
    pub count: u64,
}

impl NumberedGroup<'_> {
    /// Particles of one of its chains; one where it has none.
    pub(crate) fn beads(&self) -> u64 {
        self.group.chain.as_ref().map_or(1, |chain| u64::from(chain.beads.max(1)))
    }

    /// Number of its chains.
    pub(crate) fn chains(&self) -> u64 {
        self.count / self.beads()
    }
}

impl Scene {
    /// Its groups of chains with the numbers of their particles: those of the species that are named, all where none are.
    pub(crate) fn chained_groups<'a>(
        &'a self,
        named: Option<&[String]>,
    ) -> impl Iterator<Item = (NumberedGroup<'a>, &'a Chain)> {
        let chained = self.numbered_groups().filter_map(|numbered| Some((numbered, numbered.group.chain.as_ref()?)));
        chained.filter(move |(numbered, _)| numbered.group.is_among(named))
    }
}

/// Parts of an elementary charge that charges are multiples of.
pub(crate) const CHARGE_PARTS: f64 = 65536.0;

impl ParticleGroup {
    /// The charge of a particle in 2⁻¹⁶ of an elementary one.
    pub(crate) fn charge_parts(&self) -> i32 {
        (self.charge * CHARGE_PARTS).round() as i32
    }

    /// True if its species is named, or none is.
    pub(crate) fn is_among(&self, species: Option<&[String]>) -> bool {
        species.is_none_or(|names| names.contains(&self.species))
    }

    /// Whether the particles make up a layer behind walls, and never move against them.
    pub(crate) fn is_frozen(&self) -> bool {
        matches!(self.placement, Placement::BehindWalls { .. })
    }

    /// Whether nothing that acts on the particles moves them.
    pub(crate) fn is_held(&self) -> bool {
        self.fixed || self.is_frozen()
    }

    /// Number of particles, whichever way the scene gives it; a density is rounded to whole chains.
    #[must_use]
    pub fn resolved_count(&self, space: &Space) -> u64 {
        let beads = self.chain.as_ref().map_or(1.0, |chain| f64::from(chain.beads.max(1)));
        match (&self.placement, self.count, self.number_density) {
            (Placement::Listed { positions }, _, _) => positions.len() as u64,
            (_, Some(count), _) => count,
            (_, None, Some(density)) => ((density * self.placement.volume(space) / beads).round() * beads) as u64,
            (_, None, None) => 0,
        }
    }
}
