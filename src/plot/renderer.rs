//! The device side: pipelines made once, pictures painted into a texture and read back.

use super::canvas::{Area, Batch, Canvas, Shape};
use super::cells::{self, CellPicture};
use super::chart::Chart;
use super::chart_layout;
use super::error::PlotError;
use super::field::{self, FieldPicture, FieldScene};
use super::field_renderer::{draw_field, field_pipeline};
use super::palette::linear;
use super::particles::{self, ParticleInstance, ParticlePicture, SphereScene};
use crate::scene::{PlotStyle, Snapshot, Theme};
use bytemuck::{Pod, Zeroable};
use image::RgbaImage;
use std::sync::{OnceLock, mpsc};
use std::time::Duration;

/// Written through an sRGB view, so that blending happens in linear light.
const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Of enlarged particles: square roots of linear light, nearly as fine as sRGB and cheaper to write.
const ENLARGED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Side of the texture that particles are drawn into, larger than life; a big picture takes several turns.
const TILE_SIDE: u32 = 2048;
/// Instances in one vertex buffer: 16 and 48 bytes each, far below the smallest permitted buffer limit.
const INSTANCES_PER_BUFFER: usize = 1 << 21;
const PATIENCE: Duration = Duration::from_mins(2);

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Viewport {
    size: [f32; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Placement {
    origin: [i32; 2],
    samples: i32,
    padding: i32,
}

/// The camera of `spheres.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Camera {
    right: [f32; 4],
    up: [f32; 4],
    toward: [f32; 4],
    centre_and_size: [f32; 4],
    fog: [f32; 4],
    look: [f32; 4],
}

/// Draws pictures with one device; its pipelines are made once, when a picture first needs them.
#[derive(Debug)]
pub struct Plotter {
    device: wgpu::Device,
    queue: wgpu::Queue,
    shapes: wgpu::RenderPipeline,
    spheres: OnceLock<wgpu::RenderPipeline>,
    composite: OnceLock<wgpu::RenderPipeline>,
    field: OnceLock<wgpu::RenderPipeline>,
}

/// What lies between the shapes of the background and those of the foreground.
enum Content<'a> {
    Nothing,
    Particles(&'a SphereScene),
    Field(&'a FieldScene),
}

/// Runs device work and turns what the device reports meanwhile into an error.
fn checked<T>(device: &wgpu::Device, stage: &'static str, work: impl FnOnce() -> T) -> Result<T, PlotError> {
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
fn once<'a>(
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

impl Plotter {
    /// Makes the pipeline that every picture needs.
    ///
    /// # Errors
    /// [`PlotError::Device`] if the adapter refuses a shader or a pipeline, [`PlotError::OutOfMemory`].
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, PlotError> {
        let shapes = checked(device, "pipeline of the shapes", || shapes_pipeline(device))?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            shapes,
            spheres: OnceLock::new(),
            composite: OnceLock::new(),
            field: OnceLock::new(),
        })
    }

    /// Draws a chart into an sRGB image of `style.width` by `style.height` pixels. The same input gives the same bytes
    /// on one adapter and driver.
    ///
    /// # Errors
    /// [`PlotError::Size`] if the adapter has no texture that large, [`PlotError::Input`] if a series has errors but
    /// not one per point, [`PlotError::TypeTooLarge`] if `scale` is excessive, and what the device reports.
    pub fn draw_chart(&self, chart: &Chart, style: &PlotStyle) -> Result<RgbaImage, PlotError> {
        self.paint(&chart_layout::lay_out(chart, style)?, &Content::Nothing)
    }

    /// Draws the particles into an sRGB image of the size that `style` says, or the box asks for. The same input gives
    /// the same bytes on one adapter and driver.
    ///
    /// # Errors
    /// [`PlotError::Size`] if the adapter has no texture that large, [`PlotError::Input`] if the lists of the picture
    /// differ in length or a box edge or the radius is not positive, and what the device reports.
    pub fn draw_particles(
        &self,
        picture: &ParticlePicture<'_>,
        style: &Snapshot,
        theme: Theme,
    ) -> Result<RgbaImage, PlotError> {
        let (canvas, scene) = particles::lay_out(picture, style, theme)?;
        self.paint(&canvas, &Content::Particles(&scene))
    }

    /// Draws Voronoi cells into an sRGB image of `style.width` by `style.height` pixels. The same input gives the same bytes
    /// on one adapter and driver.
    ///
    /// # Errors
    /// [`PlotError::Size`] if the adapter has no texture that large, [`PlotError::Input`] if the lists of the picture
    /// differ in length or a box edge is not positive, and what the device reports.
    pub fn draw_cells(
        &self,
        picture: &CellPicture<'_>,
        style: &Snapshot,
        theme: Theme,
    ) -> Result<RgbaImage, PlotError> {
        self.paint(&cells::lay_out(picture, style, theme)?, &Content::Nothing)
    }

    /// Draws a field into an sRGB image of `style.width` by `style.height` pixels. The same input gives the same bytes
    /// on one adapter and driver.
    ///
    /// # Errors
    /// [`PlotError::Size`] if the adapter has no texture as large as the picture, [`PlotError::Input`] if it has none as
    /// large as the mesh or the parts of the field do not fit together, [`PlotError::TypeTooLarge`] if `scale` is
    /// excessive, and what the device reports.
    pub fn draw_field(&self, picture: &FieldPicture<'_>, style: &PlotStyle) -> Result<RgbaImage, PlotError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        let [kx, ky] = picture.field.nodes;
        if kx.max(ky) > limit as usize {
            let message = format!("the mesh has {kx} x {ky} nodes; this adapter draws {limit} along an axis at most");
            return Err(PlotError::Input(message));
        }
        let (canvas, scene) = field::lay_out(picture, style)?;
        self.paint(&canvas, &Content::Field(&scene))
    }

    fn check_size(&self, width: u32, height: u32) -> Result<(), PlotError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(PlotError::Size { width, height, limit });
        }
        Ok(())
    }

    fn paint(&self, canvas: &Canvas, content: &Content<'_>) -> Result<RgbaImage, PlotError> {
        self.check_size(canvas.width, canvas.height)?;
        let target = checked(&self.device, "picture", || {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("plot: picture"),
                size: wgpu::Extent3d { width: canvas.width, height: canvas.height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: COLOUR_FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        })?;
        let view = target.create_view(&labelled("plot: picture"));
        let atlas = self.atlas(canvas)?;
        let paper = canvas.paper;
        let clear = wgpu::Color {
            r: f64::from(linear(paper[0])),
            g: f64::from(linear(paper[1])),
            b: f64::from(linear(paper[2])),
            a: 1.0,
        };
        let (under, over) = canvas.batches.split_at(canvas.background);
        checked(&self.device, "background", || self.shapes_pass(canvas, under, &view, &atlas, Some(clear)))?;
        match content {
            Content::Nothing => {}
            Content::Particles(scene) => {
                let spheres = once(&self.spheres, &self.device, "pipeline of the particles", spheres_pipeline)?;
                let composite = once(&self.composite, &self.device, "pipeline of the overlay", composite_pipeline)?;
                let pipelines = [spheres, composite];
                checked(&self.device, "particles", || self.spheres_passes(pipelines, canvas, scene, &view))?;
            }
            Content::Field(scene) => {
                let field = once(&self.field, &self.device, "pipeline of the fields", field_pipeline)?;
                checked(&self.device, "field", || self.field_pass(field, canvas, scene, &view))?;
            }
        }
        checked(&self.device, "foreground", || self.shapes_pass(canvas, over, &view, &atlas, None))?;
        self.read_back(&target)
    }

    /// Uploads the glyphs and binds them with the size of the picture.
    fn atlas(&self, canvas: &Canvas) -> Result<wgpu::BindGroup, PlotError> {
        let (width, height, coverage) = canvas.typesetter.atlas()?;
        checked(&self.device, "type", || {
            let size = wgpu::Extent3d { width, height: height.max(1), depth_or_array_layers: 1 };
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("plot: glyphs"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::R8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            if height > 0 {
                let layout =
                    wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width), rows_per_image: Some(height) };
                self.queue.write_texture(texture.as_image_copy(), coverage, layout, size);
            }
            let viewport = Viewport { size: [canvas.width as f32, canvas.height as f32] };
            self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("plot: shapes"),
                layout: &self.shapes.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: self.uniform("plot: viewport", &viewport).as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: wgpu::BindingResource::TextureView(&texture.create_view(&labelled("plot: glyphs"))),
                    },
                ],
            })
        })
    }

    fn uniform<T: Pod>(&self, label: &str, value: &T) -> wgpu::Buffer {
        self.filled_buffer(label, bytemuck::bytes_of(value), wgpu::BufferUsages::UNIFORM)
    }

    fn filled_buffer(&self, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    fn shapes_pass(
        &self,
        canvas: &Canvas,
        batches: &[Batch],
        view: &wgpu::TextureView,
        atlas: &wgpu::BindGroup,
        clear: Option<wgpu::Color>,
    ) {
        let mut encoder =
            self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("plot: shapes") });
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("plot: shapes"),
                color_attachments: &[Some(colour_attachment(view, clear))],
                ..Default::default()
            });
            pass.set_pipeline(&self.shapes);
            pass.set_bind_group(0, atlas, &[]);
            for batch in batches {
                let Some([x, y, width, height]) = scissor(batch.clip, canvas) else { continue };
                pass.set_scissor_rect(x, y, width, height);
                let shapes = &canvas.shapes[batch.shapes.start as usize..batch.shapes.end as usize];
                for chunk in shapes.chunks(INSTANCES_PER_BUFFER) {
                    let bytes = bytemuck::cast_slice(chunk);
                    let buffer = self.filled_buffer("plot: shapes", bytes, wgpu::BufferUsages::VERTEX);
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    pass.draw(0..4, 0..chunk.len() as u32);
                }
            }
        }
        self.queue.submit([encoder.finish()]);
    }

    fn field_pass(
        &self,
        pipeline: &wgpu::RenderPipeline,
        canvas: &Canvas,
        scene: &FieldScene,
        view: &wgpu::TextureView,
    ) {
        let [left, top, width, height] = scene.area.map(f64::from);
        let area = Area { left, top, right: left + width, bottom: top + height };
        // In a picture too small for its type the image may stand out of it.
        if let Some(clip) = scissor(Some(area), canvas) {
            draw_field(&self.device, &self.queue, pipeline, scene, clip, view);
        }
    }

    /// Draws the particles enlarged, tile by tile, and lays each tile over the picture.
    fn spheres_passes(
        &self,
        [spheres, composite]: [&wgpu::RenderPipeline; 2],
        canvas: &Canvas,
        scene: &SphereScene,
        view: &wgpu::TextureView,
    ) {
        if scene.particles.is_empty() {
            return;
        }
        let Some([left, top, width, height]) = scissor(Some(scene.area), canvas) else { return };
        let samples = scene.samples;
        let tile = TILE_SIDE / samples;
        let texture_size = wgpu::Extent3d {
            width: width.min(tile) * samples,
            height: height.min(tile) * samples,
            depth_or_array_layers: 1,
        };
        let texture = |label, format, usage| {
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: texture_size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            });
            texture.create_view(&labelled(label))
        };
        let colour = texture("plot: particles", ENLARGED_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
        let depth = texture("plot: depth of particles", DEPTH_FORMAT, wgpu::TextureUsages::empty());
        let buffers: Vec<_> = scene
            .particles
            .chunks(INSTANCES_PER_BUFFER)
            .map(|chunk| {
                let bytes = bytemuck::cast_slice::<ParticleInstance, u8>(chunk);
                (self.filled_buffer("plot: particles", bytes, wgpu::BufferUsages::VERTEX), chunk.len() as u32)
            })
            .collect();
        for tile_top in (top..top + height).step_by(tile as usize) {
            for tile_left in (left..left + width).step_by(tile as usize) {
                let tile_size = [tile.min(left + width - tile_left), tile.min(top + height - tile_top)];
                let mut encoder =
                    self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("plot: shapes") });
                let camera = camera(scene, [tile_left, tile_top], [texture_size.width, texture_size.height]);
                self.enlarged_pass(spheres, &mut encoder, &camera, &buffers, [&colour, &depth]);
                let placement =
                    Placement { origin: [tile_left as i32, tile_top as i32], samples: samples as i32, padding: 0 };
                self.composite_pass(composite, &mut encoder, &placement, tile_size, [&colour, view]);
                self.queue.submit([encoder.finish()]);
            }
        }
    }

    fn enlarged_pass(
        &self,
        pipeline: &wgpu::RenderPipeline,
        encoder: &mut wgpu::CommandEncoder,
        camera: &Camera,
        buffers: &[(wgpu::Buffer, u32)],
        [colour, depth]: [&wgpu::TextureView; 2],
    ) {
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plot: camera"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: self.uniform("plot: camera", camera).as_entire_binding(),
            }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("plot: particles"),
            color_attachments: &[Some(colour_attachment(colour, Some(wgpu::Color::TRANSPARENT)))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        for (buffer, count) in buffers {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..*count);
        }
    }

    fn composite_pass(
        &self,
        pipeline: &wgpu::RenderPipeline,
        encoder: &mut wgpu::CommandEncoder,
        placement: &Placement,
        size: [u32; 2],
        [enlarged, view]: [&wgpu::TextureView; 2],
    ) {
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plot: overlay"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: self.uniform("plot: placement", placement).as_entire_binding(),
                },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(enlarged) },
            ],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("plot: overlay"),
            color_attachments: &[Some(colour_attachment(view, None))],
            ..Default::default()
        });
        let [x, y] = placement.origin.map(|pixel| pixel as f32);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_viewport(x, y, size[0] as f32, size[1] as f32, 0.0, 1.0);
        pass.draw(0..4, 0..1);
    }

    fn read_back(&self, texture: &wgpu::Texture) -> Result<RgbaImage, PlotError> {
        let (width, height) = (texture.width(), texture.height());
        let row = width * 4;
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        // Copied in strips, so that the staging buffer stays small however large the picture.
        let strip = ((64 << 20) / padded_row).clamp(1, height);
        let mut pixels = Vec::with_capacity(row as usize * height as usize);
        let buffer = checked(&self.device, "copy of the picture", || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
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
            let submission = checked(&self.device, "copy of the picture", || {
                let mut encoder =
                    self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("plot: shapes") });
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
                self.queue.submit([encoder.finish()])
            })?;
            self.device
                .poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) })
                .map_err(|error| PlotError::Readback(error.to_string()))?;
            // The mapping may be on its way in another thread that polls the same device.
            receiver
                .recv_timeout(PATIENCE)
                .map_err(|error| PlotError::Readback(error.to_string()))?
                .map_err(|error| PlotError::Readback(error.to_string()))?;
            let mapped = buffer.get_mapped_range(0..bytes).map_err(|error| PlotError::Readback(error.to_string()))?;
            for padded in mapped.chunks(padded_row as usize) {
                pixels.extend_from_slice(&padded[..row as usize]);
            }
            drop(mapped);
            buffer.unmap();
        }
        RgbaImage::from_raw(width, height, pixels)
            .ok_or_else(|| PlotError::Readback("fewer bytes than pixels".to_owned()))
    }
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

