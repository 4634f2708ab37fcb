//! How fast the adapter copies memory: the least time in which the state of a run can be read and written.

use std::time::Instant;

use mesoscope::gpu::Gpu;
use wgpu::{BufferDescriptor, BufferUsages, CommandEncoderDescriptor, PollType};

use crate::Failure;

/// Bytes of a copy, more than caches hold, where buffers may be that large.
const BYTES: u64 = 1 << 28;
/// Time of a measurement.
const SECONDS: f64 = 0.2;

/// Bytes a second, read and written, of each of some copies from buffer to buffer.
pub fn copies(gpu: &Gpu, rounds: usize) -> Result<Vec<f64>, Failure> {
    let device = gpu.device();
    let size = BYTES.min(device.limits().max_buffer_size);
    let buffers = ["from", "to"].map(|label| {
        let usage = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
    });
    let time = |count: u64| -> Result<f64, Failure> {
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        for _ in 0..count {
            encoder.copy_buffer_to_buffer(&buffers[0], 0, &buffers[1], 0, size);
        }
        let commands = encoder.finish();
        let begun = Instant::now();
        let submission = gpu.queue().submit([commands]);
        device.poll(PollType::Wait { submission_index: Some(submission), timeout: None })?;
        Ok(begun.elapsed().as_secs_f64())
    };
    // The first copy clears the memory.
    time(1)?;
    let count = ((SECONDS / time(1)?) as u64).clamp(1, 512);
    let speeds = (0..rounds).map(|_| Ok((2 * size * count) as f64 / time(count)?)).collect();
    gpu.health()?;
    speeds
}
