//! Parts of all painting on the device: formats, pipelines made when they are first needed, textures, buffers, passes.

use super::error::PlotError;
use super::renderer::Plotter;
use bytemuck::Pod;
use std::sync::OnceLock;

/// Written through an sRGB view, so that blending happens in linear light.
pub(super) const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Of enlarged particles: square roots of linear light, nearly as fine as sRGB and cheaper to write.
pub(super) const ENLARGED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Instances in one vertex buffer: 48 bytes each at most, far below the smallest permitted buffer limit.
const INSTANCES_PER_BUFFER: usize = 1 << 21;

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

/// Instances on the device: buffers, with how many each holds.
pub(super) type Instances = Vec<(wgpu::Buffer, u32)>;

impl Plotter<'_> {
    /// Runs device work and turns what the device reports meanwhile into an error.
    pub(super) fn checked<T>(&self, stage: &'static str, work: impl FnOnce() -> T) -> Result<T, PlotError> {
        let scopes = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation]
            .map(|filter| self.gpu.device.push_error_scope(filter));
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
        let descriptor = wgpu::ShaderModuleDescriptor { label: Some(name), source };
        let module = &self.gpu.device.create_shader_module(descriptor);
        let (format, blend) = match target {
            Target::Enlarged => (ENLARGED_FORMAT, None),
            Target::Picture => (COLOUR_FORMAT, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
        };
        let step_mode = wgpu::VertexStepMode::Instance;
        let instance = wgpu::VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode, attributes };
        let buffers = [Some(instance)];
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
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

    pub(super) fn instances<T: Pod>(&self, label: &str, instances: &[T]) -> Instances {
        let filled = |chunk: &[T]| {
            let buffer = self.filled_buffer(label, bytemuck::cast_slice(chunk), wgpu::BufferUsages::VERTEX);
            (buffer, chunk.len() as u32)
        };
        instances.chunks(INSTANCES_PER_BUFFER).map(filled).collect()
    }

    fn filled_buffer(&self, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        // Not mapped at creation: without memory for it wgpu would panic there.
        let (size, usage) = (contents.len() as u64, usage | wgpu::BufferUsages::COPY_DST);
        let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = self.gpu.device.create_buffer(&descriptor);
        self.gpu.queue.write_buffer(&buffer, 0, contents);
        buffer
    }

    pub(super) fn texture(
        &self,
        label: &str,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.gpu.device.create_texture(&wgpu::TextureDescriptor {
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
        self.gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        view(&texture, label)
    }

    /// Draws with a pipeline from here on, which reads these resources in the order of its bindings.
    pub(super) fn bind<'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        label: &str,
        pipeline: &wgpu::RenderPipeline,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'a>>,
    ) {
        let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        let group = self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries.collect::<Vec<_>>(),
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
    }

    /// Paints over a view, or over what it is cleared to; with a depth, which is cleared, the nearest stays.
    pub(super) fn pass(
        &self,
        label: &str,
        view: &wgpu::TextureView,
        clear: Option<wgpu::Color>,
        depth: Option<&wgpu::TextureView>,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let mut encoder = self.gpu.encoder(label);
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
        self.gpu.queue.submit([encoder.finish()]);
    }
}

/// Draws a quad for every instance.
pub(super) fn draw_instances(pass: &mut wgpu::RenderPass<'_>, instances: &Instances) {
    for (buffer, count) in instances {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..4, 0..*count);
    }
}

/// A view of all of a texture, with a name.
pub(super) fn view(texture: &wgpu::Texture, label: &str) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() })
}
