//! What pictures of a state show, as data.

use super::Field;
use crate::document::FieldQuantity;
use crate::numbers::counted_in_groups;
use crate::quantity::Quantity;

/// What pictures of a state are of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// Particles, where there are two or three dimensions.
    Particles,
    /// Cells of a tessellation.
    Cells,
    /// Fields on the nodes of a mesh.
    Fields,
}

/// What the chart of energies is of.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EnergyChart {
    /// The conditions, for the line below the title.
    pub subtitle: String,
    /// Energies are those of one of these, of which there are so many; none of energies of the whole.
    pub per: Option<(&'static str, u64)>,
    /// Another unit of energies and temperatures.
    pub unit: Option<&'static str>,
    /// Dimension of the box.
    pub dimension: usize,
    /// True if temperatures say nothing: of a flow that no bath keeps in equilibrium.
    pub is_athermal: bool,
    /// Set temperature kT to compare with.
    pub temperature: Option<f64>,
    /// True if the exact motion conserves the total energy.
    pub is_conserved: bool,
}

impl EnergyChart {
    /// The energies of so many particles of this name in a box of this dimension.
    #[must_use]
    pub fn of(noun: &'static str, count: u64, dimension: usize) -> Self {
        Self { subtitle: counted_in_groups(count, noun), per: Some((noun, count)), dimension, ..Self::default() }
    }
}

/// Values of cells that colours show.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CellValues {
    /// What they are, with their unit.
    pub label: &'static str,
    /// One for each cell.
    pub values: Vec<f64>,
    /// What leads one to expect their range.
    pub scale: ValueScale,
}

/// What the range of values follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ValueScale {
    /// Speeds at the temperature of the scene.
    Speeds,
    /// Temperatures about that of the scene.
    Temperatures,
    /// Densities about a mean, of so many molecules a cell.
    Densities { mean: f64, molecules: f64 },
}

/// Fourier modes whose wave numbers are close to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WaveShell {
    /// The wave number in the middle of the shell.
    pub wave_number: f64,
    /// The number of modes in it.
    pub modes: u64,
}

/// Fields on a mesh, and closed curves on top of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MeshPictures {
    /// The fields.
    pub fields: Vec<ShownField>,
    /// Points of the curves.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// What they are computed by, in words.
    pub method: &'static str,
    /// Parameters of the scene that files of the fields name.
    pub parameters: Vec<(&'static str, f64)>,
}

/// A field on the nodes of a mesh, ready to be named and drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownField {
    /// What it is.
    pub quantity: FieldQuantity,
    /// Its files have this name.
    pub described: Quantity,
    /// Its name in the CF conventions, where they have one.
    pub standard_name: Option<&'static str>,
    /// Its value at rest, from which its colours diverge where it has values on both sides.
    pub centre: Option<f64>,
    /// Whether its range begins at zero.
    pub from_zero: bool,
    /// Its values.
    pub field: Field,
}
