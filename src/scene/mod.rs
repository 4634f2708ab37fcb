//! What the user wrote, typed and checked.
//!
//! [`load`] goes from text to JSON, applies overrides, compares the JSON with the [`schema`] that the types define,
//! reads it into a [`Scene`] and checks what a schema cannot say, with the family of the scene. Mistakes are reported all at
//! once.

mod builtin;
mod changes;
mod colours;
mod load;
mod overrides;
mod path;
mod semantics;
mod shape;
mod shorten;
mod stages;
mod start;
mod state_files;
mod text;

pub use crate::document::*;
pub use crate::families::Checked;
pub(crate) use builtin::CALIBRATIONS;
pub use builtin::{Builtin, builtin};
pub(crate) use changes::{changeable, differ_in_numbers, displacement_at, overridden};
pub use load::{WrittenScene, load, parse, schema, unknown_builtin};
pub(crate) use overrides::value;
pub use semantics::BYTES_PER_PARTICLE;
pub(crate) use stages::part_at;
pub use start::{Fits, particles_of};
pub(crate) use state_files::StateFiles;
