//! Pictures drawn off-screen by the GPU: charts of what was measured, snapshots of the particles or of
//! Voronoi cells, and fields on a mesh.
//!
//! A [`Chart`], a [`ParticlePicture`], a [`CellPicture`] or a [`FieldPicture`] is first laid out on the CPU as a list of shapes (lines, markers, letters),
//! which needs no device, and then painted by a [`Plotter`] in a few draw calls. Coverage and blending are computed in
//! linear light, so thin lines keep their weight on light and dark paper. Type and lines are sized for a picture that
//! is shown 16 cm wide, whatever its number of pixels; [`PlotStyle::scale`](crate::scene::PlotStyle::scale) changes that.
//!
//! ```no_run
//! use mesoscope::plot::{Chart, Panel, Plotter, Series};
//! # fn device() -> (wgpu::Device, wgpu::Queue) { unimplemented!() }
//! let (device, queue) = device();
//! let points = (0..100).map(|i| [f64::from(i), f64::from(i).sqrt()]).collect();
//! let panel = Panel::new("time", "distance").with(Series::line("root", points));
//! let chart = Chart { title: "A square root".into(), subtitle: String::new(), panels: vec![panel] };
//! let picture = Plotter::new(&device, &queue)?.draw_chart(&chart, &Default::default())?;
//! picture.save("root.png")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod canvas;
mod cells;
mod chain_charts;
mod chart;
mod chart_layout;
mod color_map;
mod error;
mod field;
mod field_renderer;
mod overlay;
mod palette;
mod particles;
mod periodic_curve;
mod presets;
mod renderer;
mod series_path;
mod snapshot_page;
mod text;
mod ticks;
mod voronoi_charts;

pub use cells::{CellPicture, ShownValues};
pub use chain_charts::{
    chain_correlation_chart, chain_equilibrium_chart, chain_memory_chart, chain_profile_chart, chain_pulse_chart,
};
pub use chart::{Axis, Chart, Panel, ReferenceLine, Scale, Series, SeriesInk, SeriesStyle};
pub use color_map::ColorMap;
pub use error::PlotError;
pub use field::{FieldPicture, Interpolation, PeriodicCurve};
pub use overlay::{Curve, overlay_chart, quantity_label};
pub use particles::ParticlePicture;
pub use presets::{
    EnergyTable, autocorrelation_chart, circulation_chart, correlation_chart, energies_chart, histogram_chart,
    radial_distribution_chart, shallow_water_chart,
};
pub use renderer::Plotter;
pub use voronoi_charts::{energetic_cells_chart, neighbours_chart, shear_wave_chart};

use crate::scene::{PlotStyle, Snapshot, Theme};
use image::RgbaImage;

/// Draws one chart; [`Plotter`] is cheaper for several.
///
/// # Errors
/// See [`Plotter::draw_chart`].
pub fn draw_chart(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    chart: &Chart,
    style: &PlotStyle,
) -> Result<RgbaImage, PlotError> {
    Plotter::new(device, queue)?.draw_chart(chart, style)
}

/// Draws one picture of the particles; [`Plotter`] is cheaper for several.
///
/// # Errors
/// See [`Plotter::draw_particles`].
pub fn draw_particles(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    picture: &ParticlePicture<'_>,
    style: &Snapshot,
    theme: Theme,
) -> Result<RgbaImage, PlotError> {
    Plotter::new(device, queue)?.draw_particles(picture, style, theme)
}

/// Draws one picture of a field; [`Plotter`] is cheaper for several.
///
/// # Errors
/// See [`Plotter::draw_field`].
pub fn draw_field(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    picture: &FieldPicture<'_>,
    style: &PlotStyle,
) -> Result<RgbaImage, PlotError> {
    Plotter::new(device, queue)?.draw_field(picture, style)
}
