//! The pictures of a run, drawn from its tables and states.

use super::RunError;
use super::adapter::{open_adapter, plan_for};
use super::analyses::{self, mean};
use super::colour_ranges::{self, ColourRanges};
use super::field_arrays;
use super::settling::is_about_equilibrium;
use crate::engine::{Engine, Shown, Stepper};
use crate::families::pictures::{CellValues, ValueScale};
use crate::families::{Checked, Model, PictureKind};
use crate::gpu::{AdapterChoice, Gpu};
use crate::numbers::grouped;
use crate::output::{
    Checkpoint, Extent, Found, Id, OutputError, RunDirectory, Summary, checkpoint, exists, files, read_table,
};
use crate::plan::Options;
use crate::plot::{
    Averages, CellPicture, Chart, ColorMap, FieldPicture, Mean, ParticlePicture, PeriodicCurve, PlotError, Plotter,
    ShownValues, energies_chart, means_note, missing_glyphs, snapshot_size, vector_graphics,
};
use crate::printable;
use crate::scene::{
    AnalysisTable, PlotStyle, Scene, Snapshot, SnapshotColor, SnapshotSlice, VectorFormat, WrittenScene,
};
use crate::shaders::Array;
use crate::state::{Reported, crossings};
use crate::table::Table;
use crate::tessellation::Tessellation;
use image::RgbaImage;
use std::path::Path;

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
    let scene = WrittenScene::new(name, text).with(overrides).check_kept(None)?;
    // The run's own scene for everything but the look.
    let checkpoint = checkpoint::load(&directory.file(files::CHECKPOINT))?;
    summary.check_run(checkpoint.run_id, &checkpoint.scene, &directory.file(files::SUMMARY))?;
    directory.check_run(checkpoint.run_id, files::CHECKPOINT)?;
    if checkpoint.state.step > summary.steps {
        let (directory, finished) = (directory.path().to_path_buf(), summary.steps);
        return Err(OutputError::Continued { directory, finished }.into());
    }
    summary.check_tables(directory)?;
    let model = checkpoint.scene.model();
    let (gpu, _) = open_adapter(&checkpoint.scene, choice, Options::default())?;
    let mut pictures = Pictures::again(&gpu, directory, &scene, &checkpoint);
    let table = super::energies::read(&directory.file(files::ENERGIES), &checkpoint.scene, summary.steps)?;
    pictures.energies(&table, model, &summary)?;
    let mut written = vec![files::ENERGIES_PLOT];
    written.extend(pictures.analyses(model, &summary, &|| Ok(()))?);
    let plan = plan_for(&checkpoint.scene, &gpu, Options::default().with_room(model.particle_count()));
    let mut engine = Engine::new(&gpu, plan, &checkpoint.state)?;
    if model.picture() == PictureKind::Fields {
        let state = engine.reported()?;
        let depth = mesh_depth(&mut engine, model)?;
        let names = pictures.fields(None, &state, &depth, model)?;
        written.extend(files::all().filter(|name| names.iter().any(|written| written == name)));
    } else if !scene.output.snapshot.is_off {
        let shown = engine.shown(most_shown(&scene))?;
        pictures.snapshot(files::SNAPSHOT, &shown, model)?;
        if model.units.dimension > 1 {
            written.push(files::SNAPSHOT);
        }
    }
    let is_vector = |name: &&str| !name.ends_with("png") && pictures.written.iter().any(|written| written == name);
    written.extend(files::all().filter(|name| !written.contains(name)).filter(is_vector).collect::<Vec<_>>());
    Ok(written)
}

/// The smoothed depth on the nodes of the mesh, right after a report.
pub(super) fn mesh_depth(engine: &mut dyn Stepper, model: &Model) -> Result<Vec<f64>, RunError> {
    let words = engine.words(Array::Depths)?;
    Ok(words.iter().take(model.physics().nodes() as usize).map(|word| 1.0 + f64::from(f32::from_bits(*word))).collect())
}

