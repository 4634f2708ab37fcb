//! Several ranks that share a run: each advances its part of the box on an adapter of its own, and the results are those of one rank, to
//! the last bit.
//!
//! The first rank decides what is done and writes the files; the others do what it tells them ([`serve`]). Together they look like one
//! engine ([`Team`]). At the end of every step each rank gives others the particles that these have to know ([`crate::engine::Swap`]),
//! and in the middle of it what it adds to the nodes of a mesh; sums of integers are added over ranks, in whatever order. How messages
//! pass is behind two small traits, of which ranks that are threads of one process ([`threads`]) are one case.

mod member;
mod message;
#[cfg(feature = "mpi")]
pub mod mpi;
mod team;
pub mod threads;

pub use member::{decline, serve};
pub(crate) use team::remedy;
pub use team::{Team, computes_alike, sharing, sharing_anywhere};

use crate::engine::Swap;
use std::time::Duration;

/// A rank that has not answered by then counts as lost.
pub const PATIENCE: Duration = Duration::from_mins(10);

/// How the first rank tells the others what to do, and they answer. None of these waits longer than [`PATIENCE`] for a rank that may be
/// lost without notice, as a process may.
pub trait Channel: Send {
    /// Number of ranks.
    fn count(&self) -> u32;

    /// Tells all other ranks something; of the first rank only.
    ///
    /// # Errors
    /// Which rank is lost, in words.
    fn tell(&mut self, message: &[u8]) -> Result<(), String>;

    /// Lets all other ranks know that the first is at work; of the first rank, wherever it may not tell them anything for long.
    /// Whatever is wrong shows when it does.
    fn keep_alive(&self);

    /// What the first rank tells; of all others. They wait for as long as it keeps alive; threads for as long as it is there, for a
    /// process that stops stops all its threads.
    ///
    /// # Errors
    /// That the first rank is lost, in words.
    fn listen(&mut self) -> Result<Vec<u8>, String>;

    /// Answers the first rank; of all others.
    ///
    /// # Errors
    /// That the first rank is lost, in words.
    fn answer(&mut self, message: &[u8]) -> Result<(), String>;

    /// The answers of all other ranks in their order; of the first rank only.
    ///
    /// # Errors
    /// Which rank is lost, in words.
    fn collect(&mut self) -> Result<Vec<Vec<u8>>, String>;
}

/// Ranks that are processes, of which this is one.
pub trait Processes {
    /// Number of ranks.
    fn count(&self) -> u32;

    /// To the first rank; of the first rank to all others.
    fn channel(&self) -> Box<dyn Channel + '_>;

    /// To the peers.
    fn peers(&self) -> Box<dyn Swap + '_>;
}
