//! The pictures of a run, drawn from its tables and states.

use super::RunError;
use super::shown_field::{ShownField, closed_loops};
use super::simulation::{mesh_depth, open_adapter, plan_for};
use crate::engine::Engine;
use crate::gpu::{AdapterChoice, Gpu};
use crate::measure::MeshFlow;
use crate::model::{Model, ShallowWater, Voronoi};
use crate::output::{OutputError, RunDirectory, Summary, Table, checkpoint, files, read_table, write_npy};
use crate::plan::Options;
use crate::plot::{
    Axis, CellPicture, Chart, EnergyTable, FieldPicture, Panel, ParticlePicture, PeriodicCurve, PlotError, Plotter,
    Series, ShownValues, autocorrelation_chart, chain_correlation_chart, chain_equilibrium_chart, chain_memory_chart,
    chain_profile_chart, chain_pulse_chart, circulation_chart, correlation_chart, energetic_cells_chart,
    energies_chart, grouped, histogram_chart, neighbours_chart, radial_distribution_chart, shallow_water_chart,
    shear_wave_chart,
};
use crate::scene::{self, Scene, SnapshotColor};
use crate::state::State;
use crate::tessellation::Tessellation;
use image::{
    DynamicImage, ExtendedColorType, ImageEncoder, RgbaImage,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};
use std::io;

/// Draws the pictures of a run again from the files it left, with changes to the look given as overrides of the scene
/// (`output.plot.width=800`). Returns the names of the files written.
///
/// # Errors
/// [`RunError`] when there is no finished run in the directory, an override does not fit, or a picture cannot be drawn.
pub fn redraw(
    directory: &RunDirectory,
    choice: &AdapterChoice,
    overrides: &[String],
) -> Result<Vec<&'static str>, RunError> {
    let summary = Summary::load(&directory.file(files::SUMMARY))?;
    let text = serde_json::to_string(&summary.scene).unwrap_or_default();
    let name = directory.file(files::SUMMARY).display().to_string();
    let scene = scene::parse(&name, &text, overrides)?;
    // The run's own scene for everything but the look.
    let checkpoint = checkpoint::load(&directory.file(files::CHECKPOINT))?;
    let model = Model::new(&checkpoint.scene);
    let gpu = open_adapter(&checkpoint.scene, &model, choice, Options::default())?;
    let mut pictures = Pictures::new(&gpu, directory, &scene);
    let table = super::energies::read(&directory.file(files::ENERGIES), &checkpoint.scene, summary.steps)?;
    pictures.energies(&EnergyTable { columns: table.columns, rows: table.rows }, &model)?;
    let mut written = vec![files::ENERGIES_PLOT];
    for (name, plot) in ANALYSES {
        if directory.file(name).exists() && pictures.analysis(name)? {
            written.push(plot);
        }
    }
    let plan = plan_for(&checkpoint.scene, &model, &gpu, Options::default().with_room(model.particle_count()));
    let mut engine = Engine::new(&gpu, plan, &checkpoint.state)?;
    let state = engine.reported()?;
    if let Some(water) = &model.shallow_water {
        let depth = mesh_depth(&mut engine, water)?;
        let names = pictures.fields(None, &state, &depth, &model, water)?;
        written.extend(files::ALL.into_iter().filter(|name| names.iter().any(|written| written == name)));
    } else {
        pictures.snapshot(files::SNAPSHOT, &state, &model)?;
        if model.units.dimension > 1 {
            written.push(files::SNAPSHOT);
        }
    }
    Ok(written)
}