/// Particles that a picture shows; of more a sample. A particle covers a pixel and a half at least, so that it is as full as with all.
pub(super) fn most_shown(scene: &Checked) -> u64 {
    const LEAST: u64 = 1 << 22;
    let model = scene.model();
    if model.picture() != PictureKind::Particles {
        return u64::MAX;
    }
    let [width, height] =
        snapshot_size(&scene.output.snapshot, model.units.dimension as u32, model.edges_with_layers());
    LEAST.max((8.0 * width * height) as u64)
}

/// Draws into the directory of a run; pipelines are made with the first picture.
pub(super) struct Pictures<'a> {
    gpu: &'a Gpu,
    directory: &'a RunDirectory,
    scene: &'a Scene,
    run: Id,
    ranges: ColourRanges,
    plotter: Option<Plotter<'a>>,
    /// Names of the files written so far.
    written: Vec<String>,
    /// Arrays of the run so far; none where pictures alone are drawn again.
    arrays: Option<Vec<(String, Extent)>>,
    /// False if arrays are written and nothing is drawn.
    draws: bool,
}

impl<'a> Pictures<'a> {
    /// The pictures of a finished run, without its arrays.
    fn again(gpu: &'a Gpu, directory: &'a RunDirectory, scene: &'a Scene, end: &Checkpoint) -> Self {
        let (run, ranges) = (end.run_id, ColourRanges::restored(&end.sections));
        Self { gpu, directory, scene, run, ranges, plotter: None, written: Vec::new(), arrays: None, draws: true }
    }

    /// The pictures and arrays of a run from its beginning, or continued from a checkpoint.
    ///
    /// # Errors
    /// [`OutputError::Altered`] names the first array that is not the one the run wrote.
    pub(super) fn new(
        gpu: &'a Gpu,
        directory: &'a RunDirectory,
        scene: &'a Scene,
        start: &Checkpoint,
        draws: bool,
    ) -> Result<Self, OutputError> {
        let is_array = |(name, _): &&(String, Extent)| files::snapshot_number(name).is_some();
        let arrays: Vec<_> = start.files.iter().filter(is_array).cloned().collect();
        for (name, extent) in &arrays {
            let path = directory.file(name);
            // Those of earlier steps may have been moved elsewhere.
            if path.exists() && extent.find_in(&path)? != Found::Whole {
                return Err(OutputError::Altered { path });
            }
        }
        Ok(Self { arrays: Some(arrays), draws, ..Self::again(gpu, directory, scene, start) })
    }

    /// Arrays of the run so far, which have no place for its id.
    pub(super) fn arrays(&self) -> &[(String, Extent)] {
        self.arrays.as_deref().unwrap_or_default()
    }

    /// What a checkpoint has to keep.
    pub(super) fn sections(&self) -> Vec<(String, Vec<u8>)> {
        self.ranges.sections()
    }

    /// Looks whether everything that was written is still there.
    ///
    /// # Errors
    /// [`OutputError::Lost`] names the first file that is not.
    pub(super) fn check(&self) -> Result<(), OutputError> {
        self.written.iter().try_for_each(|name| exists(&self.directory.file(name)))
    }

    /// Draws the table of energies with the means of a summary.
    pub(super) fn energies(&mut self, table: &Table, model: &Model, summary: &Summary) -> Result<(), RunError> {
        let mut of = model.physics().energy_chart(model);
        of.subtitle = format!("{}, time step {}", of.subtitle, model.time_step);
        let averages = if self.has_means(model) { averages(summary) } else { Averages::default() };
        let chart = energies_chart(&self.scene.title, table, &of, &averages);
        self.chart(files::ENERGIES_PLOT, &chart)
    }

    /// True if means over time with errors say something: of a stationary random process, not of a flow or of motion
    /// that is exact.
    fn has_means(&self, model: &Model) -> bool {
        is_about_equilibrium(self.scene, model) && !model.physics().is_conservative(model)
    }

