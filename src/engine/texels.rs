//! Arrays of texels: textures that are loaded, stored to, filled and read back as buffers are.

use crate::gpu::{Gpu, GpuError};
use crate::plan::Texture;

/// A texture of a plan on the device.
pub(super) struct Texels {
    planned: Texture,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// The first row, where it is a part of a larger texture.
    row: u32,
}

impl Texels {
    pub(super) fn new(gpu: &Gpu, planned: &Texture) -> Result<Self, GpuError> {
        let doing = format!("creating texture `{}`", planned.array.name());
        let texture = gpu.scoped(&doing, planned.bytes(), || {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(planned.array.name()),
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
        let view = texture
            .create_view(&wgpu::TextureViewDescriptor { label: Some(planned.array.name()), ..Default::default() });
        let texels = Self { planned: planned.clone(), texture, view, row: 0 };
        texels.fill(gpu);
        Ok(texels)
    }

    /// The rows from one on as a texture of a plan.
    pub(super) fn rows_from(&self, row: u32, planned: &Texture) -> Self {
        Self { planned: planned.clone(), texture: self.texture.clone(), view: self.view.clone(), row: self.row + row }
    }

    /// Writes what the plan has in it at first.
    pub(super) fn fill(&self, gpu: &Gpu) {
        if let Some(bytes) = self.planned.contents.bytes() {
            self.write(gpu, &bytemuck::pod_collect_to_vec::<u8, u32>(&bytes));
        }
    }

    pub(super) fn binding(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::TextureView(&self.view)
    }

    /// Bytes on the device.
    pub(super) fn bytes(&self) -> u64 {
        self.planned.bytes()
    }

    /// Fills it from its beginning; the rest of the last row written becomes zeros.
    pub(super) fn write(&self, gpu: &Gpu, words: &[u32]) {
        let row_words = (self.planned.row_bytes() / 4) as usize;
        let (full, rest) = words.split_at(words.len() - words.len() % row_words);
        self.write_rows(gpu, 0, (full.len() / row_words) as u32, full);
        if !rest.is_empty() {
            let mut last = rest.to_vec();
            last.resize(row_words, 0);
            self.write_rows(gpu, (full.len() / row_words) as u32, 1, &last);
        }
    }

    fn write_rows(&self, gpu: &Gpu, first: u32, height: u32, words: &[u32]) {
        if height == 0 {
            return;
        }
        let size = wgpu::Extent3d { height, ..extent(&self.planned) };
        gpu.queue.write_texture(self.place(first), bytemuck::cast_slice(words), self.rows(), size);
    }

    /// Records a copy of all of it to the beginning of a buffer.
    pub(super) fn copy_to(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let destination = wgpu::TexelCopyBufferInfo { buffer, layout: self.rows() };
        encoder.copy_texture_to_buffer(self.place(0), destination, extent(&self.planned));
    }

    fn place(&self, row: u32) -> wgpu::TexelCopyTextureInfo<'_> {
        let origin = wgpu::Origin3d { y: self.row + row, ..wgpu::Origin3d::ZERO };
        wgpu::TexelCopyTextureInfo { origin, ..self.texture.as_image_copy() }
    }

    fn rows(&self) -> wgpu::TexelCopyBufferLayout {
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.planned.row_bytes() as u32),
            rows_per_image: None,
        }
    }
}

fn extent(planned: &Texture) -> wgpu::Extent3d {
    let [width, height] = planned.size;
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}