/// Tables of analyses and their plots.
const ANALYSES: [(&str, &str); 16] = [
    (files::CHAIN_PROFILES, files::CHAIN_PROFILES_PLOT),
    (files::CHAIN_PULSE, files::CHAIN_PULSE_PLOT),
    (files::CHAIN_CORRELATION, files::CHAIN_CORRELATION_PLOT),
    (files::CHAIN_MEMORY, files::CHAIN_MEMORY_PLOT),
    (files::CHAIN_EQUILIBRIUM, files::CHAIN_EQUILIBRIUM_PLOT),
    (files::CIRCULATION, files::CIRCULATION_PLOT),
    (files::RADIAL_DISTRIBUTION, files::RADIAL_DISTRIBUTION_PLOT),
    (files::DIFFUSION, files::DIFFUSION_PLOT),
    (files::VISCOSITY, files::VISCOSITY_PLOT),
    (files::VELOCITY_AUTOCORRELATION, files::VELOCITY_AUTOCORRELATION_PLOT),
    (files::FORCE_AUTOCORRELATION, files::FORCE_AUTOCORRELATION_PLOT),
    (files::VELOCITY_HISTOGRAM, files::VELOCITY_HISTOGRAM_PLOT),
    (files::SPEED_HISTOGRAM, files::SPEED_HISTOGRAM_PLOT),
    (files::ACCELERATION_HISTOGRAM, files::ACCELERATION_HISTOGRAM_PLOT),
    (files::NEIGHBOURS, files::NEIGHBOURS_PLOT),
    (files::SHEAR_WAVE, files::SHEAR_WAVE_PLOT),
];

