//! The float64 reference against what is exact, and the device against the reference, step by step.

mod baths;
mod body_forces;
mod bonds;
mod electrostatics;
mod many_body;
mod pair_coefficients;
mod particles;
mod relaxation;
mod shear;
mod single_steps;
mod smoothing;
mod stress;
mod tessellation;
mod voronoi;
mod walls;
