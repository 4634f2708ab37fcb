//! The fields of shallow water, what they are called and how they are shown.

use super::circulation::largest_gap;
use super::flow::MeshFlow;
use crate::document::FieldQuantity;
use crate::families::pictures::{MeshPictures, ShownField};
use crate::families::{Field, Model, ShallowWater};
use crate::quantity::{Quantity, RATE, Unit, VELOCITY, quantity};
use crate::state::Reported;

/// What the fields are computed by.
const METHOD: &str = "rotating shallow water by the Hamiltonian particle-mesh method";

/// Fields of a state with a smoothed depth, and loops of tracers that are still curves.
pub(super) fn pictures(
    water: &ShallowWater,
    quantities: &[FieldQuantity],
    state: &Reported,
    depth: &[f64],
    model: &Model,
) -> MeshPictures {
    let flow = MeshFlow::new(model, water, state);
    let fields = quantities.iter().map(|quantity| field(*quantity, &flow, depth, model, water)).collect();
    // The mean depth H is 1, and c₀² = gH.
    let parameters = vec![
        ("coriolis_parameter", water.rotation),
        ("gravity", water.wave_speed * water.wave_speed),
        ("mean_depth", 1.0),
        ("smoothing_length", water.smoothing.length),
    ];
    MeshPictures { fields, loops: closed_loops(state, model, water), method: METHOD, parameters }
}

/// The name of a field in the table of standard names of the CF conventions, where it has one.
fn standard_name(field: FieldQuantity) -> Option<&'static str> {
    match field {
        FieldQuantity::Depth => Some("sea_floor_depth_below_sea_surface"),
        FieldQuantity::PotentialVorticity => None,
        FieldQuantity::Vorticity => Some("ocean_relative_vorticity"),
        FieldQuantity::Speed => Some("sea_water_speed"),
        FieldQuantity::VelocityX => Some("sea_water_x_velocity"),
        FieldQuantity::VelocityY => Some("sea_water_y_velocity"),
    }
}

/// The quantity of a field, which has the name of its files.
pub(super) fn described(field: FieldQuantity) -> Quantity {
    let (symbol, unit, meaning) = match field {
        FieldQuantity::Depth => ("h", Unit::Other("mean depths"), "depth"),
        FieldQuantity::PotentialVorticity => ("(ζ + f_{0})/h", RATE, "potential vorticity"),
        FieldQuantity::Vorticity => ("ζ", RATE, "vorticity"),
        FieldQuantity::Speed => ("|u|", VELOCITY, "speed"),
        FieldQuantity::VelocityX => ("u", VELOCITY, "velocity along x"),
        FieldQuantity::VelocityY => ("v", VELOCITY, "velocity along y"),
    };
    quantity(field.stem(), symbol, unit, meaning)
}

/// A field of a flow with a smoothed depth.
fn field(asked: FieldQuantity, flow: &MeshFlow, depth: &[f64], model: &Model, water: &ShallowWater) -> ShownField {
    let described = described(asked);
    let (centre, values) = match asked {
        FieldQuantity::Depth => (None, depth.to_vec()),
        // At rest it is f/H, of a mean depth H = 1.
        FieldQuantity::PotentialVorticity => (Some(water.rotation), flow.potential_vorticity(depth)),
        FieldQuantity::Vorticity => (Some(0.0), flow.vorticity()),
        FieldQuantity::Speed => (None, flow.speed()),
        FieldQuantity::VelocityX => {
            let [along_x, _] = flow.velocity();
            (Some(0.0), along_x)
        }
        FieldQuantity::VelocityY => {
            let [_, along_y] = flow.velocity();
            (Some(0.0), along_y)
        }
    };
    // Of an array the first index is that of x.
    let nodes = water.mesh.map(|nodes| nodes as usize);
    let places = (0..nodes[0]).flat_map(|k| (0..nodes[1]).map(move |l| k + l * nodes[0]));
    let field = Field {
        name: described.meaning.to_owned(),
        label: described.label(2),
        nodes,
        lengths: [model.units.lengths[0], model.units.lengths[1]],
        values: places.map(|place| values[place]).collect(),
    };
    let standard_name = standard_name(asked);
    ShownField { described, standard_name, centre, from_zero: asked == FieldQuantity::Speed, quantity: asked, field }
}

/// The points of every closed loop of tracers that is still a curve.
fn closed_loops(state: &Reported, model: &Model, water: &ShallowWater) -> Vec<Vec<[f64; 2]>> {
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