/// Draws into the directory of a run; pipelines are made with the first picture.
pub(super) struct Pictures<'a> {
    gpu: &'a Gpu,
    directory: &'a RunDirectory,
    scene: &'a Scene,
    plotter: Option<Plotter>,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(gpu: &'a Gpu, directory: &'a RunDirectory, scene: &'a Scene) -> Self {
        Self { gpu, directory, scene, plotter: None }
    }

    pub(super) fn energies(&mut self, table: &EnergyTable, model: &Model) -> Result<(), RunError> {
        if let Some(water) = &model.shallow_water {
            let set = water.bath.is_some().then_some(model.temperature);
            let mut chart = shallow_water_chart(&self.scene.title, table, set);
            chart.subtitle = format!(
                "{} particles, mesh {} × {}, time step {}",
                grouped(water.carriers),
                water.mesh[0],
                water.mesh[1],
                model.time_step
            );
            return self.chart(files::ENERGIES_PLOT, &chart);
        }
        if model.voronoi.as_ref().is_some_and(Voronoi::keeps_energy) {
            let mut chart = energetic_cells_chart(&self.scene.title, table, model.particle_count());
            chart.subtitle = format!("{} cells, time step {}", grouped(model.particle_count()), model.time_step);
            return self.chart(files::ENERGIES_PLOT, &chart);
        }
        let mut chart = energies_chart(&self.scene.title, table, model.particle_count(), model.temperature);
        chart.subtitle = format!("{}, time step {}", chart.subtitle, model.time_step);
        let temperatures = chart.panels.iter_mut().find(|panel| panel.y.label.starts_with("Temperature"));
        // Cells that warm up from rest are what their scene is about.
        if model.voronoi.is_none() && temperatures.is_some_and(show_settled) {
            chart.subtitle.push_str("; temperatures at the start are off the scale");
        }
        self.chart(files::ENERGIES_PLOT, &chart)
    }

    /// Draws the plots of all analyses whose tables are there.
    pub(super) fn analyses(&mut self) -> Result<(), RunError> {
        for (name, _) in ANALYSES {
            if self.directory.file(name).exists() {
                self.analysis(name)?;
            }
        }
        Ok(())
    }

    /// Draws the plot of one table; returns false when there is nothing in it.
    fn analysis(&mut self, name: &str) -> Result<bool, RunError> {
        let table = read_table(&self.directory.file(name))?;
        if table.rows.is_empty() {
            return Ok(false);
        }
        let column = |name: &str| table.column(name).unwrap_or_default();
        let title = &self.scene.title;
        if let Some((plot, chart)) = self.chain_chart(name, &table) {
            self.analysis_chart(name, &table, plot, &chart)?;
            return Ok(true);
        }
        let plot_of = |name: &str| ANALYSES.iter().find(|(table, _)| *table == name).map_or("", |(_, plot)| plot);
        let (plot, chart) = match name {
            files::RADIAL_DISTRIBUTION => (
                files::RADIAL_DISTRIBUTION_PLOT,
                radial_distribution_chart(title, &column("distance"), &column("radial_distribution")),
            ),
            files::DIFFUSION => {
                let [displacement, velocity] = ["mean_squared_displacement", "velocity_autocorrelation"].map(column);
                (files::DIFFUSION_PLOT, correlation_chart(title, &column("time"), &displacement, &velocity))
            }
            files::CIRCULATION => {
                let table = EnergyTable { columns: table.columns.clone(), rows: table.rows.clone() };
                (files::CIRCULATION_PLOT, circulation_chart(title, &table))
            }
            files::VELOCITY_AUTOCORRELATION | files::FORCE_AUTOCORRELATION => {
                let quantity = if name == files::FORCE_AUTOCORRELATION { "force" } else { "velocity" };
                let [lags, values, errors, fit] =
                    ["time", "autocorrelation", "autocorrelation_error", "fit"].map(column);
                (plot_of(name), autocorrelation_chart(title, quantity, &lags, &values, &errors, &fit))
            }
            files::VELOCITY_HISTOGRAM | files::SPEED_HISTOGRAM | files::ACCELERATION_HISTOGRAM => {
                (plot_of(name), density_chart(title, &table))
            }
            files::NEIGHBOURS => (plot_of(name), neighbours_chart(title, &copied(&table))),
            files::SHEAR_WAVE => {
                let subtitle = "velocity along x, projected on the wave that it started with";
                (plot_of(name), shear_wave_chart(title, subtitle, &copied(&table)))
            }
            _ => (files::VISCOSITY_PLOT, viscosity_chart(title, &table)),
        };
        self.analysis_chart(name, &table, plot, &chart)?;
        Ok(true)
    }

    /// Draws what a table with rows has to show: nothing, if its columns are not those that the run wrote.
    fn analysis_chart(&mut self, name: &str, table: &Table, plot: &str, chart: &Chart) -> Result<(), RunError> {
        if chart.panels.iter().flat_map(|panel| &panel.series).all(|series| series.points.is_empty()) {
            let problem = format!(
                "found the columns `{}`, none of which the run wrote; restore the file, or run the scene anew with --force",
                table.columns.join(",")
            );
            return Err(OutputError::Line { path: self.directory.file(name), line: 1, problem }.into());
        }
        self.chart(plot, chart)
    }

    /// The plot of a table of harmonic chains, if it is one.
    fn chain_chart(&self, name: &str, table: &Table) -> Option<(&'static str, Chart)> {
        let (plot, chart): (_, fn(&str, &str, &EnergyTable) -> Chart) = match name {
            files::CHAIN_PROFILES => (files::CHAIN_PROFILES_PLOT, chain_profile_chart),
            files::CHAIN_PULSE => (files::CHAIN_PULSE_PLOT, chain_pulse_chart),
            files::CHAIN_CORRELATION => (files::CHAIN_CORRELATION_PLOT, chain_correlation_chart),
            files::CHAIN_MEMORY => (files::CHAIN_MEMORY_PLOT, chain_memory_chart),
            files::CHAIN_EQUILIBRIUM => (files::CHAIN_EQUILIBRIUM_PLOT, chain_equilibrium_chart),
            _ => return None,
        };
        let subtitle = super::chain::subtitle(name, self.scene);
        let table = EnergyTable { columns: table.columns.clone(), rows: table.rows.clone() };
        Some((plot, chart(&self.scene.title, &subtitle, &table)))
    }

    pub(super) fn snapshot(&mut self, name: &str, state: &State, model: &Model) -> Result<(), RunError> {
        let units = model.units;
        if let Some(cells) = &model.voronoi {
            return self.cells(name, state, model, cells);
        }
        // Points on a line show nothing.
        if units.dimension == 1 {
            return Ok(());
        }
        let positions: Vec<[f64; 3]> = state.positions.iter().map(|position| units.position(*position)).collect();
        let by_speed = self.scene.output.snapshot.color == SnapshotColor::Speed;
        let speed = |(momentum, species): (&[i32; 3], &u32)| {
            let mass = model.species.get(*species as usize).map_or(f64::NAN, |species| species.mass);
            units.momentum(*momentum).iter().map(|component| component * component).sum::<f64>().sqrt() / mass
        };
        let speeds: Option<Vec<f64>> = by_speed.then(|| state.momenta.iter().zip(&state.species).map(speed).collect());
        let names: Vec<String> = model.species.iter().map(|species| species.name.clone()).collect();
        let subtitle = format!("t = {}", rounded(state.step as f64 * model.time_step));
        let picture = ParticlePicture {
            dimension: units.dimension as u32,
            lengths: units.lengths,
            positions: &positions,
            species: &state.species,
            species_names: &names,
            speeds: speeds.as_deref(),
            radius: self.scene.output.snapshot.radius.unwrap_or_else(|| radius(model)),
            title: &self.scene.title,
            subtitle: &subtitle,
        };
        let style = &self.scene.output.snapshot;
        let theme = self.scene.output.plot.theme;
        let drawn = self.plotter().and_then(|plotter| plotter.draw_particles(&picture, style, theme));
        self.save(name, drawn)
    }

    /// Draws Voronoi cells.
    fn cells(&mut self, name: &str, state: &State, model: &Model, cells: &Voronoi) -> Result<(), RunError> {
        let units = model.units;
        let lengths = [units.lengths[0], units.lengths[1]];
        let positions: Vec<[f64; 2]> =
            state.positions.iter().map(|position| units.position(*position)).map(|[x, y, _]| [x, y]).collect();
        let tessellation = Tessellation::of_fractions(lengths, &state.positions);
        let mass = |id: usize| f64::from(state.masses[id]) * cells.mass_unit;
        let square =
            |id: usize| units.momentum(state.momenta[id]).iter().map(|component| component * component).sum::<f64>();
        let all = 0..state.masses.len().min(state.len());
        let shown: Option<(&str, Vec<f64>)> = match self.scene.output.snapshot.color {
            SnapshotColor::Species => None,
            SnapshotColor::Speed => Some(("speed", all.map(|id| square(id).sqrt() / mass(id)).collect())),
            SnapshotColor::Temperature if cells.keeps_energy() => {
                let internal =
                    |id: usize| f64::from(state.energies[id]) * cells.energy_unit - square(id) / (2.0 * mass(id));
                let temperature = |id: usize| cells.molecular_mass * internal(id) / mass(id);
                Some(("temperature (kT)", all.map(temperature).collect()))
            }
            SnapshotColor::Density | SnapshotColor::Temperature => {
                Some(("density (mass/area)", all.map(|id| mass(id) / tessellation.cells[id].volume).collect()))
            }
        };
        let names: Vec<String> = model.species.iter().map(|species| species.name.clone()).collect();
        let subtitle = format!("t = {}", rounded(state.step as f64 * model.time_step));
        let picture = CellPicture {
            lengths,
            positions: &positions,
            tessellation: &tessellation,
            species: &state.species,
            species_names: &names,
            shown: shown.as_ref().map(|(label, values)| ShownValues { label, values }),
            title: &self.scene.title,
            subtitle: &subtitle,
        };
        let style = &self.scene.output.snapshot;
        let theme = self.scene.output.plot.theme;
        let drawn = self.plotter().and_then(|plotter| plotter.draw_cells(&picture, style, theme));
        self.save(name, drawn)
    }

    /// Draws the fields of shallow water that the scene asks for, and writes them as arrays. Returns the names.
    pub(super) fn fields(
        &mut self,
        number: Option<u64>,
        state: &State,
        depth: &[f64],
        model: &Model,
        water: &ShallowWater,
    ) -> Result<Vec<String>, RunError> {
        let flow = MeshFlow::new(model, water, state);
        let loops: Vec<Vec<[f64; 2]>> = closed_loops(state, model, water);
        let curves: Vec<PeriodicCurve<'_>> =
            loops.iter().map(|points| PeriodicCurve { points, closed: true }).collect();
        let mut written = Vec::new();
        for quantity in self.scene.output.fields.clone().unwrap_or_default().quantities {
            let shown = ShownField::new(quantity, &flow, depth);
            let field = shown.field(model, water);
            let subtitle = format!("t = {}", rounded(state.step as f64 * model.time_step));
            let picture = FieldPicture {
                title: &self.scene.title,
                subtitle: &subtitle,
                map: shown.map,
                curves: &curves,
                ..FieldPicture::new(&field)
            };
            let name = files::field(shown.stem, number, "png");
            let drawn = {
                let style = &self.scene.output.plot;
                self.plotter().and_then(|plotter| plotter.draw_field(&picture, style))
            };
            self.save(&name, drawn)?;
            written.push(name);
            let name = files::field(shown.stem, number, "npy");
            write_npy(&self.directory.file(&name), &field.nodes, &field.values)?;
            written.push(name);
        }
        Ok(written)
    }

    fn chart(&mut self, name: &str, chart: &Chart) -> Result<(), RunError> {
        let style = &self.scene.output.plot;
        let drawn = self.plotter().and_then(|plotter| plotter.draw_chart(chart, style));
        self.save(name, drawn)
    }

    fn plotter(&mut self) -> Result<&Plotter, PlotError> {
        let plotter = match self.plotter.take() {
            Some(plotter) => plotter,
            None => Plotter::new(self.gpu.device(), self.gpu.queue())?,
        };
        Ok(self.plotter.insert(plotter))
    }

    fn save(&self, name: &str, drawn: Result<RgbaImage, PlotError>) -> Result<(), RunError> {
        save(self.directory, name, drawn)
    }
}

