//! The device side: pipelines made once, pictures painted into a texture and read back.

use super::canvas::{Area, Batch, Canvas, Shape};
use super::cells::{self, CellPicture};
use super::chart::Chart;
use super::chart_layout;
use super::error::PlotError;
use super::field::{self, FieldPicture, FieldScene};
use super::field_renderer::{draw_field, field_pipeline};
use super::palette::linear;
use super::particles::{self, ParticlePicture, SphereScene};
use super::pipelines::{
    COLOUR_FORMAT, Target, checked, colour_attachment, filled_buffer, labelled, module, once, pipeline, uniform,
};
use super::readback::read_back;
use super::sphere_renderer::{composite_pipeline, draw_spheres, rods_pipeline, spheres_pipeline};
use crate::scene::{PlotStyle, Snapshot, Theme};
use bytemuck::{Pod, Zeroable};
use image::RgbaImage;
use std::sync::OnceLock;

/// Instances in one vertex buffer: 48 bytes each, far below the smallest permitted buffer limit.
const INSTANCES_PER_BUFFER: usize = 1 << 21;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Viewport {
    size: [f32; 2],
}

/// Draws pictures with one device; its pipelines are made once, when a picture first needs them.
#[derive(Debug)]
pub struct Plotter {
    device: wgpu::Device,
    queue: wgpu::Queue,
    shapes: wgpu::RenderPipeline,
    spheres: OnceLock<wgpu::RenderPipeline>,
    rods: OnceLock<wgpu::RenderPipeline>,
    composite: OnceLock<wgpu::RenderPipeline>,
    field: OnceLock<wgpu::RenderPipeline>,
}

/// What lies between the shapes of the background and those of the foreground.
enum Content<'a> {
    Nothing,
    Particles(&'a SphereScene),
    Field(&'a FieldScene),
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
            rods: OnceLock::new(),
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
                let rods = match scene.rods.as_slice() {
                    [] => None,
                    _ => Some(once(&self.rods, &self.device, "pipeline of the bonds", rods_pipeline)?),
                };
                if let Some(clip) = scissor(Some(scene.area), canvas) {
                    let (device, queue) = (&self.device, &self.queue);
                    checked(device, "particles", || draw_spheres(device, queue, pipelines, rods, scene, clip, &view))?;
                }
            }
            Content::Field(scene) => {
                let field = once(&self.field, &self.device, "pipeline of the fields", field_pipeline)?;
                checked(&self.device, "field", || self.field_pass(field, canvas, scene, &view))?;
            }
        }
        checked(&self.device, "foreground", || self.shapes_pass(canvas, over, &view, &atlas, None))?;
        read_back(&self.device, &self.queue, &target)
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
                        resource: uniform(&self.device, &self.queue, "plot: viewport", &viewport).as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: wgpu::BindingResource::TextureView(&texture.create_view(&labelled("plot: glyphs"))),
                    },
                ],
            })
        })
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
                    let buffer =
                        filled_buffer(&self.device, &self.queue, "plot: shapes", bytes, wgpu::BufferUsages::VERTEX);
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
}

/// The clipping rectangle in whole pixels inside the picture: x, y, width, height. None where nothing is left.
fn scissor(clip: Option<Area>, canvas: &Canvas) -> Option<[u32; 4]> {
    let Some(area) = clip else { return Some([0, 0, canvas.width, canvas.height]) };
    let clamp = |value: f64, limit: u32| value.round().clamp(0.0, f64::from(limit)) as u32;
    let (left, right) = (clamp(area.left, canvas.width), clamp(area.right, canvas.width));
    let (top, bottom) = (clamp(area.top, canvas.height), clamp(area.bottom, canvas.height));
    (right > left && bottom > top).then(|| [left, top, right - left, bottom - top])
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
