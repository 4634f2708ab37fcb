//! Particles with forces between them: dissipative particle dynamics, couplings with baths, bonds and chains.

pub(crate) mod chains;
pub(crate) mod model;
pub mod reference;
pub(crate) mod scene;
pub(crate) mod stability;
