//! The graphics adapter: choosing one, opening it with the limits a plan needs, and linking shaders.

mod access;
mod adapter;
mod compiled;
mod device;
mod environment;
mod error;
mod kept;
mod loaded;
mod portions;
mod pruning;
mod replicas;
mod shader;
mod unseen;

pub use adapter::{AdapterChoice, AdapterDescription, AdapterKind, adapters_by_turns, list_adapters};
pub(crate) use compiled::{CompiledKernel, Places};
pub use compiled::{ConstantsIn, Rewriting};
pub use device::{Gpu, Requirements};
pub(crate) use device::{STORAGE_BUFFERS, compute_pass};
pub use environment::driver_environment;
pub use error::GpuError;
pub(crate) use loaded::{BINDING as LOADED_CONSTANTS, bytes as constants_in_bytes};
pub use portions::{Portions, Undivided};
pub(crate) use replicas::{NUMBERS as REPLICA_NUMBERS, Replicas, spacing};
pub(crate) use shader::link_once;
pub use shader::{Binding, LinkedShader, Switched, link, link_loading, storage_buffers, validate};
pub use unseen::unseen_card;