    /// Draws the plots of all analyses whose tables are there and not empty, with the results of a summary, and returns their names;
    /// `proceed` says before each whether to.
    pub(super) fn analyses(
        &mut self,
        model: &Model,
        summary: &Summary,
        proceed: &dyn Fn() -> Result<(), RunError>,
    ) -> Result<Vec<&'static str>, RunError> {
        let mut drawn = Vec::new();
        for (id, place, AnalysisTable { file, plot, .. }) in analyses::tables() {
            proceed()?;
            let path = self.directory.file(file);
            if !path.exists() {
                continue;
            }
            let table = read_table(&path)?;
            if table.rows.is_empty() {
                continue;
            }
            let mut chart = analyses::chart(id, place, &table, self.scene, model, &summary.results);
            // Nothing, if its columns are not those that the run wrote.
            if chart.panels.iter().flat_map(|panel| &panel.series).all(|series| series.points.is_empty()) {
                let problem = format!(
                    "found the columns `{}`, none of which the run wrote; restore the file, or run the scene again with --force",
                    table.columns.join(",")
                );
                return Err(OutputError::Line { path, line: 1, problem }.into());
            }
            self.note_means(&mut chart, model);
            self.chart(plot, &chart)?;
            drawn.push(plot);
        }
        Ok(drawn)
    }

    /// Says below the title of a chart what its means are of, or leaves them out.
    fn note_means(&self, chart: &mut Chart, model: &Model) {
        let mut series = chart.panels.iter_mut().flat_map(|panel| &mut panel.series);
        if !self.has_means(model) {
            series.for_each(|series| series.mean = None);
            return;
        }
        let means: Vec<Mean> = series.by_ref().filter_map(|series| series.mean).collect();
        let part = if self.scene.time.equilibration > 0 { "after equilibration" } else { "of the whole run" };
        let notes = [std::mem::take(&mut chart.subtitle), means_note(means, part)];
        chart.subtitle = notes.into_iter().filter(|note| !note.is_empty()).collect::<Vec<_>>().join("; ");
    }

    pub(super) fn snapshot(&mut self, name: &str, shown: &Shown, model: &Model) -> Result<(), RunError> {
        let (units, state) = (model.units, &shown.state);
        if model.picture() == PictureKind::Cells {
            return self.cells(name, state, model);
        }
        // Points on a line show nothing.
        if units.dimension == 1 {
            return Ok(());
        }
        // With layers of frozen particles the picture shows what is behind the walls too.
        let (edges, lengths) = (units.edges(), model.edges_with_layers());
        let place = |position: &[u32; 3]| {
            let place = units.position(*position);
            std::array::from_fn(|axis| place[axis] + 0.5 * (lengths[axis] - edges[axis]))
        };
        let asked = &self.scene.output.snapshot;
        let is_shown = |name: &String| asked.species.is_empty() || asked.species.contains(name);
        let of_species: Vec<bool> = model.species.iter().map(|species| is_shown(&species.name)).collect();
        let mut particles: Vec<usize> =
            (0..state.len()).filter(|&index| of_species.get(state.species[index] as usize) == Some(&true)).collect();
        let sampled = particles.len() as u64;
        if let Some(slice) = asked.slice {
            let axis = slice.axis as usize;
            let is_walled = model.particles().walls.iter().any(|walls| walls.axis == axis);
            let period = (!is_walled).then_some(edges[axis]);
            particles.retain(|&index| slice.holds(units.position(state.positions[index])[axis], period));
        }
        let positions: Vec<[f64; 3]> = particles.iter().map(|&index| place(&state.positions[index])).collect();
        let species: Vec<u32> = particles.iter().map(|&index| state.species[index]).collect();
        let by_speed = self.scene.output.snapshot.color == SnapshotColor::Speed;
        let speed = |&index: &usize| {
            let mass = model.species[state.species[index] as usize].mass;
            units.momentum(state.momenta[index]).iter().map(|component| component * component).sum::<f64>().sqrt()
                / mass
        };
        let speeds: Option<Vec<f64>> = by_speed.then(|| particles.iter().map(speed).collect());
        let names: Vec<String> = model.species.iter().map(|species| species.name.clone()).collect();
        let mut subtitle = at_time(state, model);
        if shown.numbers.is_some() {
            let all: u64 =
                model.species.iter().filter(|species| is_shown(&species.name)).map(|species| species.count).sum();
            let [some, all] = [sampled, all].map(grouped);
            subtitle = format!("{subtitle}; {some} of {all} particles");
        }
        if let Some(SnapshotSlice { axis, position, thickness }) = asked.slice {
            subtitle = format!("{subtitle}; slice at {} = {position} ± {}", axis.name(), rounded(0.5 * thickness));
        }
        if !asked.species.is_empty() {
            let names: Vec<_> = asked.species.iter().map(|name| printable::name(name)).collect();
            subtitle = format!("{subtitle}; {} only", names.join(", "));
        }
        let range = speeds.as_ref().map(|speeds| {
            let begin = || colour_ranges::of_speeds(speeds, model.temperature, lightest(model));
            self.ranges.of("speed", asked.range, begin)
        });
        let bonds: Vec<[u32; 2]> = match &model.particles().bonds {
            Some(bonds) if asked.bonds => {
                // A rod knows no copy that is displaced.
                let across = |ends: [usize; 2]| {
                    let [a, b] = ends.map(|end| state.positions[end]);
                    model.particles().shear.is_some_and(|shear| crossings(a, b)[shear.gradient] != 0)
                };
                let ends =
                    bonds.iter().filter_map(|bond| Some([shown.place(bond.ends[0])?, shown.place(bond.ends[1])?]));
                let place = |index: usize| particles.binary_search(&index).ok().map(|place| place as u32);
                let drawn = ends.filter(|ends| !across(*ends));
                drawn.filter_map(|ends| Some([place(ends[0])?, place(ends[1])?])).collect()
            }
            _ => Vec::new(),
        };
        let picture = ParticlePicture {
            dimension: units.dimension as u32,
            lengths,
            positions: &positions,
            species: &species,
            species_names: &names,
            speeds: speeds.as_deref(),
            bonds: &bonds,
            radius: self.scene.output.snapshot.radius.unwrap_or_else(|| radius(model)),
            title: &self.scene.title,
            subtitle: &subtitle,
        };
        let style = Snapshot { range, ..asked.clone() };
        let theme = self.scene.output.plot.theme;
        self.draw(name, |plotter| plotter.draw_particles(&picture, &style, theme))
    }

    /// Draws the cells of a tessellation.
    fn cells(&mut self, name: &str, state: &Reported, model: &Model) -> Result<(), RunError> {
        let units = model.units;
        let lengths = [units.lengths[0], units.lengths[1]];
        let positions: Vec<[f64; 2]> =
            state.positions.iter().map(|position| units.position(*position)).map(|[x, y, _]| [x, y]).collect();
        let tessellation = Tessellation::of_fractions(lengths, &state.positions);
        let color = self.scene.output.snapshot.color;
        let shown = model.physics().cell_values(color, state, &tessellation, model);
        let names: Vec<String> = model.species.iter().map(|species| species.name.clone()).collect();
        let subtitle = at_time(state, model);
        let asked = &self.scene.output.snapshot;
        let temperature = model.temperature;
        let begin = |shown: &CellValues| match shown.scale {
            ValueScale::Speeds => colour_ranges::of_speeds(&shown.values, temperature, lightest(model)),
            ValueScale::Temperatures => colour_ranges::of_temperatures(&shown.values, temperature),
            ValueScale::Densities { mean, molecules } => {
                colour_ranges::of_densities(&shown.values, mean, molecules, temperature > 0.0)
            }
        };
        // A picture alone has the colours that fit it best.
        let range = match &shown {
            Some(shown) if asked.every > 0 => Some(self.ranges.of(shown.label, asked.range, || begin(shown))),
            _ => asked.range,
        };
        let picture = CellPicture {
            lengths,
            positions: &positions,
            tessellation: &tessellation,
            species: &state.species,
            species_names: &names,
            shown: shown.as_ref().map(|shown| ShownValues { label: shown.label, values: &shown.values }),
            title: &self.scene.title,
            subtitle: &subtitle,
        };
        let style = Snapshot { range, ..asked.clone() };
        let theme = self.scene.output.plot.theme;
        self.draw(name, |plotter| plotter.draw_cells(&picture, &style, theme))
    }

    /// Draws the fields on the mesh that the scene asks for, and writes the arrays of a run. Returns the names.
    pub(super) fn fields(
        &mut self,
        number: Option<u64>,
        state: &Reported,
        depth: &[f64],
        model: &Model,
    ) -> Result<Vec<String>, RunError> {
        let asked = self.scene.output.fields.clone().unwrap_or_default();
        let pictures = model.physics().mesh_pictures(&asked.quantities, state, depth, model);
        let Some(pictures) = pictures else { return Ok(Vec::new()) };
        let curves: Vec<PeriodicCurve<'_>> =
            pictures.loops.iter().map(|points| PeriodicCurve { points, closed: true }).collect();
        let mut written = Vec::new();
        for shown in &pictures.fields {
            let field = &shown.field;
            let subtitle = at_time(state, model);
            let given = asked.ranges.of(shown.quantity);
            let extrema = field.extrema();
            let range = if asked.every > 0 {
                Some(self.ranges.of(shown.described.name, given, || colour_ranges::of_field(extrema, shown.from_zero)))
            } else {
                given
            };
            // Pictures of one range have one map.
            let [low, high] = range.or(extrema).unwrap_or_default();
            let centre = shown.centre.filter(|centre| low < *centre && *centre < high);
            let picture = FieldPicture {
                title: &self.scene.title,
                subtitle: &subtitle,
                map: centre.map_or(ColorMap::Sequential, |centre| ColorMap::Diverging { centre }),
                range,
                curves: &curves,
                ..FieldPicture::new(field)
            };
            let name = files::field(shown.described.name, number, "png");
            let style = &self.scene.output.plot;
            if self.draws {
                self.draw(&name, |plotter| plotter.draw_field(&picture, style))?;
                written.push(name);
            }
        }
        for (name, held) in files::field_arrays(&asked, number) {
            let path = self.directory.file(&name);
            // Those that are there are the run's.
            if self.arrays.is_some() || !path.exists() {
                field_arrays::write(&path, &held, &pictures, self.scene, state.step)?;
                if let Some(arrays) = &mut self.arrays {
                    arrays.push((name.clone(), Extent::of(&path)?));
                }
                self.written.push(name.clone());
                written.push(name);
            }
        }
        Ok(written)
    }

    fn chart(&mut self, name: &str, chart: &Chart) -> Result<(), RunError> {
        let style = &self.scene.output.plot;
        self.draw(name, |plotter| plotter.draw_chart(chart, style))?;
        self.written.extend(save_vector(self.directory, name, self.run, chart, style)?);
        Ok(())
    }

    /// Draws and writes a picture.
    fn draw(
        &mut self,
        name: &str,
        draw: impl FnOnce(&Plotter<'_>) -> Result<RgbaImage, PlotError>,
    ) -> Result<(), RunError> {
        let plotter = match self.plotter.take() {
            Some(plotter) => Ok(plotter),
            None => Plotter::new(self.gpu),
        };
        let drawn = plotter.and_then(|plotter| draw(self.plotter.insert(plotter)));
        save(self.directory, name, self.run, drawn)?;
        self.written.push(name.to_owned());
        Ok(())
    }
}

