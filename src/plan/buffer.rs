//! Buffers: an array on the device, its size and what it holds at first.

use super::Table;
use crate::shaders::Array;

/// What a buffer holds before the first step.
#[derive(Debug, Clone, PartialEq)]
pub enum Contents {
    /// Zeros.
    Zeros,
    /// These bytes.
    Bytes(Vec<u8>),
    /// A table that grows with the number of particles and is generated on upload.
    Table(Table),
}

impl Contents {
    /// The bytes; `None` for zeros.
    #[must_use]
    pub fn bytes(&self) -> Option<std::borrow::Cow<'_, [u8]>> {
        match self {
            Self::Zeros => None,
            Self::Bytes(bytes) => Some(bytes.into()),
            Self::Table(table) => Some(table.bytes().into()),
        }
    }
}

/// A buffer on the device; kernels find it by the name of its array.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffer {
    /// What it holds.
    pub array: Array,
    /// Size in bytes.
    pub bytes: u64,
    /// Initial contents.
    pub contents: Contents,
}
