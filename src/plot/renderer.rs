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
use super::pipelines::{COLOUR_FORMAT, Page, Painter, Target, view};
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
    painter: Painter,
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
        let painter = Painter { device: device.clone(), queue: queue.clone() };
        let shapes = painter.checked("pipeline of the shapes", || shapes_pipeline(&painter))?;
        Ok(Self {
            painter,
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
    /// ```
    /// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
    /// use mesoscope::{plot, scene};
    ///
    /// let picture = plot::ParticlePicture {
    ///     dimension: 3,
    ///     lengths: [4.0; 3],
    ///     positions: &[[1.0, 1.0, 1.0], [3.0, 2.0, 1.5]],
    ///     species: &[0, 1],
    ///     species_names: &["light".to_owned(), "heavy".to_owned()],
    ///     speeds: None,
    ///     bonds: &[[0, 1]],
    ///     radius: 0.4,
    ///     title: "Two particles",
    ///     subtitle: "",
    /// };
    /// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
    /// let style = scene::Snapshot { width: Some(400), height: Some(300), ..scene::Snapshot::default() };
    /// let image = plot::Plotter::new(gpu.device(), gpu.queue())?.draw_particles(&picture, &style, scene::Theme::Light)?;
    /// assert_eq!(image.dimensions(), (400, 300));
    /// assert!(image.pixels().any(|pixel| pixel != image.get_pixel(0, 0)), "the picture is not empty");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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
    /// ```
    /// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
    /// use mesoscope::{measure::Field, plot, scene::PlotStyle};
    ///
    /// let wave = |[x, _]: [f64; 2]| x.sin();
    /// let field = Field::from_function("height", "height h", [16, 8], [std::f64::consts::TAU, 3.0], wave);
    /// let picture = plot::FieldPicture { title: "A wave", ..plot::FieldPicture::new(&field) };
    /// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
    /// let style = PlotStyle { width: 400, height: Some(300), ..PlotStyle::default() };
    /// let image = plot::Plotter::new(gpu.device(), gpu.queue())?.draw_field(&picture, &style)?;
    /// assert_eq!(image.dimensions(), (400, 300));
    /// assert!(image.pixels().any(|pixel| pixel != image.get_pixel(0, 0)), "the picture is not empty");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`PlotError::Size`] if the adapter has no texture as large as the picture, [`PlotError::Input`] if it has none as
    /// large as the mesh or the parts of the field do not fit together, [`PlotError::TypeTooLarge`] if `scale` is
    /// excessive, and what the device reports.
    pub fn draw_field(&self, picture: &FieldPicture<'_>, style: &PlotStyle) -> Result<RgbaImage, PlotError> {
        let limit = self.painter.device.limits().max_texture_dimension_2d;
        let [kx, ky] = picture.field.nodes;
        if kx.max(ky) > limit as usize {
            let message = format!("the mesh has {kx} x {ky} nodes; this adapter draws {limit} along an axis at most");
            return Err(PlotError::Input(message));
        }
        let (canvas, scene) = field::lay_out(picture, style)?;
        self.paint(&canvas, &Content::Field(&scene))
    }

    fn check_size(&self, width: u32, height: u32) -> Result<(), PlotError> {
        let limit = self.painter.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(PlotError::Size { width, height, limit });
        }
        Ok(())
    }

    fn paint(&self, canvas: &Canvas, content: &Content<'_>) -> Result<RgbaImage, PlotError> {
        self.check_size(canvas.width, canvas.height)?;
        let painter = &self.painter;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let size = [canvas.width, canvas.height];
        let target = painter.checked("picture", || painter.texture("plot: picture", size, COLOUR_FORMAT, usage))?;
        let view = view(&target, "plot: picture");
        let atlas = self.atlas(canvas)?;
        let [r, g, b] = [0, 1, 2].map(|channel| f64::from(linear(canvas.paper[channel])));
        let clear = Some(wgpu::Color { r, g, b, a: 1.0 });
        let (under, over) = canvas.batches.split_at(canvas.background);
        painter.checked("background", || self.shapes_pass(canvas, under, &view, &atlas, clear))?;
        match content {
            Content::Nothing => {}
            Content::Particles(scene) => {
                let spheres = painter.once(&self.spheres, "pipeline of the particles", spheres_pipeline)?;
                let composite = painter.once(&self.composite, "pipeline of the overlay", composite_pipeline)?;
                let rods = match scene.rods.as_slice() {
                    [] => None,
                    _ => Some(painter.once(&self.rods, "pipeline of the bonds", rods_pipeline)?),
                };
                if let Some(clip) = scissor(Some(scene.area), canvas) {
                    let draw = || draw_spheres(painter, [spheres, composite], rods, scene, clip, &view);
                    painter.checked("particles", draw)?;
                }
            }
            Content::Field(scene) => {
                let field = painter.once(&self.field, "pipeline of the fields", field_pipeline)?;
                let [left, top, width, height] = scene.area.map(f64::from);
                let area = Area { left, top, right: left + width, bottom: top + height };
                // In a picture too small for its type the image may stand out of it.
                if let Some(clip) = scissor(Some(area), canvas) {
                    painter.checked("field", || draw_field(painter, field, scene, clip, &view))?;
                }
            }
        }
        painter.checked("foreground", || self.shapes_pass(canvas, over, &view, &atlas, None))?;
        read_back(painter, &target)
    }

    /// Uploads the glyphs and binds them with the size of the picture.
    fn atlas(&self, canvas: &Canvas) -> Result<wgpu::BindGroup, PlotError> {
        let (width, height, coverage) = canvas.typesetter.atlas()?;
        // A texture has a row at least.
        let coverage = if height > 0 { coverage } else { &vec![0; width as usize] };
        let size = [width, height.max(1)];
        self.painter.checked("type", || {
            let glyphs = self.painter.filled_texture("plot: glyphs", size, wgpu::TextureFormat::R8Unorm, coverage);
            let viewport = Viewport { size: [canvas.width as f32, canvas.height as f32] };
            let viewport = self.painter.uniform("plot: viewport", &viewport);
            let resources = [viewport.as_entire_binding(), wgpu::BindingResource::TextureView(&glyphs)];
            self.painter.bind_group("plot: shapes", &self.shapes, resources)
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
        self.painter.paint("plot: shapes", view, clear, None, |pass| {
            pass.set_pipeline(&self.shapes);
            pass.set_bind_group(0, atlas, &[]);
            for batch in batches {
                let Some([x, y, width, height]) = scissor(batch.clip, canvas) else { continue };
                pass.set_scissor_rect(x, y, width, height);
                let shapes = &canvas.shapes[batch.shapes.start as usize..batch.shapes.end as usize];
                for chunk in shapes.chunks(INSTANCES_PER_BUFFER) {
                    let bytes = bytemuck::cast_slice(chunk);
                    let buffer = self.painter.filled_buffer("plot: shapes", bytes, wgpu::BufferUsages::VERTEX);
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    pass.draw(0..4, 0..chunk.len() as u32);
                }
            }
        });
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

const SHAPES: Page = ("plot/shapes.wgsl", include_str!("../../shaders/plot/shapes.wgsl"));

fn shapes_pipeline(painter: &Painter) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32, 3 => Uint32, 4 => Unorm8x4];
    let entry_points = ["vertex_shape", "fragment_shape"];
    painter.pipeline::<Shape>("plot: shapes", SHAPES, entry_points, &attributes, Target::Picture)
}