/// The clipping rectangle in whole pixels inside the picture: x, y, width, height. None where nothing is left.
fn scissor(clip: Option<Area>, canvas: &Canvas) -> Option<[u32; 4]> {
    let Some(area) = clip else { return Some([0, 0, canvas.width, canvas.height]) };
    let clamp = |value: f64, limit: u32| value.round().clamp(0.0, f64::from(limit)) as u32;
    let (left, right) = (clamp(area.left, canvas.width), clamp(area.right, canvas.width));
    let (top, bottom) = (clamp(area.top, canvas.height), clamp(area.bottom, canvas.height));
    (right > left && bottom > top).then(|| [left, top, right - left, bottom - top])
}

fn camera(scene: &SphereScene, tile: [u32; 2], target: [u32; 2]) -> Camera {
    let samples = scene.samples as f32;
    let with = |vector: [f64; 3], last: f64| [vector[0] as f32, vector[1] as f32, vector[2] as f32, last as f32];
    let scale = scene.pixels_per_length * f64::from(scene.samples);
    let fog = |channel: usize| linear(scene.paper[channel]).sqrt();
    Camera {
        right: with(scene.right, scale),
        up: with(scene.up, 0.0),
        toward: with(scene.toward, scene.half_depth),
        centre_and_size: [
            (scene.centre[0] as f32 - tile[0] as f32) * samples,
            (scene.centre[1] as f32 - tile[1] as f32) * samples,
            target[0] as f32,
            target[1] as f32,
        ],
        fog: [fog(0), fog(1), fog(2), scene.fog as f32],
        look: [scene.radius as f32, (scene.radius * scale) as f32, scene.lighting as f32, scene.rim as f32],
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

fn shapes_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/shapes.wgsl", include_str!("../../shaders/plot/shapes.wgsl"));
    let instance = wgpu::VertexBufferLayout {
        array_stride: size_of::<Shape>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![
            0 => Float32x4, 1 => Float32x4, 2 => Float32, 3 => Uint32, 4 => Unorm8x4
        ],
    };
    pipeline(device, "plot: shapes", &module, ["vertex_shape", "fragment_shape"], Some(instance), Target::Picture)
}

fn spheres_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/spheres.wgsl", include_str!("../../shaders/plot/spheres.wgsl"));
    let instance = wgpu::VertexBufferLayout {
        array_stride: size_of::<ParticleInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4],
    };
    pipeline(device, "plot: particles", &module, ["vertex_sphere", "fragment_sphere"], Some(instance), Target::Enlarged)
}

fn composite_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = module(device, "plot/composite.wgsl", include_str!("../../shaders/plot/composite.wgsl"));
    pipeline(device, "plot: overlay", &module, ["vertex_composite", "fragment_composite"], None, Target::Picture)
}

/// A view of all of a texture, with a name.
fn labelled(label: &str) -> wgpu::TextureViewDescriptor<'_> {
    wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() }
}
