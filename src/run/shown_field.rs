//! What the fields of shallow water are called and how they are shown.

use super::RunError;
use crate::engine::Engine;
use crate::families::{Model, ShallowWater};
use crate::measure::circulation::largest_gap;
use crate::measure::{Field, MeshFlow};
use crate::plot::ColorMap;
use crate::scene::FieldQuantity;
use crate::state::State;

/// A field on the nodes of the mesh, ready to be named and drawn.
pub(super) struct ShownField {
    /// What its files are called.
    pub(super) stem: &'static str,
    /// How it is coloured.
    pub(super) map: ColorMap,
    name: &'static str,
    label: &'static str,
    /// Node (k, l) at k + l·nₓ.
    values: Vec<f64>,
}

impl ShownField {
    /// A field of a flow with a smoothed depth.
    pub(super) fn new(quantity: FieldQuantity, flow: &MeshFlow, depth: &[f64]) -> Self {
        let (name, label, map, values) = match quantity {
            FieldQuantity::Depth => ("depth", "Depth h (mean depths)", ColorMap::Sequential, depth.to_vec()),
            FieldQuantity::PotentialVorticity => (
                "potential vorticity",
                "Potential vorticity (ζ + f_{0})/h (1/time units)",
                ColorMap::Sequential,
                flow.potential_vorticity(depth),
            ),
            FieldQuantity::Vorticity => {
                ("vorticity", "Vorticity ζ (1/time units)", ColorMap::Diverging { centre: 0.0 }, flow.vorticity())
            }
            FieldQuantity::Speed => ("speed", "Speed (length units/time units)", ColorMap::Sequential, flow.speed()),
        };
        Self { stem: quantity.stem(), map, name, label, values }
    }

    /// The field for a picture and an array, whose first index is that of x.
    pub(super) fn field(&self, model: &Model, water: &ShallowWater) -> Field {
        let nodes = water.mesh.map(|nodes| nodes as usize);
        let places = (0..nodes[0]).flat_map(|k| (0..nodes[1]).map(move |l| k + l * nodes[0]));
        Field {
            name: self.name.to_owned(),
            label: self.label.to_owned(),
            nodes,
            lengths: [model.units.lengths[0], model.units.lengths[1]],
            values: places.map(|place| self.values[place]).collect(),
        }
    }
}

/// The smoothed depth on the nodes of the mesh, right after a report.
pub(super) fn mesh_depth(engine: &mut Engine<'_>, water: &ShallowWater) -> Result<Vec<f64>, RunError> {
    let words = engine.words("depths")?;
    Ok(words.iter().take(water.nodes() as usize).map(|word| 1.0 + f64::from(f32::from_bits(*word))).collect())
}

/// The points of every closed loop of tracers that is still a curve.
pub(super) fn closed_loops(state: &State, model: &Model, water: &ShallowWater) -> Vec<Vec<[f64; 2]>> {
    let spacing = water.spacing(model.units.lengths);
    let loops = water.closed_loops();
    loops
        .filter(|(_, range)| largest_gap(&model.units, &state.positions[range.clone()]) < spacing)
        .map(|(_, range)| {
            state.positions[range]
                .iter()
                .map(|position| model.units.position(*position))
                .map(|[x, y, _]| [x, y])
                .collect()
        })
        .collect()
}
