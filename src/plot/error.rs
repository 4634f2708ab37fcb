//! What can go wrong while a picture is drawn.

use thiserror::Error;

/// A picture could not be drawn.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The picture is larger than a texture of this adapter may be, or has no pixels.
    #[error("a picture of {width} x {height} pixels cannot be drawn: each side must lie between 1 and {limit}")]
    Size {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
        /// Largest side of a texture on this adapter.
        limit: u32,
    },
    /// Lists that describe the same things differ in length, or a number that must be positive is not.
    #[error("the picture is ill described: {0}")]
    Input(String),
    /// The letters of the picture do not fit into one texture.
    #[error("the type is too large for this picture: reduce `scale` or shorten the texts")]
    TypeTooLarge,
    /// An embedded font cannot be read.
    #[error("the embedded font cannot be read: {0}")]
    Font(String),
    /// The adapter has too little memory for the picture.
    #[error("the adapter ran out of memory while drawing the {stage}: make the picture smaller")]
    OutOfMemory {
        /// What was being drawn.
        stage: &'static str,
    },
    /// The driver or wgpu refused the work.
    #[error("the adapter refused the {stage}: {message}")]
    Device {
        /// What was being drawn.
        stage: &'static str,
        /// What it said.
        message: String,
    },
    /// The finished picture could not be read back.
    #[error("the picture could not be read back from the adapter: {0}")]
    Readback(String),
}
