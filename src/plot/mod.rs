//! Pictures drawn off-screen by the GPU: charts of what was measured, snapshots of the particles or of
//! Voronoi cells, and fields on a mesh.
//!
//! A [`Chart`], a [`ParticlePicture`], a [`CellPicture`] or a [`FieldPicture`] is first laid out on the CPU as a list of shapes (lines, markers, letters),
//! which needs no device, and then painted by a [`Plotter`] in a few draw calls. Coverage and blending are computed in
//! linear light, so thin lines keep their weight on light and dark paper. Type and lines are sized for a picture that
//! is shown 16 cm wide, whatever its number of pixels; [`PlotStyle::scale`](crate::scene::PlotStyle::scale) changes that.
//!
//! ```
//! use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
//! use mesoscope::plot::{Chart, Panel, Plotter, Series};
//! use mesoscope::scene::PlotStyle;
//!
//! let points = (0..100).map(|i| [f64::from(i), f64::from(i).sqrt()]).collect();
//! let panel = Panel::new("time", "distance").with(Series::line("root", points));
//! let chart = Chart { title: "A square root".to_owned(), panels: vec![panel], ..Chart::default() };
//!
//! let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
//! let style = PlotStyle { width: 640, height: Some(400), ..PlotStyle::default() };
//! let picture = Plotter::new(&gpu)?.draw_chart(&chart, &style)?;
//! assert_eq!(picture.dimensions(), (640, 400));
//! # let directory = tempfile::tempdir()?;
//! # let path = directory.path().join("root.png");
//! picture.save(&path)?;
//! assert_eq!(image::open(&path)?.into_rgba8(), picture);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis_range;
mod canvas;
mod cell_charts;
mod cells;
mod chain_charts;
mod chart;
mod chart_axes;
mod chart_labels;
mod chart_layout;
mod chart_legend;
mod chart_series;
mod coincidence;
mod color_map;
mod error;
mod field;
mod field_renderer;
mod overlay;
mod palette;
mod particles;
mod periodic;
mod pipelines;
mod points;
mod presets;
mod profile_charts;
mod quantities;
mod readback;
mod renderer;
mod series_look;
mod series_path;
mod sheet;
mod snapshot_page;
mod species_colours;
mod sphere_renderer;
mod stress_charts;
mod text;
mod ticks;
mod transport_charts;
mod vector;

pub use cell_charts::{neighbours_chart, shear_wave_chart};
pub use cells::{CellPicture, ShownValues};
pub use chain_charts::{
    chain_correlation_chart, chain_equilibrium_chart, chain_memory_chart, chain_profile_chart, chain_pulse_chart,
};
pub use chart::{Axis, AxisFit, Chart, Mean, Panel, ReferenceLine, Scale, Series, SeriesInk, SeriesStyle};
pub use color_map::ColorMap;
pub use error::PlotError;
pub use field::{FieldPicture, Interpolation, PeriodicCurve};
pub(crate) use overlay::overlay_chart;
pub use particles::ParticlePicture;
pub(crate) use particles::snapshot_size;
pub use presets::{autocorrelation_chart, circulation_chart, histogram_chart, radial_distribution_chart};
pub use profile_charts::{ProfiledSpecies, profiles_chart};
pub use quantities::{Averages, energies_chart};
pub(crate) use quantities::{UNEQUILIBRATED, capitalised, means_note, quantity_label};
pub use renderer::{Plotter, vector_graphics};
pub(crate) use sheet::{Sheet, SheetInk, SheetType};
pub use stress_charts::{stress_chart, stress_correlation_chart};
pub use text::missing_glyphs;
pub use transport_charts::{ChainKind, chain_sizes_chart, diffusion_chart, viscosity_chart};