/// Writes a chart in the formats of vector graphics that a style asks for, beside its picture, and returns the names; those of other formats show an
/// earlier chart, and are removed.
pub(crate) fn save_vector(
    directory: &RunDirectory,
    picture: &str,
    id: Id,
    chart: &Chart,
    style: &PlotStyle,
) -> Result<Vec<String>, RunError> {
    let mut written = Vec::new();
    for format in VectorFormat::ALL {
        let name = Path::new(picture).with_extension(format.extension()).to_string_lossy().into_owned();
        if style.vector.contains(&format) {
            let note = format!("{} {id}", id.key());
            let drawn = vector_graphics(chart, style, format, &note);
            let bytes = drawn.map_err(|source| RunError::Plot { name: name.clone(), source })?;
            directory.write(&name, |writer| writer.write_all(&bytes))?;
            written.push(name);
        } else {
            directory.remove_file(&name)?;
        }
    }
    Ok(written)
}

/// Writes a picture, which appears complete or not at all.
pub(crate) fn save(
    directory: &RunDirectory,
    name: &str,
    id: Id,
    drawn: Result<RgbaImage, PlotError>,
) -> Result<(), RunError> {
    let image = drawn.map_err(|source| RunError::Plot { name: name.to_owned(), source })?;
    Ok(directory.write_picture(name, id, image)?)
}

