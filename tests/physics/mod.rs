//! What runs give, against closed forms, conservation laws and published or independently measured values: the same for the
//! float64 reference and for the device.

mod analyses;
mod bonds;
mod coloured_noise;
mod couplings;
mod edpd;
mod electrostatics;
mod fluid;
mod harmonic_chain;
mod profiles;
mod relaxation;
mod shallow_water;
mod voronoi;
