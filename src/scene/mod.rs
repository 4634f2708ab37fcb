//! What the user wrote, typed and checked.
//!
//! [`load`] goes from text to JSON, applies overrides, compares the JSON with the [`schema`] that the types define,
//! reads it into a [`Scene`] and checks what a schema cannot say. Mistakes are reported all at once.

mod analyses;
mod bath;
mod builtin;
mod colours;
mod document;
mod error;
mod groups;
mod integrator;
mod interaction;
mod load;
mod nearest;
mod output;
mod overrides;
mod path;
mod pictures;
mod problems;
mod semantics;
mod shape;
mod shorten;
mod text;

pub use crate::noise::Generator;
pub use analyses::*;
pub use bath::{Bath, BathScheme};
pub use builtin::{Builtin, builtin};
pub use document::{Distribution, Noise, Scene, Space, Time};
pub use error::{Problem, SceneError, Warning};
pub use groups::{Chain, ParticleGroup, Placement, Velocities};
pub use integrator::Integrator;
pub use interaction::*;
pub(crate) use load::checked;
pub use load::{load, load_for, parse, parse_for, read, schema, unknown_builtin};
pub use output::{Checkpoint, Energies, Output, Trajectory, TrajectoryFormat};
pub(crate) use overrides::value;
pub use pictures::{PlotStyle, Snapshot, SnapshotColor, Theme};
pub(crate) use problems::{Problems, brief};
pub use semantics::BYTES_PER_PARTICLE;
pub(crate) use semantics::SpeciesNames;
