//! Voronoi DPD: particles that are the cells of a tessellation.

pub(crate) mod model;
pub mod reference;
pub(crate) mod scene;
pub(crate) mod start;
