//! Results read back from the device: copied at the end of a batch, mapped when it has run.

use std::collections::HashMap;
use std::sync::mpsc;
use std::time::Duration;

use super::stored::Stored;
use super::{Control, Sample};
use crate::gpu::{Gpu, GpuError};
use crate::plan::Plan;
use crate::shaders::Array;

/// A device that has not finished a batch by then counts as lost.
const PATIENCE: Duration = Duration::from_mins(10);

/// The control block and the samples of a batch on their way to the host.
pub(super) struct Readback {
    reading: Reading,
    /// Sampler, rows and first byte of each stretch of samples in the staging buffer.
    stretches: Vec<(usize, u64, u64)>,
}

fn row_bytes(plan: &Plan, sampler: usize) -> u64 {
    8 * (1 + plan.samplers[sampler].quantities as u64)
}

impl Readback {
    /// Runs a batch and begins to read the control block and the samples taken in it, whose count within the batch is reset.
    pub(super) fn begin(
        gpu: &Gpu,
        encoder: wgpu::CommandEncoder,
        plan: &Plan,
        buffers: &HashMap<Array, Stored>,
        rows: &[u64],
    ) -> Result<Self, GpuError> {
        let control_bytes = size_of::<Control>() as u64;
        let mut bytes = control_bytes;
        let mut stretches = Vec::new();
        for (sampler, &rows) in rows.iter().enumerate().filter(|(_, rows)| **rows > 0) {
            stretches.push((sampler, rows, bytes));
            bytes += rows * row_bytes(plan, sampler);
        }
        let reading = Reading::begin(gpu, encoder, bytes, |encoder, staging| {
            buffers[&Array::Control].copy_to(encoder, 0..control_bytes, staging, 0);
            for &(sampler, rows, offset) in &stretches {
                let samples = &buffers[&plan.samplers[sampler].samples];
                samples.copy_to(encoder, 8..8 + rows * row_bytes(plan, sampler), staging, offset);
                samples.clear(encoder, 0..4);
            }
        })?;
        Ok(Self { reading, stretches })
    }

    pub(super) fn collect(self, gpu: &Gpu, plan: &Plan) -> Result<(Control, Vec<Sample>), GpuError> {
        let bytes = self.reading.finish(gpu)?;
        let control_bytes = size_of::<Control>();
        let control: Control = bytemuck::pod_read_unaligned(&bytes[..control_bytes]);
        let mut samples = Vec::new();
        for (sampler, rows, offset) in self.stretches {
            let width = row_bytes(plan, sampler) as usize;
            for row in bytes[offset as usize..].chunks_exact(width).take(rows as usize) {
                let words: Vec<i64> = row.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
                let step = (words[0] as u64).wrapping_sub(plan.steps_before);
                samples.push(Sample { sampler, step, sums: words[1..].to_vec() });
            }
        }
        // By step and not by sampler, so that the order does not depend on how steps were batched.
        samples.sort_by_key(|sample| (sample.step, sample.sampler));
        Ok((control, samples))
    }
}

/// Waits for the device and reads as many bytes as `copy` copies into a buffer.
pub(crate) fn read(
    gpu: &Gpu,
    size: u64,
    copy: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::Buffer),
) -> Result<Vec<u8>, GpuError> {
    Reading::begin(gpu, gpu.encoder("readback"), size, copy)?.finish(gpu)
}

/// Bytes on their way to the host.
pub(super) struct Reading {
    staging: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    arrival: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Reading {
    /// Submits what is recorded, and after it the copy of as many bytes as `copy` copies into a buffer.
    pub(super) fn begin(
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
        size: u64,
        copy: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::Buffer),
    ) -> Result<Self, GpuError> {
        let staging = gpu.scoped("creating a readback buffer", size, || {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })?;
        copy(&mut encoder, &staging);
        let (sender, arrival) = mpsc::channel();
        encoder.map_buffer_on_submit(&staging, wgpu::MapMode::Read, .., move |result| {
            let _ = sender.send(result);
        });
        let submission = gpu.queue.submit([encoder.finish()]);
        Ok(Self { staging, submission, arrival })
    }

    /// Waits for them, and for nothing that was submitted later.
    pub(super) fn finish(self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        let lost = |reason: &dyn std::fmt::Display| GpuError::Lost {
            adapter: gpu.description().name.clone(),
            reason: reason.to_string(),
        };
        let finished = wgpu::PollType::Wait { submission_index: Some(self.submission), timeout: Some(PATIENCE) };
        gpu.device.poll(finished).map_err(|error| lost(&error))?;
        gpu.health()?;
        let arrived = self.arrival.recv_timeout(PATIENCE).map_err(|error| lost(&error))?;
        arrived.map_err(|error| lost(&error))?;
        let view = self.staging.get_mapped_range(..).map_err(|error| lost(&error))?;
        Ok(view.to_vec())
    }
}
