//! Studies: many runs of one scene that differ in a few of its values, in one directory.
//!
//! What [sweeps](crate::sweep), [tradeoffs](crate::tradeoff) and [maps of stability](crate::stability) have in common: the scenes that follow
//! from keys and their values ([`Sweep`]), and a study under way ([`StudyRun`]): its directory with its lock, its summary ([`Record`]),
//! runs at once, what interrupts it and goes on with it, what an observer learns of it ([`StudyEvent`]), and its tables, page and pictures,
//! which are written, drawn and [drawn again](redraw) here. What a kind of study makes of its runs is its own.

mod concurrency;
mod directory;
mod error;
mod expansion;
mod groups;
mod kind;
mod lists;
mod members;
mod naming;
mod parameter;
mod record;
mod run;
mod seeds;
mod shard;
mod shard_places;
pub(crate) mod table;
mod variation;
mod written_scene;

pub(crate) use concurrency::at_once;
pub use concurrency::default_jobs;
pub use error::{Mistake, StudyError};
pub(crate) use expansion::{LENGTHS, refusal_of_stages};
pub use expansion::{Sweep, Variant};
pub use groups::default_replicas;
pub use kind::Kind;
pub(crate) use kind::{STABILITY, SWEEP, TRADEOFF};
pub(crate) use lists::{by_key, each_once};
pub(crate) use members::{Member, finished};
pub(crate) use naming::{ShortKeys, readable};
pub use parameter::parameter_label;
pub(crate) use parameter::parameter_name;
pub(crate) use record::{ASKS_ELSE, check_version, load};
pub use record::{Charts, Record};
pub use run::{LONG, Observer, StudyEvent, StudyOutcome, StudyRun, redraw};
pub(crate) use run::{in_hours, largest};
pub use seeds::MOST_SEEDS;
pub(crate) use seeds::{SEED, check_seeds, following, further_seed};
pub use shard::Shard;
pub(crate) use shard_places::{RECORD as SHARD_RECORD, claim as claim_shard, claim_study, name_in_study};
pub use variation::{Setting, Variation};
pub(crate) use variation::{numbers, settings};
pub(crate) use written_scene::{style, written_scene};
