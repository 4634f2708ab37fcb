//! The state that a scene of particles starts from, where it is in a file.

use super::defaults::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A file that particles start from: a frame of GSD or extended XYZ, a data file of LAMMPS, or the directory of an earlier run,
/// of which the last checkpoint is taken. Shallow water starts from fields on its nodes, `.npz` or `NetCDF`, or from an earlier run.
///
/// The file has the places of all particles, their species by name, and bonds and angles by type; the groups of the scene say
/// what its species are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateFile {
    /// The file or directory, relative to the scene; for a built-in scene to the working directory.
    #[schemars(length(min = 1))]
    pub file: String,
    /// The frame, from 0; negative ones are counted from the end.
    #[serde(default = "last")]
    #[schemars(range(min = -4_294_967_295_i64, max = 4_294_967_295_i64))]
    pub frame: i64,
    /// Where velocities come from.
    #[serde(default)]
    pub velocities: StateVelocities,
    /// How many copies of the box of the file stand side by side, axis by axis; left out, one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 3), extend("items" = serde_json::json!({"type": "integer", "format": "uint32", "minimum": 1})))]
    pub replicate: Vec<u32>,
    /// The style of the atoms of a LAMMPS data file that does not say it, as in an input script: `atomic`, `bond`, `angle`, `molecular`,
    /// `charge`, `full`, `mdpd`, or `hybrid` and several of these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub atom_style: Option<String>,
    /// What becomes of positions outside the box.
    #[serde(default, skip_serializing_if = "is_default")]
    pub outside: OutsidePositions,
    /// CRC-32 of what was read, as `run.json` has it; a file with another one is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
}

fn last() -> i64 {
    -1
}

/// What becomes of the positions of a state from a file that lie outside its box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OutsidePositions {
    /// The file is refused (default).
    #[default]
    Refuse,
    /// They are taken modulo the box, along axes without walls, and the turns are counted, on top of those that the file has.
    Wrap,
}

/// Where the velocities of a state from a file come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StateVelocities {
    /// The file, as they are: a velocity of the centre of mass stays (default).
    #[default]
    File,
    /// Maxwell's distribution at the temperature of the scene; the net momentum is removed to the last bit.
    Thermal,
    /// All particles start at rest.
    Rest,
}

impl StateFile {
    /// Copies along every axis.
    pub(crate) fn copies(&self) -> [u32; 3] {
        std::array::from_fn(|axis| self.replicate.get(axis).copied().unwrap_or(1).max(1))
    }
}

/// The number of copies in all.
pub(crate) fn number_of_copies(copies: [u32; 3]) -> u64 {
    copies.iter().fold(1, |product: u64, copies| product.saturating_mul((*copies).into()))
}
