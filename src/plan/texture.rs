//! Arrays in textures.

use super::{Contents, Plan};
use crate::shaders::Array;

/// An array of texels on the device, in rows of [`Texture::ROW`]; kernels find it by the name of its array, as a
/// buffer.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// What it holds.
    pub array: Array,
    /// Words of a texel: one, two or four.
    pub words: u32,
    /// Texels in a row, and rows.
    pub size: [u32; 2],
    /// Initial contents.
    pub contents: Contents,
}

impl Texture {
    /// Texels in a row, as `shaders/core/texels.wgsl` has it: short enough that little is wasted in the last row.
    pub const ROW: u64 = 4096;

    /// Rows that every adapter has.
    pub(crate) const ROWS: u64 = 8192;

    /// Bytes of the largest buffer that every adapter allows: textures are read back through one of that size.
    const BYTES: u64 = 1 << 28;

    /// Whether every adapter can hold a texture of this many texels of this many words.
    ///
    /// ```
    /// use mesoscope::plan::Texture;
    ///
    /// assert!(Texture::holds(1 << 24, 4) && !Texture::holds((1 << 24) + 1, 4));
    /// assert!(Texture::holds(1 << 25, 1) && !Texture::holds((1 << 25) + 1, 1));
    /// ```
    #[must_use]
    pub fn holds(texels: u64, words: u32) -> bool {
        let rows = texels.div_ceil(Self::ROW);
        rows <= Self::ROWS && 4 * u64::from(words) * Self::ROW * rows <= Self::BYTES
    }

    /// Bytes on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.row_bytes() * u64::from(self.size[1])
    }

    /// Bytes of a row: a multiple of 256, as copies require.
    #[must_use]
    pub fn row_bytes(&self) -> u64 {
        4 * u64::from(self.words) * u64::from(self.size[0])
    }
}

impl Plan {
    /// Adds a texture that can hold the texels.
    pub(crate) fn add_texture(&mut self, array: Array, texels: u64) {
        self.add_texture_with(array, texels, Contents::Zeros);
    }

    /// The same with contents.
    pub(crate) fn add_texture_with(&mut self, array: Array, texels: u64, contents: Contents) {
        let width = texels.clamp(1, Texture::ROW).next_multiple_of(64);
        let size = [width as u32, texels.div_ceil(Texture::ROW).max(1) as u32];
        self.textures.push(Texture { array, words: array.texel_words(), size, contents });
    }
}
