//! What a run leaves on disk: tables, arrays, trajectories, checkpoints, pictures and a summary.
//!
//! Files written once ([`RunDirectory::write`]) appear under their final name complete or not at all. Files that grow
//! ([`EnergiesFile`], [`TrajectoryWriter`]) hold whole records after every flush, and a resumed run cuts them back to
//! the step it resumes from.

pub mod checkpoint;
mod directory;
mod energies;
mod error;
pub mod files;
mod npy;
mod records;
pub mod summary;
mod table;
mod trajectory;

pub use checkpoint::Checkpoint;
pub use directory::{RunDirectory, write_atomically};
pub use energies::EnergiesFile;
pub use error::OutputError;
pub use npy::{write_npy, write_npy_to};
pub use summary::Summary;
pub use table::{Table, read_table, write_table};
pub(crate) use table::{push_number, quoted};
pub use trajectory::TrajectoryWriter;