/// A table as charts take it.
fn copied(table: &Table) -> EnergyTable {
    EnergyTable { columns: table.columns.clone(), rows: table.rows.clone() }
}

/// Writes a picture, which appears complete or not at all.
pub(crate) fn save(directory: &RunDirectory, name: &str, drawn: Result<RgbaImage, PlotError>) -> Result<(), RunError> {
    let image = drawn.map_err(|source| RunError::Plot { name: name.to_owned(), source })?;
    // Pictures are opaque. Level 4 takes a third of the time of the default and a twentieth more space.
    let image = DynamicImage::from(image).into_rgb8();
    directory.write(name, |writer| {
        PngEncoder::new_with_quality(writer, CompressionType::Level(4), FilterType::Adaptive)
            .write_image(image.as_raw(), image.width(), image.height(), ExtendedColorType::Rgb8)
            .map_err(io::Error::other)
    })?;
    Ok(())
}

/// The part of a run after which temperatures are expected to have settled.
const SETTLED: f64 = 0.1;

/// Gives a panel of temperatures the range that they have once the run has settled: where particles start at random
/// places, the configurational temperature begins at tens of kT, and on its scale nothing else could be read. Returns
/// whether anything is off that scale.
pub(crate) fn show_settled(panel: &mut Panel) -> bool {
    let points = || panel.series.iter().flat_map(|series| &series.points).filter(|point| point[1].is_finite());
    let end = points().map(|point| point[0]).fold(0.0, f64::max);
    let settled = points().filter(|point| point[0] >= SETTLED * end).map(|point| point[1]);
    let references = panel.references.iter().map(|reference| reference.value);
    let [low, high] =
        settled.chain(references).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
    let margin = 0.25 * (high - low);
    let range = [low - margin, high + margin];
    let off = points().any(|point| !(range[0]..=range[1]).contains(&point[1]));
    if off && margin > 0.0 {
        panel.y.range = Some(range);
    }
    off && margin > 0.0
}

