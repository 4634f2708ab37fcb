//! What a scene says about shallow water.

mod fields;
mod water;

pub use fields::{FieldFormat, FieldQuantity, FieldRanges, Fields};
pub use water::{
    BathRate, LaplacianSymbol, MeshBath, ShallowWaterInteraction, Smoothing, SmoothingSolver, SurfaceFeature,
};
