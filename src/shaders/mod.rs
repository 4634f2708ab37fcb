//! The library of shaders: pages and variants below `shaders`, and the linker that makes a kernel of them.
//!
//! The path of a file says what it is. A page, `domain/topic.wgsl`, holds one topic whole, kernels beside their functions. A variant,
//! `domain/slot/variant.wgsl`, is one of several that provide the same functions. A kernel is an [`Entry`] and the variants chosen
//! for it, by enumerations made from the folders. Arrays and constants have enumerations too, [`Array`] and [`Constant`].
//!
//! ```
//! use mesoscope::shaders::{Array, Choices, Constant, Entry, linked_text, mesh, water};
//!
//! let choices = Choices::new().with(mesh::Spline::Linear).with(water::Particles::InPlace);
//! let linked = linked_text(Entry::BinWater, &choices)?;
//! assert!(linked.text.contains("fn bin_water"));
//! assert!(linked.parts.iter().any(|part| part.path == "mesh/spline/linear"));
//!
//! // Without a spline nobody knows the cell of a particle.
//! let error = linked_text(Entry::BinWater, &Choices::new()).unwrap_err();
//! assert!(error.reason.contains("mesh/spline/cubic"), "{}", error.reason);
//!
//! // Arrays are known by what the table `build/arrays.rs` says of them.
//! assert_eq!((Array::Depths.name(), Array::named("depth")), ("depths", None));
//! assert_eq!(Array::Ranks.purpose(), "place of each particle in its cell");
//! assert_eq!(Constant::CellsX.name(), "CELLS_X");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod choices;
mod linker;
mod words;

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

pub use choices::{Choice, Choices};
pub use generated::*;
pub use linker::{Declaration, File, Kind, Library, LinkedText, Part, Unlinked};

/// What `build` has made of the shaders and of the table of arrays; its comments are theirs.
#[allow(clippy::doc_markdown, clippy::too_long_first_doc_paragraph)]
mod generated {
    use super::Choice;

    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

/// All pages and variants.
///
/// # Errors
/// [`Unlinked`] where a file holds something that is no declaration.
pub fn library() -> Result<&'static Library, Unlinked> {
    static LIBRARY: OnceLock<Result<Library, Unlinked>> = OnceLock::new();
    LIBRARY
        .get_or_init(|| Library::new(&generated::FILES).map(|read| read.with_sources(&generated::SOURCES)))
        .as_ref()
        .map_err(Clone::clone)
}

/// The text of a kernel. An array lies in a buffer unless a choice says otherwise.
///
/// # Errors
/// [`Unlinked`] if a name cannot be resolved with these choices.
pub fn linked_text(entry: Entry, choices: &Choices) -> Result<LinkedText, Unlinked> {
    library()?.link(entry.name(), &choices.with_arrays_in_buffers().paths().collect::<Vec<_>>())
}

/// The number of buffers that the text of a kernel declares, if all arrays of which its choices say nothing are in
/// buffers; none of a kernel that does not link. A pipeline binds fewer of them where branches are not taken.
///
/// ```
/// use mesoscope::shaders::{Choices, Entry, declared_buffers, mesh, water};
///
/// let choices = Choices::new().with(mesh::Spline::Linear).with(water::Particles::InPlace);
/// assert!(declared_buffers(Entry::BinWater, &choices) > 1);
/// ```
#[must_use]
pub fn declared_buffers(entry: Entry, choices: &Choices) -> usize {
    static KNOWN: Mutex<BTreeMap<(Entry, Choices), usize>> = Mutex::new(BTreeMap::new());
    let kernel = (entry, choices.clone());
    if let Some(count) = KNOWN.lock().unwrap_or_else(PoisonError::into_inner).get(&kernel) {
        return *count;
    }
    let count = linked_text(entry, choices).map_or(0, |linked| linked.text.matches("var<storage").count());
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner).insert(kernel, count);
    count
}