/// A third of the cutoff, or, without one, of the distance between neighbours.
fn radius(model: &Model) -> f64 {
    let spacing = || {
        let volume = model.units.volume() / model.particle_count().max(1) as f64;
        volume.powf(1.0 / model.units.dimension as f64)
    };
    model.pair_force.as_ref().map_or_else(spacing, |force| force.cutoff) / 3.0
}

/// A time without the noise digits of a product: `0.3`, not `0.30000000000000004`.
fn rounded(time: f64) -> f64 {
    format!("{time:.12e}").parse().unwrap_or(time)
}

/// A histogram from its table: centres of bins, densities, counts, and the density to compare with.
fn density_chart(title: &str, table: &Table) -> Chart {
    let column = |index: usize| table.rows.iter().map(move |row| row.get(index).copied().unwrap_or(f64::NAN));
    let name = |index: usize| table.columns.get(index).map_or("", String::as_str);
    let centres: Vec<f64> = column(0).collect();
    // A single bin does not tell its width, but its density does, unless nothing was counted.
    let width = match centres.as_slice() {
        [first, .., last] => (last - first) / (centres.len() - 1) as f64,
        _ => 1.0 / column(1).sum::<f64>(),
    };
    let first = centres.first().map_or(0.0, |first| first - 0.5 * width);
    let edges: Vec<f64> = if width.is_finite() && width > 0.0 {
        (0..=centres.len()).map(|edge| first + edge as f64 * width).collect()
    } else {
        Vec::new()
    };
    let compared: Vec<[f64; 2]> = centres.iter().zip(column(3)).map(|(centre, density)| [*centre, density]).collect();
    let densities: Vec<f64> = column(1).collect();
    let label = match name(3) {
        "maxwell" => "Maxwell's density",
        _ => "Gaussian of the same variance",
    };
    histogram_chart(title, name(0), &edges, &densities, (label, &compared))
}

