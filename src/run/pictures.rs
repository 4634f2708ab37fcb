//! The pictures of a run, drawn from its tables and states.

use super::RunError;
use super::adapter::{open_adapter, plan_for};
use super::analyses::{self, mean};
use super::colour_ranges::ColourRanges;
use super::field_arrays;
use super::settling::is_about_equilibrium;
use super::views::Views;
use crate::engine::{Engine, Shown, Stepper};
use crate::families::{Checked, Model, PictureKind};
use crate::gpu::{AdapterChoice, Gpu};
use crate::output::{
    Checkpoint, Extent, Found, Id, OutputError, RunDirectory, Summary, checkpoint, exists, files, read_table,
};
use crate::plan::Options;
use crate::plot::{
    Averages, Chart, Mean, PlotError, energies_chart, means_note, missing_glyphs, snapshot_size, vector_graphics,
};
use crate::scene::{AnalysisTable, PlotStyle, Scene, VectorFormat, WrittenScene};
use crate::shaders::Array;
use crate::state::Reported;
use crate::table::Table;
use image::RgbaImage;
use std::path::Path;

/// Draws the pictures of a run again from the files it left, with changes to the look given as overrides of the scene
/// (`output.plot.width=800`), and those of its stages. Returns the names of the files written.
///
/// # Errors
/// [`RunError`] when there is no finished run in the directory, an override does not fit, or a picture cannot be drawn.
pub fn redraw(directory: &RunDirectory, choice: &AdapterChoice, overrides: &[String]) -> Result<Vec<String>, RunError> {
    let summary = Summary::load(&directory.file(files::SUMMARY))?;
    let text = serde_json::to_string(&summary.scene).unwrap_or_default();
    let name = directory.file(files::SUMMARY).display().to_string();
    let whole = WrittenScene::new(name, text).with(overrides).check_kept(None)?;
    let scene = whole.part_of(summary.steps)?;
    // The run's own scene for everything but the look.
    let checkpoint = checkpoint::load(&directory.file(files::CHECKPOINT))?;
    summary.check_run(checkpoint.run_id, &checkpoint.scene, &directory.file(files::SUMMARY))?;
    directory.check_run(checkpoint.run_id, files::CHECKPOINT)?;
    if checkpoint.state.step > summary.steps {
        let (directory, finished) = (directory.path().to_path_buf(), summary.steps);
        return Err(OutputError::Continued { directory, finished }.into());
    }
    summary.check_tables(directory)?;
    let own = checkpoint.scene.part_of(summary.steps)?;
    let model = own.model();
    let (gpu, _) = open_adapter(&own, choice, Options::default())?;
    let mut pictures = Pictures::again(&gpu, directory, &scene, &checkpoint);
    let table = super::energies::read(&directory.file(files::ENERGIES), &checkpoint.scene, summary.steps)?;
    pictures.energies(&table, model, &summary)?;
    let mut written = vec![files::ENERGIES_PLOT];
    written.extend(pictures.analyses(model, &summary, &|| Ok(()))?);
    let plan = plan_for(&own, &gpu, Options::default().with_room(model.particle_count()));
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
    let mut written: Vec<String> = written.into_iter().map(str::to_owned).collect();
    for ((number, stage), scene) in (1..).zip(&summary.stages).zip(whole.of_stages()) {
        if stage.directory.is_some() {
            let directory = directory.make_stage(number)?;
            let own = Summary::load(&directory.file(files::SUMMARY))?;
            own.check_tables(&directory)?;
            let mut pictures = Pictures::again(&gpu, &directory, &scene, &checkpoint);
            pictures.analyses(scene.model(), &own, &|| Ok(()))?;
            written.extend(pictures.written.iter().map(|name| format!("{}/{name}", files::stage(number))));
        }
    }
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
    directory: &'a RunDirectory,
    scene: &'a Scene,
    run: Id,
    views: Views<'a>,
    /// Names of the files written so far.
    written: Vec<String>,
    /// Arrays of the run so far; none where pictures alone are drawn again.
    arrays: Option<Vec<(String, Extent)>>,
    /// False if arrays are written and nothing is drawn.
    draws: bool,
}

impl<'a> Pictures<'a> {
    /// The pictures of a finished run, without its arrays.
    pub(super) fn again(gpu: &'a Gpu, directory: &'a RunDirectory, scene: &'a Scene, end: &Checkpoint) -> Self {
        let views = Views::new(gpu, scene, ColourRanges::restored(&end.sections));
        Self { directory, scene, run: end.run_id, views, written: Vec::new(), arrays: None, draws: true }
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
        self.views.ranges.sections()
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
        let averages = if self.has_means(model) { averages(summary, self.scene, model) } else { Averages::default() };
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
        let mut written = Vec::new();
        for shown in &pictures.fields {
            let range = self.views.range_of_field(shown, &asked);
            if self.draws {
                let name = files::field(shown.described.name, number, "png");
                let drawn = self.views.field(shown, &pictures, state, range, model);
                self.save(&name, drawn)?;
                written.push(name);
            }
        }
        for (name, held) in files::field_arrays(&asked, number) {
            let path = self.directory.file(&name);
            // Those that are there are the run's.
            if self.arrays.is_some() || !path.exists() {
                field_arrays::write(&path, &held, &pictures, self.scene, state.step, model.time.at(state.step))?;
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
        let drawn = self.views.draw(|plotter| plotter.draw_chart(chart, style));
        self.save(name, drawn)?;
        self.written.extend(save_vector(self.directory, name, self.run, chart, style)?);
        Ok(())
    }

    /// Draws the snapshot of a state, where there is more than a line.
    pub(super) fn snapshot(&mut self, name: &str, shown: &Shown, model: &Model) -> Result<(), RunError> {
        self.views.snapshot(shown, model).map_or(Ok(()), |drawn| self.save(name, drawn))
    }

    /// Writes a picture.
    fn save(&mut self, name: &str, drawn: Result<RgbaImage, PlotError>) -> Result<(), RunError> {
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

/// The means of a summary of a scene, or of its last stage, as charts take them.
fn averages(summary: &Summary, scene: &Scene, model: &Model) -> Averages {
    let means = summary.means.iter().filter_map(|(column, value)| {
        let unequilibrated = summary.unequilibrated.as_ref().is_some_and(|found| found.includes(column));
        Some((column.clone(), Mean { unequilibrated, ..mean(value)? }))
    });
    let from = Some(scene.time.equilibration).filter(|steps| *steps > 0).map(|step| model.time.at(step));
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;

    #[test]
    fn means_of_a_summary_stand_in_the_chart() {
        let scene = crate::scene::load("dpd-fluid", &[]).unwrap();
        let adapter = crate::output::summary::AdapterSummary::default();
        let mut summary = Summary::new(Id::of_run(&scene), scene.clone().into_scene(), adapter, 10);
        summary.add_mean("temperature", crate::measure::statistics::estimate(&[0.75, 1.25]).as_ref());
        summary.add_mean("pressure", None);
        let averages = averages(&summary, &scene, scene.model());
        assert_eq!(averages.from, Some(20.0));
        let [(column, mean)] = &averages.means[..] else { panic!("{averages:?}") };
        assert_eq!((column.as_str(), mean.value, mean.from_few_samples), ("temperature", 1.0, true));
    }
}
