//! The families of models: particles, shallow water, Voronoi cells.
//!
//! A [`Model`] is the physics that a scene asks for in numbers: species, coefficients, units. What belongs to one family is in
//! its folder: what a scene says about it and has to fulfil, its numbers, its start, and its float64 [`mod@reference`].

mod bath;
mod checks;
mod instability;
mod model;
mod observables;
pub mod particles;
pub mod reference;
mod registry;
pub mod shallow_water;
mod start;
mod units;
pub mod voronoi;
mod warnings;

pub use bath::BathStep;
pub(crate) use checks::check;
pub use checks::check_start;
pub use instability::Instability;
pub use model::{Model, Species};
pub use observables::{CellObservables, Observables};
pub use particles::Particles;
pub(crate) use particles::model::{Alike, FREQUENCY_LIMIT, FRICTION_LIMIT};
pub use particles::model::{
    Angle, Angles, Bond, BondKind, Bonds, ChainGroup, ChainTrios, ColouredNoise, HarmonicChain, Jump, Likeness,
    PairForce, PositionBath, SpringChain, Strand,
};
pub use registry::Family;
pub(crate) use shallow_water::model::{LARGEST_DEPTH, LARGEST_MASS, chebyshev_iterations};
pub use shallow_water::model::{ShallowWater, Tracers};
pub use start::initial_state;
pub use voronoi::model::{NETWORK_VISCOSITY, Voronoi};
pub use warnings::warnings;

use crate::scene::Scene;

/// What the program asks of the physics of a family.
pub trait Physics {
    /// Value of one unit of integer momentum; a power of two.
    fn momentum_unit(&self, scene: &Scene, species: &[Species]) -> f64;

    /// Whether any force derives from a potential.
    fn has_potential(&self) -> bool;

    /// Whether any bath has a memory.
    fn has_memory(&self) -> bool;

    /// Whether nothing but a random force couples particles that can move to what is fixed in space.
    fn is_free(&self) -> bool;
}
