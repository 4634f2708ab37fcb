//! What runs give, against closed forms, conservation laws and published or independently measured values: the same for the
//! float64 reference and for the device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod analyses;
mod bonds;
mod coloured_noise;
mod couplings;
mod edpd;
mod fluid;
mod harmonic_chain;
mod profiles;
mod relaxation;
mod shallow_water;
mod voronoi;
