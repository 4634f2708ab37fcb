//! The rate at which an adapter moves bytes.

use std::time::Instant;

use mesoscope::gpu::Gpu;

use crate::Failure;

/// Bytes of a buffer: more than caches hold.
const BYTES: u64 = 64 << 20;

/// Gigabytes a second that copies from buffer to buffer read and write, round by round.
pub fn of_copies(gpu: &Gpu, rounds: usize) -> Result<Vec<f64>, Failure> {
    let (device, queue) = (gpu.device(), gpu.queue());
    let buffer = |label| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: BYTES,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let (from, to) = (buffer("from"), buffer("to"));
    let seconds = |copies: u32| -> Result<f64, Failure> {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for _ in 0..copies {
            encoder.copy_buffer_to_buffer(&from, 0, &to, 0, BYTES);
        }
        let begun = Instant::now();
        queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(begun.elapsed().as_secs_f64())
    };
    // The first copies fill buffers that are cleared then.
    let warm = seconds(4)?.max(1e-6) / 4.0;
    let copies = ((0.1 / warm) as u32).clamp(2, 1000);
    (0..rounds.max(1)).map(|_| Ok(2e-9 * (u64::from(copies) * BYTES) as f64 / seconds(copies)?)).collect()
}
