//! What colours of pictures of Voronoi cells show.

use crate::document::SnapshotColor;
use crate::families::pictures::{CellValues, ValueScale};
use crate::families::{Model, Voronoi};
use crate::state::Reported;
use crate::tessellation::Tessellation;

/// Values of cells for a colour, if that is not the one of the species.
pub(super) fn cell_values(
    cells: &Voronoi,
    color: SnapshotColor,
    state: &Reported,
    tessellation: &Tessellation,
    model: &Model,
) -> Option<CellValues> {
    let units = model.units;
    let mass = |id: usize| f64::from(state.masses[id]) * cells.mass_unit;
    let square =
        |id: usize| units.momentum(state.momenta[id]).iter().map(|component| component * component).sum::<f64>();
    let all = 0..state.masses.len().min(state.len());
    Some(match color {
        SnapshotColor::Species => return None,
        SnapshotColor::Speed => {
            let values = all.map(|id| square(id).sqrt() / mass(id)).collect();
            CellValues { label: "speed (length/time)", values, scale: ValueScale::Speeds }
        }
        SnapshotColor::Temperature if cells.keeps_energy() => {
            let internal =
                |id: usize| f64::from(state.energies[id]) * cells.energy_unit - square(id) / (2.0 * mass(id));
            let values = all.map(|id| cells.molecular_mass * internal(id) / mass(id)).collect();
            CellValues { label: "temperature (energy)", values, scale: ValueScale::Temperatures }
        }
        SnapshotColor::Density | SnapshotColor::Temperature => {
            let values = all.map(|id| mass(id) / tessellation.cells[id].volume).collect();
            let cell_mass = (0..state.len()).map(mass).sum::<f64>() / state.len().max(1) as f64;
            let mean = cell_mass * state.len() as f64 / units.volume();
            let scale = ValueScale::Densities { mean, molecules: cell_mass / cells.molecular_mass };
            CellValues { label: "density (mass/area)", values, scale }
        }
    })
}