/// The means of a summary, as charts take them.
fn averages(summary: &Summary) -> Averages {
    let means = summary.means.iter().filter_map(|(column, value)| {
        let unequilibrated = summary.unequilibrated.as_ref().is_some_and(|found| found.includes(column));
        Some((column.clone(), Mean { unequilibrated, ..mean(value)? }))
    });
    let time = &summary.scene.time;
    let from = (time.equilibration > 0).then_some(time.equilibration as f64 * time.step);
    Averages { from, means: means.collect() }
}

/// What to know about letters of a scene that no picture shows.
///
/// ```
/// use mesoscope::{run, scene};
///
/// let scene = scene::load("dpd-fluid", &["title=Flow of ∇水".to_owned()])?;
/// assert!(run::lettering(&scene).is_some_and(|warning| warning.contains("∇水")));
/// assert_eq!(run::lettering(&*scene::load("dpd-fluid", &[])?), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn lettering(scene: &Scene) -> Option<String> {
    let names = scene.particles.iter().map(|group| group.species.as_str());
    let text: String = std::iter::once(scene.title.as_str()).chain(names).collect();
    let missing = missing_glyphs(&text);
    (!missing.is_empty())
        .then(|| format!("the font of the pictures has no `{missing}`: `title` and names show hollow boxes there"))
}

