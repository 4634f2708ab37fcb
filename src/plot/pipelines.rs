//! What all painting on the device is made of: formats, pipelines made when they are first needed, buffers.

use super::error::PlotError;
use bytemuck::Pod;
use std::sync::OnceLock;

/// Written through an sRGB view, so that blending happens in linear light.
pub(super) const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Of enlarged particles: square roots of linear light, nearly as fine as sRGB and cheaper to write.
pub(super) const ENLARGED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Runs device work and turns what the device reports meanwhile into an error.
pub(super) fn checked<T>(device: &wgpu::Device, stage: &'static str, work: impl FnOnce() -> T) -> Result<T, PlotError> {
    let scopes = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation]
        .map(|filter| device.push_error_scope(filter));
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
    pipeline: &'a OnceLock<wgpu::RenderPipeline>,
    device: &wgpu::Device,
    stage: &'static str,
    make: impl FnOnce(&wgpu::Device) -> wgpu::RenderPipeline,
) -> Result<&'a wgpu::RenderPipeline, PlotError> {
    if let Some(pipeline) = pipeline.get() {
        return Ok(pipeline);
    }
    let made = checked(device, stage, || make(device))?;
    Ok(pipeline.get_or_init(|| made))
}

pub(super) fn uniform<T: Pod>(device: &wgpu::Device, queue: &wgpu::Queue, label: &str, value: &T) -> wgpu::Buffer {
    filled_buffer(device, queue, label, bytemuck::bytes_of(value), wgpu::BufferUsages::UNIFORM)
}

pub(super) fn filled_buffer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    bytes: &[u8],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, bytes);
    buffer
}

pub(super) fn colour_attachment(
    view: &wgpu::TextureView,
    clear: Option<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    let load = clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear);
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}

/// What a pipeline paints.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    /// Laid over what the picture holds.
    Picture,
    /// The texture of enlarged particles, where the nearest stays.
    Enlarged,
}

pub(super) fn pipeline(
    device: &wgpu::Device,
    label: &str,
    module: &wgpu::ShaderModule,
    entry_points: [&str; 2],
    instance: Option<wgpu::VertexBufferLayout<'_>>,
    target: Target,
) -> wgpu::RenderPipeline {
    let (format, blend) = match target {
        Target::Enlarged => (ENLARGED_FORMAT, None),
        Target::Picture => (COLOUR_FORMAT, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
    };
    let buffers: Vec<_> = instance.into_iter().map(Some).collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(entry_points[0]),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &buffers,
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

pub(super) fn module(device: &wgpu::Device, label: &str, source: &'static str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

/// A view of all of a texture, with a name.
pub(super) fn labelled(label: &str) -> wgpu::TextureViewDescriptor<'_> {
    wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() }
}
