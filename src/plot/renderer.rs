//! The device side: pipelines made once, pictures painted into a texture and read back.

use super::canvas::{Area, Batch, Canvas, Shape};
use super::cells::{self, CellPicture};
use super::chart::Chart;
use super::chart_layout;
use super::error::PlotError;
use super::field::{self, FieldPicture};
use super::palette::linear;
use super::particles::{self, ParticlePicture};
use super::pipelines::{COLOUR_FORMAT, Page, Target, draw_instances, view};
use super::{readback, vector};
use crate::gpu::Gpu;
use crate::scene::{PlotStyle, Snapshot, Theme, VectorFormat};
use image::RgbaImage;
use std::sync::OnceLock;

/// Draws pictures on one adapter; its pipelines are made once, when a picture first needs them.
pub struct Plotter<'g> {
    pub(super) gpu: &'g Gpu,
    shapes: OnceLock<wgpu::RenderPipeline>,
    pub(super) spheres: OnceLock<wgpu::RenderPipeline>,
    pub(super) rods: OnceLock<wgpu::RenderPipeline>,
    pub(super) composite: OnceLock<wgpu::RenderPipeline>,
    pub(super) field: OnceLock<wgpu::RenderPipeline>,
}

/// What lies between the shapes of the background and those of the foreground.
pub(super) trait Content {
    /// The part of the picture that it may cover.
    fn area(&self) -> Area;
    /// Draws it into a picture, of which it takes the part with this left, top, width and height.
    fn draw(&self, plotter: &Plotter<'_>, clip: [u32; 4], picture: &wgpu::TextureView) -> Result<(), PlotError>;
}

impl<'g> Plotter<'g> {
    /// Makes the pipeline that every picture needs.
    ///
    /// # Errors
    /// [`PlotError::Device`] if the adapter refuses a shader or a pipeline, [`PlotError::OutOfMemory`].
    pub fn new(gpu: &'g Gpu) -> Result<Self, PlotError> {
        let [shapes, spheres, rods, composite, field] = [const { OnceLock::new() }; 5];
        let plotter = Self { gpu, shapes, spheres, rods, composite, field };
        plotter.shapes()?;
        Ok(plotter)
    }

    fn shapes(&self) -> Result<&wgpu::RenderPipeline, PlotError> {
        self.once(&self.shapes, "pipeline of the shapes", shapes_pipeline)
    }

    /// Draws a chart into an sRGB image of `style.width` by `style.height` pixels. The same input gives the same bytes
    /// on one adapter and driver.
    ///
    /// # Errors
    /// [`PlotError::Size`] if the adapter has no texture that large, [`PlotError::Input`] if a series has errors but
    /// not one per point, [`PlotError::TypeTooLarge`] if `scale` is excessive, and what the device reports.
    pub fn draw_chart(&self, chart: &Chart, style: &PlotStyle) -> Result<RgbaImage, PlotError> {
        self.paint(&chart_layout::lay_out(chart, style)?, None)
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
    /// let image = plot::Plotter::new(&gpu)?.draw_particles(&picture, &style, scene::Theme::Light)?;
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
        self.paint(&canvas, Some(&scene))
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
        self.paint(&cells::lay_out(picture, style, theme)?, None)
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
    /// let image = plot::Plotter::new(&gpu)?.draw_field(&picture, &style)?;
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
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        let [kx, ky] = picture.field.nodes;
        if kx.max(ky) > limit as usize {
            let message = format!("the mesh has {kx} x {ky} nodes; this adapter draws {limit} along an axis at most");
            return Err(PlotError::Input(message));
        }
        let (canvas, scene) = field::lay_out(picture, style)?;
        self.paint(&canvas, Some(&scene))
    }