/// Autocorrelations of the transverse waves; on a logarithmic axis a viscous decay is a straight line.
fn viscosity_chart(title: &str, table: &Table) -> Chart {
    let mut panel = Panel::new("Lag (time units)", "Autocorrelation of transverse momentum waves");
    panel.y = Axis::log("Autocorrelation of transverse momentum waves");
    for wave in table.rows.chunk_by(|a, b| a[0] == b[0]) {
        let points = wave.iter().map(|row| [row[1], row[2]]).collect();
        panel.series.push(Series::line(&format!("k = {:.4}", wave[0][0]), points));
    }
    // A single series has no legend.
    let subtitle = match panel.series.as_slice() {
        [only] => only.name.clone(),
        _ => String::new(),
    };
    Chart { title: title.to_owned(), subtitle, panels: vec![panel] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_read_as_people_write_them() {
        assert_eq!(rounded(0.1 * 3.0).to_string(), "0.3");
        assert_eq!(rounded(1e-9 * 3.0).to_string(), "0.000000003");
        assert_eq!(rounded(80.0).to_string(), "80");
    }

    #[test]
    fn a_hot_start_does_not_set_the_scale() {
        let columns = ["time", "temperature"].map(str::to_owned).to_vec();
        let rows =
            (0..100).map(|row| vec![f64::from(row), if row == 0 { 30.0 } else { 1.0 + 0.1 * f64::from(row % 2) }]);
        let mut table = EnergyTable { columns, rows: rows.collect() };
        let mut chart = energies_chart("hot", &table, 1, 1.0);
        assert!(show_settled(&mut chart.panels[0]));
        assert_eq!(chart.panels[0].y.range, Some([1.0 - 0.25 * (1.1 - 1.0), 1.1 + 0.25 * (1.1 - 1.0)]));
        table.rows[0][1] = 1.0;
        let mut chart = energies_chart("settled", &table, 1, 1.0);
        assert!(!show_settled(&mut chart.panels[0]));
        assert_eq!(chart.panels[0].y.range, None);
    }

    #[test]
    fn every_wave_is_a_series() {
        let columns = ["wave_number", "time", "autocorrelation"].map(str::to_owned).to_vec();
        let rows = vec![vec![0.5, 0.0, 1.0], vec![0.5, 1.0, 0.8], vec![0.9, 0.0, 1.0]];
        let chart = viscosity_chart("waves", &Table { columns, rows });
        let series: Vec<(&str, usize)> =
            chart.panels[0].series.iter().map(|series| (series.name.as_str(), series.points.len())).collect();
        assert_eq!(series, [("k = 0.5000", 2), ("k = 0.9000", 1)]);
    }
}
