//! Rotating shallow water by the Hamiltonian particle-mesh method.

pub(crate) mod model;
pub mod reference;
pub(crate) mod scene;
pub mod surface;
