//! Arrays that lie in textures.

use super::Plan;

/// An array of texels on the device, in rows of [`Texture::ROW`]; kernels find it by its name, as a buffer. It begins as zeros.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Texture {
    /// The name, which is also that of the shader variable.
    pub name: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Words of a texel: one, two or four.
    pub words: u32,
    /// Texels in a row, and rows.
    pub size: [u32; 2],
}

impl Texture {
    /// Texels in a row: half of what every adapter has, so that a quotient is a shift.
    pub const ROW: u64 = 4096;

    /// Rows that every adapter has.
    const ROWS: u64 = 8192;

    /// Whether a texture can have so many texels.
    #[must_use]
    pub fn holds(texels: u64) -> bool {
        texels <= Self::ROW * Self::ROWS
    }

    /// Bytes on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.row_bytes() * u64::from(self.size[1])
    }

    /// Bytes of a row: a multiple of 256, as copies ask for.
    #[must_use]
    pub fn row_bytes(&self) -> u64 {
        4 * u64::from(self.words) * u64::from(self.size[0])
    }
}

impl Plan {
    /// Adds a texture.
    pub(super) fn add_texture(&mut self, name: &'static str, purpose: &'static str, words: u32, texels: u64) {
        let width = texels.clamp(1, Texture::ROW).next_multiple_of(64);
        let size = [width as u32, texels.div_ceil(Texture::ROW).max(1) as u32];
        self.textures.push(Texture { name, purpose, words, size });
    }
}
