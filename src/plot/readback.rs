//! Pictures from the device to the host.

use super::error::PlotError;
use super::pipelines::Painter;
use image::RgbaImage;
use std::sync::mpsc;
use std::time::Duration;

const PATIENCE: Duration = Duration::from_mins(2);

/// Reads the pixels of a picture.
pub(super) fn read_back(painter: &Painter, texture: &wgpu::Texture) -> Result<RgbaImage, PlotError> {
    let Painter { device, queue } = painter;
    let failed = |error: &dyn std::fmt::Display| PlotError::Readback(error.to_string());
    let (width, height) = (texture.width(), texture.height());
    let row = width * 4;
    let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    // Copied in strips, so that the staging buffer stays small however large the picture.
    let strip = ((64 << 20) / padded_row).clamp(1, height);
    let mut pixels = Vec::with_capacity(row as usize * height as usize);
    let buffer = painter.checked("copy of the picture", || {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("plot: readback"),
            size: u64::from(padded_row) * u64::from(strip),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })?;
    for top in (0..height).step_by(strip as usize) {
        let rows = strip.min(height - top);
        let bytes = u64::from(padded_row) * u64::from(rows);
        let (sender, receiver) = mpsc::channel();
        let submission = painter.checked("copy of the picture", || {
            let mut encoder =
                device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("plot: shapes") });
            let mut source = texture.as_image_copy();
            source.origin.y = top;
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_row), rows_per_image: None };
            encoder.copy_texture_to_buffer(
                source,
                wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
                wgpu::Extent3d { width, height: rows, depth_or_array_layers: 1 },
            );
            encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, 0..bytes, move |result| {
                // The receiver is gone only if waiting has failed already.
                let _ = sender.send(result);
            });
            queue.submit([encoder.finish()])
        })?;
        device
            .poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) })
            .map_err(|error| failed(&error))?;
        // The mapping may be on its way in another thread that polls the same device.
        receiver.recv_timeout(PATIENCE).map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        let mapped = buffer.get_mapped_range(0..bytes).map_err(|error| failed(&error))?;
        for padded in mapped.chunks(padded_row as usize) {
            pixels.extend_from_slice(&padded[..row as usize]);
        }
        drop(mapped);
        buffer.unmap();
    }
    RgbaImage::from_raw(width, height, pixels).ok_or_else(|| PlotError::Readback("fewer bytes than pixels".to_owned()))
}
