//! Tables that grow with the number of particles: described by the plan, made when they are uploaded.

use super::compared::Compared;
use std::fmt::Debug;
use std::ops::Deref;
use std::sync::Arc;

/// What a table holds, of whatever length.
pub trait Words: Compared + Debug + Send + Sync {
    /// Number of words.
    fn count(&self) -> u64;

    /// The words.
    fn words(&self) -> Vec<u32>;
}

/// A table of words.
///
/// ```
/// use mesoscope::plan::{Contents, Hardware, Options};
/// use mesoscope::run::plan;
///
/// let scene = mesoscope::scene::load("polymer-melt", &[])?;
/// let plan = plan(&scene, Hardware::default(), Options::default());
/// let tables: Vec<_> = plan.buffers.iter().filter(|buffer| matches!(buffer.contents, Contents::Table(_))).collect();
/// for buffer in &tables {
///     let Contents::Table(table) = &buffer.contents else { unreachable!() };
///     assert_eq!(table.bytes().len() as u64, table.length());
///     assert!(table.length() <= buffer.bytes);
/// }
/// assert!(tables.len() >= 2);
/// # Ok::<(), mesoscope::scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Table(Arc<dyn Words>);

impl Table {
    /// A table of these words.
    pub(crate) fn new(words: impl Words) -> Self {
        Self(Arc::new(words))
    }

    /// Its length in bytes.
    #[must_use]
    pub fn length(&self) -> u64 {
        self.count().saturating_mul(4)
    }

    /// What it holds.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        bytemuck::cast_slice(&self.words()).to_vec()
    }
}

impl Deref for Table {
    type Target = dyn Words;

    fn deref(&self) -> &Self::Target {
        self.0.as_ref()
    }
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(other.0.as_ref())
    }
}
