//! What a run leaves on disk: tables, arrays, trajectories, checkpoints, pictures and a summary.
//!
//! Files written once ([`RunDirectory::write`]) appear under their final name complete or not at all. Files that grow
//! ([`EnergiesFile`], [`TrajectoryWriter`]) hold whole records after every flush, and a resumed run cuts them back to
//! the step it resumes from. A directory has a lock ([`DirectoryLock`]), so that one process at a time writes there.

pub mod checkpoint;
mod directory;
mod energies;
mod error;
mod extent;
pub mod files;
mod id;
mod lock;
mod netcdf;
mod npy;
pub(crate) mod own_file;
mod picture;
mod recognition;
mod records;
pub mod summary;
mod table;
mod temporary;
mod trajectory;
mod watch;

pub use checkpoint::Checkpoint;
pub use directory::RunDirectory;
pub use energies::EnergiesFile;
pub use error::OutputError;
pub use extent::Extent;
pub(crate) use extent::Found;
pub use id::Id;
pub(crate) use id::of_one_run;
pub use lock::DirectoryLock;
pub use netcdf::{NetcdfFile, NetcdfValue, NetcdfVariable};
pub use npy::{read_npy, write_npy, write_npy_to};
pub use summary::Summary;
pub(crate) use table::quoted;
pub use table::{read_table, write_table};
pub use temporary::write_atomically;
pub use trajectory::TrajectoryWriter;
pub(crate) use trajectory::bytes_per_particle;
pub(crate) use watch::exists;
