//! The ends of every range: right, or refused with the reason, and never silent.

mod cold_scenes;
mod couplings;
mod edge_of_error;
mod every_family;
mod many_body;
mod particles;
mod shallow_water;
mod shear;
mod voronoi;
mod walls;
