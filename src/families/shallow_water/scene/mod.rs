//! What a scene says about shallow water, and what such a scene has to fulfil.

pub(crate) mod checks;
mod fields;
mod water;

pub use fields::{FieldQuantity, FieldRanges, Fields};
pub use water::{
    BathRate, LaplacianSymbol, MeshBath, ShallowWaterInteraction, Smoothing, SmoothingSolver, SurfaceFeature,
};