/// The time of a state.
fn at_time(state: &Reported, model: &Model) -> String {
    format!("t = {} time units", rounded(state.step as f64 * model.time_step))
}

/// Mass of the lightest species that has particles.
fn lightest(model: &Model) -> f64 {
    let masses = model.species.iter().filter(|species| species.count > 0).map(|species| species.mass);
    masses.fold(f64::INFINITY, f64::min)
}

/// A third of the largest cutoff, or, without one, of the distance between neighbours.
fn radius(model: &Model) -> f64 {
    let spacing = || {
        let volume = model.units.volume() / model.particle_count().max(1) as f64;
        volume.powf(1.0 / model.units.dimension as f64)
    };
    model.particles().pair_force.as_ref().map_or_else(spacing, |force| force.cutoff) / 3.0
}

/// A time without the noise digits of a product: `0.3`, not `0.30000000000000004`.
fn rounded(time: f64) -> f64 {
    format!("{time:.12e}").parse().unwrap_or(time)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;

    #[test]
    fn times_read_as_people_write_them() {
        assert_eq!(rounded(0.1 * 3.0).to_string(), "0.3");
        assert_eq!(rounded(1e-9 * 3.0).to_string(), "0.000000003");
        assert_eq!(rounded(80.0).to_string(), "80");
    }

    #[test]
    fn means_of_a_summary_stand_in_the_chart() {
        let scene = crate::scene::load("dpd-fluid", &[]).unwrap();
        let mut summary =
            Summary::new(Id::of_run(&scene), scene.into_scene(), crate::output::summary::AdapterSummary::default(), 10);
        summary.add_mean("temperature", crate::measure::statistics::estimate(&[0.75, 1.25]).as_ref());
        summary.add_mean("pressure", None);
        let averages = averages(&summary);
        assert_eq!(averages.from, Some(20.0));
        let [(column, mean)] = &averages.means[..] else { panic!("{averages:?}") };
        assert_eq!((column.as_str(), mean.value, mean.from_few_samples), ("temperature", 1.0, true));
    }
}
