//! Scenes, command lines and files with mistakes: each is refused with its place and what is accepted there.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod body_forces;
mod cost;
mod couplings;
mod damage;
mod directories;
mod electrostatics;
mod fuzzing;
mod many_body;
mod molecules;
mod ranks;
mod scenes;
mod shallow_water;
mod shear;
mod states;
mod voronoi;
mod walls;
