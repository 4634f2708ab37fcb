//! What all painting on the device is made of: formats, pipelines made when they are first needed, textures, buffers, passes.

use super::error::PlotError;
use bytemuck::Pod;
use std::sync::OnceLock;

/// Written through an sRGB view, so that blending happens in linear light.
pub(super) const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Of enlarged particles: square roots of linear light, nearly as fine as sRGB and cheaper to write.
pub(super) const ENLARGED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What a pipeline paints.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    /// Laid over what the picture holds.
    Picture,
    /// The texture of enlarged particles, where the nearest stays.
    Enlarged,
}

/// A page of WGSL: its name and its text.
pub(super) type Page = (&'static str, &'static str);

/// A device that pictures are painted with.
#[derive(Debug, Clone)]
pub(super) struct Painter {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

impl Painter {
    /// Runs device work and turns what the device reports meanwhile into an error.
    pub(super) fn checked<T>(&self, stage: &'static str, work: impl FnOnce() -> T) -> Result<T, PlotError> {
        let scopes = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation]
            .map(|filter| self.device.push_error_scope(filter));
        let result = work();
        let mut failure = None;
        // Scopes are a stack: the last pushed is the first popped.
        for scope in scopes.into_iter().rev() {
            let found = pollster::block_on(scope.pop());
            failure = failure.or(found);
        }
        match failure {
            None => Ok(result),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(PlotError::OutOfMemory { stage }),
            Some(error) => Err(PlotError::Device { stage, message: error.to_string() }),
        }
    }

    /// A pipeline, made when it is first asked for.
    pub(super) fn once<'a>(
        &self,
        pipeline: &'a OnceLock<wgpu::RenderPipeline>,
        stage: &'static str,
        make: impl FnOnce(&Self) -> wgpu::RenderPipeline,
    ) -> Result<&'a wgpu::RenderPipeline, PlotError> {
        if let Some(pipeline) = pipeline.get() {
            return Ok(pipeline);
        }
        let made = self.checked(stage, || make(self))?;
        Ok(pipeline.get_or_init(|| made))
    }

    /// A pipeline of two entry points of a page, with what each instance has of the type `T`, if anything.
    pub(super) fn pipeline<T>(
        &self,
        label: &str,
        (name, source): Page,
        entry_points: [&str; 2],
        attributes: &[wgpu::VertexAttribute],
        target: Target,
    ) -> wgpu::RenderPipeline {
        let source = wgpu::ShaderSource::Wgsl(source.into());
        let module = &self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source });
        let (format, blend) = match target {
            Target::Enlarged => (ENLARGED_FORMAT, None),
            Target::Picture => (COLOUR_FORMAT, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
        };
        let step_mode = wgpu::VertexStepMode::Instance;
        let instance = wgpu::VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode, attributes };
        let buffers = [Some(instance)];
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: None,
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(entry_points[0]),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: if attributes.is_empty() { &[] } else { &buffers },
            },
            primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
            depth_stencil: (target == Target::Enlarged).then(|| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry_points[1]),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    pub(super) fn uniform<T: Pod>(&self, label: &str, value: &T) -> wgpu::Buffer {
        self.filled_buffer(label, bytemuck::bytes_of(value), wgpu::BufferUsages::UNIFORM)
    }

    pub(super) fn filled_buffer(&self, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    pub(super) fn texture(
        &self,
        label: &str,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// A view of a texture that holds these bytes, row by row.
    pub(super) fn filled_texture(
        &self,
        label: &str,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        bytes: &[u8],
    ) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let texture = self.texture(label, size, format, usage);
        let bytes_per_row = format.block_copy_size(None).map(|texel| texel * size[0]);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        self.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        view(&texture, label)
    }

    /// What a pipeline reads, in the order of its bindings.
    pub(super) fn bind_group<'a>(
        &self,
        label: &str,
        pipeline: &wgpu::RenderPipeline,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'a>>,
    ) -> wgpu::BindGroup {
        let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    /// Paints over a view, or over what it is cleared to; with a depth, which is cleared, the nearest stays.
    pub(super) fn paint(
        &self,
        label: &str,
        view: &wgpu::TextureView,
        clear: Option<wgpu::Color>,
        depth: Option<&wgpu::TextureView>,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) });
        let load = clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear);
        draw(&mut encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        }));
        self.queue.submit([encoder.finish()]);
    }
}

/// A view of all of a texture, with a name.
pub(super) fn view(texture: &wgpu::Texture, label: &str) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() })
}