    fn paint(&self, canvas: &Canvas, content: Option<&dyn Content>) -> Result<RgbaImage, PlotError> {
        let (width, height) = (canvas.width, canvas.height);
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(PlotError::Size { width, height, limit });
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let size = [width, height];
        let target = self.checked("picture", || self.texture("plot: picture", size, COLOUR_FORMAT, usage))?;
        let view = view(&target, "plot: picture");
        let (viewport, glyphs) = self.atlas(canvas)?;
        let pipeline = self.shapes()?;
        let shapes = |batches: &[Batch], clear: Option<wgpu::Color>| {
            self.pass("plot: shapes", &view, clear, None, |pass| {
                let resources = [viewport.as_entire_binding(), wgpu::BindingResource::TextureView(&glyphs)];
                self.bind(pass, "plot: shapes", pipeline, resources);
                for batch in batches {
                    let Some([x, y, width, height]) = scissor(batch.clip, canvas) else { continue };
                    pass.set_scissor_rect(x, y, width, height);
                    draw_instances(pass, &self.instances("plot: shapes", &batch.shapes));
                }
            });
        };
        let [r, g, b] = [0, 1, 2].map(|channel| f64::from(linear(canvas.inks.paper[channel])));
        let (under, over) = canvas.batches.split_at(canvas.background);
        self.checked("background", || shapes(under, Some(wgpu::Color { r, g, b, a: 1.0 })))?;
        if let Some(content) = content
            && let Some(clip) = scissor(Some(content.area()), canvas)
        {
            content.draw(self, clip, &view)?;
        }
        self.checked("foreground", || shapes(over, None))?;
        readback::pixels(self.gpu, &target)
    }

    /// Uploads the glyphs, and the size of the picture.
    fn atlas(&self, canvas: &Canvas) -> Result<(wgpu::Buffer, wgpu::TextureView), PlotError> {
        let (width, height, coverage) = canvas.typesetter.atlas()?;
        // A texture has a row at least.
        let coverage = if height > 0 { coverage } else { &vec![0; width as usize] };
        let size = [width, height.max(1)];
        self.checked("type", || {
            let viewport = self.uniform("plot: viewport", &[canvas.width as f32, canvas.height as f32]);
            (viewport, self.filled_texture("plot: glyphs", size, wgpu::TextureFormat::R8Unorm, coverage))
        })
    }
}

/// A chart as a file of vector graphics, with a note that no picture shows. The same input gives the same bytes everywhere; no adapter is needed.
///
/// ```
/// use mesoscope::plot::{Chart, Panel, Series, vector_graphics};
/// use mesoscope::scene::{PlotStyle, VectorFormat};
///
/// let panel = Panel::new("x", "√x").with(Series::line("root", vec![[0.0, 0.0], [1.0, 1.0], [4.0, 2.0]]));
/// let chart = Chart { title: "A root".to_owned(), panels: vec![panel], ..Chart::default() };
/// let svg = vector_graphics(&chart, &PlotStyle::default(), VectorFormat::Svg, "")?;
/// assert!(svg.starts_with(b"<svg") && String::from_utf8_lossy(&svg).contains("<title>"));
/// assert!(vector_graphics(&chart, &PlotStyle::default(), VectorFormat::Pdf, "")?.starts_with(b"%PDF"));
/// # Ok::<(), mesoscope::plot::PlotError>(())
/// ```
///
/// # Errors
/// [`PlotError::Input`] if a series has errors but not one per point.
pub fn vector_graphics(
    chart: &Chart,
    style: &PlotStyle,
    format: VectorFormat,
    note: &str,
) -> Result<Vec<u8>, PlotError> {
    let canvas = chart_layout::lay_out(chart, style)?;
    Ok(match format {
        VectorFormat::Svg => vector::svg(&canvas, &chart.title, note).into_bytes(),
        VectorFormat::Pdf => vector::pdf(&canvas, &chart.title, note),
    })
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

fn shapes_pipeline(plotter: &Plotter<'_>) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32, 3 => Uint32, 4 => Unorm8x4];
    let entry_points = ["vertex_shape", "fragment_shape"];
    plotter.pipeline::<Shape>("plot: shapes", SHAPES, entry_points, &attributes, Target::Picture)
}
