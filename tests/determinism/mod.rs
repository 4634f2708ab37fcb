//! The same bytes, and exact laws to the last bit, whatever changes that is not physics.

mod any_compiler;
mod body_forces;
mod continuations;
mod couplings;
mod many_body;
mod molecules;
mod pair_coefficients;
mod particles;
mod paths;
mod portions;
pub mod ranks;
mod ranks_bonds;
mod ranks_of_water;
mod relaxation;
mod replicas;
mod resumed_analyses;
mod shallow_water;
mod shear;
mod simulations;
mod simulations_on_ranks;
mod stages;
mod timing;
mod voronoi;
mod walls;
