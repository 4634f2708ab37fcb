//! Long runs and other programs: `make validate`.

mod channels;
mod electrostatics;
mod errors;
mod fields;
mod many_body;
mod micelles;
mod phases;
mod published;
mod readers;
mod relaxation;
mod shear;
mod stages;
mod states;
mod structure;
