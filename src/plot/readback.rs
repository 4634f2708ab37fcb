//! Pictures from the device to the host.

use super::error::PlotError;
use crate::engine::read_back;
use crate::gpu::{Gpu, GpuError};
use image::RgbaImage;

/// Reads the pixels of a picture.
pub(super) fn pixels(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, PlotError> {
    let failed = |error: GpuError| match error {
        GpuError::OutOfMemory { .. } => PlotError::OutOfMemory { stage: "copy of the picture" },
        error => PlotError::Readback(error.to_string()),
    };
    let (width, height) = (texture.width(), texture.height());
    let row = width * 4;
    let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    // Copied in strips, so that the staging buffer stays small however large the picture.
    let strip = ((64 << 20) / padded_row).clamp(1, height);
    let mut pixels = Vec::with_capacity(row as usize * height as usize);
    for top in (0..height).step_by(strip as usize) {
        let rows = strip.min(height - top);
        let bytes = read_back(gpu, u64::from(padded_row) * u64::from(rows), |encoder, buffer| {
            let mut source = texture.as_image_copy();
            source.origin.y = top;
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_row), rows_per_image: None };
            let size = wgpu::Extent3d { width, height: rows, depth_or_array_layers: 1 };
            encoder.copy_texture_to_buffer(source, wgpu::TexelCopyBufferInfo { buffer, layout }, size);
        });
        for padded in bytes.map_err(failed)?.chunks(padded_row as usize) {
            pixels.extend_from_slice(&padded[..row as usize]);
        }
    }
    RgbaImage::from_raw(width, height, pixels).ok_or_else(|| PlotError::Readback("fewer bytes than pixels".to_owned()))
}
