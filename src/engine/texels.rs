//! Arrays of texels: textures that are loaded, stored to, filled and read back as buffers are.

use crate::gpu::{Gpu, GpuError};
use crate::plan::Texture;

/// A texture of a plan on the device.
pub(super) struct Texels {
    planned: Texture,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl Texels {
    pub(super) fn new(gpu: &Gpu, planned: Texture) -> Result<Self, GpuError> {
        let doing = format!("creating texture `{}`", planned.name);
        let texture = gpu.scoped(&doing, planned.bytes(), || {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(planned.name),
                size: extent(planned),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: match planned.words {
                    1 => wgpu::TextureFormat::R32Uint,
                    2 => wgpu::TextureFormat::Rg32Uint,
                    _ => wgpu::TextureFormat::Rgba32Uint,
                },
                usage: wgpu::TextureUsages::STORAGE_BINDING
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        })?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { planned, texture, view })
    }

    pub(super) fn binding(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::TextureView(&self.view)
    }

    /// Bytes on the device.
    pub(super) fn bytes(&self) -> u64 {
        self.planned.bytes()
    }

    /// Fills it from its beginning; the rest of the last row that is reached becomes zeros.
    pub(super) fn write(&self, gpu: &Gpu, words: &[u32]) {
        let row_words = (self.planned.row_bytes() / 4) as usize;
        let rows = words.len().div_ceil(row_words).max(1);
        let mut padded = words.to_vec();
        padded.resize(rows * row_words, 0);
        let size = wgpu::Extent3d { height: rows as u32, ..extent(self.planned) };
        gpu.queue.write_texture(self.texture.as_image_copy(), bytemuck::cast_slice(&padded), self.rows(), size);
    }

    /// Records a copy of all of it to the beginning of a buffer.
    pub(super) fn copy_to(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let destination = wgpu::TexelCopyBufferInfo { buffer, layout: self.rows() };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), destination, extent(self.planned));
    }

    fn rows(&self) -> wgpu::TexelCopyBufferLayout {
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.planned.row_bytes() as u32),
            rows_per_image: None,
        }
    }
}

fn extent(planned: Texture) -> wgpu::Extent3d {
    let [width, height] = planned.size;
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}
