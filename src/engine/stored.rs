//! Arrays on the device, in as many buffers as kernels have bindings for them.

use std::ops::Range;

use crate::gpu::{Gpu, GpuError, Portions};
use crate::plan;
use crate::shaders::Array;

/// Bytes that wait on the host for the device at once.
const WAITING: usize = 1 << 28;

/// An array of a plan on the device. Offsets are those in the whole array, whatever its portions.
#[derive(Clone)]
pub(super) struct Stored {
    portions: Vec<wgpu::Buffer>,
    /// Bytes of each portion but the last.
    each: u64,
    /// The first byte, where it is a part of a larger array.
    begin: u64,
    bytes: u64,
}

impl Stored {
    pub(super) fn new(gpu: &Gpu, planned: &plan::Buffer, portions: Option<Portions>) -> Result<Self, GpuError> {
        let &plan::Buffer { array, bytes, ref contents } = planned;
        let Portions { count, bytes: each } = portions.unwrap_or(Portions { count: 1, bytes });
        let indirect = if array == Array::Demands { wgpu::BufferUsages::INDIRECT } else { wgpu::BufferUsages::empty() };
        let made = gpu.scoped(&format!("creating buffer `{}`", array.name()), bytes, || {
            let portion = |number: u32| {
                gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(array.name()),
                    size: each.min(bytes - each * u64::from(number)),
                    usage: wgpu::BufferUsages::STORAGE
                        | wgpu::BufferUsages::COPY_SRC
                        | wgpu::BufferUsages::COPY_DST
                        | indirect,
                    mapped_at_creation: false,
                })
            };
            Self { portions: (0..count).map(portion).collect(), each, begin: 0, bytes }
        })?;
        if let Some(bytes) = contents.bytes() {
            made.write(gpu, 0, &bytes)?;
        }
        Ok(made)
    }

    /// A stretch of an array in one portion, as an array.
    pub(super) fn stretch(&self, begin: u64, bytes: u64) -> Self {
        Self { begin: self.begin + begin, bytes, ..self.clone() }
    }

    /// Bytes of all of it.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The buffer of a portion.
    pub(super) fn portion(&self, number: u32) -> &wgpu::Buffer {
        &self.portions[number as usize]
    }

    /// Writes bytes from an offset on.
    pub(super) fn write(&self, gpu: &Gpu, offset: u64, bytes: &[u8]) -> Result<(), GpuError> {
        let mut waiting = 0;
        for (portion, there, part) in self.parts(offset..offset + bytes.len() as u64) {
            let part = &bytes[(part.start - offset) as usize..(part.end - offset) as usize];
            for (number, piece) in part.chunks(WAITING).enumerate() {
                gpu.queue.write_buffer(portion, there + (number * WAITING) as u64, piece);
                waiting += piece.len();
                if waiting >= WAITING {
                    gpu.wait_for(gpu.queue.submit([]))?;
                    waiting = 0;
                }
            }
        }
        Ok(())
    }

    /// Records a copy of a range of bytes to a place in another buffer.
    pub(super) fn copy_to(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        range: Range<u64>,
        buffer: &wgpu::Buffer,
        at: u64,
    ) {
        let begin = range.start;
        for (portion, there, part) in self.parts(range) {
            encoder.copy_buffer_to_buffer(portion, there, buffer, at + part.start - begin, part.end - part.start);
        }
    }

    /// Records that a range of bytes is filled with zeros.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder, range: Range<u64>) {
        for (portion, there, part) in self.parts(range) {
            encoder.clear_buffer(portion, there, Some(part.end - part.start));
        }
    }

    /// The portions that hold a range of bytes, with the first byte there and the bytes of the whole that each has of them.
    fn parts(&self, range: Range<u64>) -> impl Iterator<Item = (&wgpu::Buffer, u64, Range<u64>)> {
        let firsts = self.portions.iter().zip((0..).map(|number| number * self.each));
        let part = move |(portion, first): (_, u64)| {
            let part = range.start.max(first)..range.end.min(first + self.each);
            (part.start < part.end).then(|| (portion, self.begin + part.start - first, part))
        };
        firsts.filter_map(part)
    }
}
