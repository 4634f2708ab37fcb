//! What a scene says: the types whose names and comments are the schema of its JSON, and what there is to say of mistakes.
//!
//! Families check such scenes and make models of them; [`crate::scene`] reads one from a file, with all of that.

mod bath;
mod change;
mod defaults;
mod error;
mod file_start;
mod files;
mod groups;
mod integrator;
mod interaction;
mod links;
mod molecules;
mod nearest;
mod output;
mod particles;
mod pictures;
mod problems;
mod quantities;
mod scene;
mod shallow_water;
mod shear;
mod species_names;
mod stage;
mod state;
mod system;
mod voronoi;
mod walls;

pub use crate::noise::Generator;
pub use bath::{Bath, BathScheme};
pub use change::{Change, Rounding};
pub(crate) use error::did_you_mean;
pub use error::{Problem, SceneError, Warning};
pub use file_start::{EarlierRun, FileLinks, FilePlaces, FileStart, KeptStart, MeshFields, Origin, Surroundings};
pub use files::{Checkpoint, Energies, Trajectory, TrajectoryFormat};
pub(crate) use groups::{CHARGE_PARTS, NumberedGroup};
pub use groups::{Chain, FileType, ParticleGroup, Placement, Velocities, WallSide};
pub use integrator::{CellIntegrator, Integrator, PairRelaxation, WaterIntegrator};
pub use interaction::Interaction;
pub(crate) use links::{LinkSource, Links};
pub use molecules::Molecule;
pub(crate) use nearest::nearest;
pub use output::*;
pub use particles::*;
pub use pictures::{
    Headings, PlotStyle, Snapshot, SnapshotColor, SnapshotSlice, SnapshotView, Theme, UnitNames, VectorFormat,
};
pub(crate) use problems::{Problems, brief};
pub use quantities::*;
pub use scene::{Announced, Distribution, Noise, Scene, Space, Time};
pub use shallow_water::*;
pub use shear::Shear;
pub(crate) use species_names::{NumberedSpecies, SpeciesNames};
pub use stage::Stage;
pub(crate) use state::number_of_copies;
pub use state::{OutsidePositions, StateFile, StateVelocities};
pub use system::{System, SystemKind};
pub use voronoi::*;
pub use walls::{Reflection, WallPair, Walls};
