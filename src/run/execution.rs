//! A run under way: from one event to the next, and its files.

use super::analyses::{Analyses, Setting};
use super::conservation::{conserved, not_conserved};
use super::energies::{self, EnergyRecorder};
use super::frame::with_flow;
use super::kept_sums::{self, KeptSums, Sharing};
use super::pace::{self, Pace};
use super::pictures::{Pictures, mesh_depth, most_shown};
use super::schedule::Schedule;
use super::sections::Sections;
use super::tally::Carried;
use super::task::Task;
use super::{Event, Progress, RunError};
use crate::engine::{EngineError, Sample, Shown, Stepper};
use crate::families::{Checked, KeptQuantity, PictureKind};
use crate::gpu::Gpu;
use crate::measure::observables_of;
use crate::measure::statistics::Estimate;
use crate::output::summary::{
    AdapterSummary, ColumnSummary, MeshSummary, NumberedFrame, RanksSummary, StageSummary, StartSummary,
};
use crate::output::{
    Checkpoint, Extent, OutputError, RunDirectory, Summary, TrajectoryWriter, checkpoint, exists, files, own_file,
};
use crate::ranks::{computes_alike, remedy};
use crate::scene::TrajectoryFormat;
use crate::state::State;
use serde_json::Map;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

/// What a run leaves.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// What `run.json` says.
    pub summary: Summary,
    /// Names of the files of this run that are in its directory, sorted; numbered snapshots are counted instead.
    pub files: Vec<&'static str>,
    /// Number of numbered snapshots.
    pub snapshots: u64,
}

/// A run under way: its open files and what it has gathered.
pub(super) struct Execution<'a> {
    task: &'a Task,
    /// The scene of the part in which all numbers are constant.
    pub scene: &'a Checked,
    /// The first step of the stage.
    first: u64,
    gpu: &'a Gpu,
    directory: &'a RunDirectory,
    schedule: Schedule,
    pub energies: EnergyRecorder,
    analyses: Analyses,
    carried: Carried,
    pub kept_sums: KeptSums,
    trajectory: Option<TrajectoryWriter>,
    /// The trajectory of earlier stages, where this one has none.
    idle: Vec<(String, Extent)>,
    pictures: Pictures<'a>,
    /// What was done to the scene before the run.
    pub notices: &'a [String],
    /// The ranks that share the run, if there are several.
    pub ranks: Option<RanksSummary>,
    /// Step of the checkpoint on disk.
    pub saved_step: u64,
    /// When it was written.
    saved_at: Instant,
}

impl<'a> Execution<'a> {
    /// Creates the files of a run at step 0, or cuts them back to what was there before the step of `start`.
    pub(super) fn open(
        task: &'a Task,
        gpu: &'a Gpu,
        engine: &mut dyn Stepper,
        start: &Checkpoint,
    ) -> Result<Self, RunError> {
        let Task { id, directory, .. } = task;
        let step = start.state.step;
        let scene = &task.parts[task.part_at(step)];
        let model = scene.model();
        let ends = task.scene.ends_of_stages();
        let first = ends.into_iter().rev().find(|end| *end <= model.time.step).unwrap_or_default();
        let path = directory.file(files::CHECKPOINT);
        let sections = Sections::new(&path, step, &start.sections);
        // What is wrong with the checkpoint is found before a file is touched.
        let of_stage = sections.of_stage(first);
        let analyses = Analyses::new(&Setting { scene, plan: engine.plan() }, &of_stage)?;
        analyses.continue_windows(engine, &of_stage)?;
        let carried = Carried::new(model, &sections)?;
        let ranks = engine.ranks();
        let sharing = Sharing { strict: ranks.len() > 1 && !task.mixed, mixed: !computes_alike(ranks) };
        let kept_sums = KeptSums::new(model, &start.state, &sections, sharing)?;
        let schedule = Schedule::new(scene, analyses.state_intervals());
        let written = |name: &str| match start.files.iter().find(|(known, _)| known == name) {
            // At step 0 there is nothing yet.
            _ if step == 0 => Ok(None),
            Some((_, extent)) => Ok(Some(*extent)),
            None => Err(sections.malformed(format!("it does not list `{name}`"))),
        };
        // Nothing is cut back where not everything can be continued.
        for (name, _) in start.files.iter().filter(|(name, _)| step > 0 && !files::is_array(name)) {
            let path = directory.file(name);
            own_file::check_to_continue(&path).map_err(OutputError::io("continue", &path))?;
        }
        let table = directory.file(files::ENERGIES);
        let energies = EnergyRecorder::open(&table, scene, &task.parts, written(files::ENERGIES)?, &of_stage)?;
        let is_trajectory =
            |(name, _): &&(String, Extent)| TrajectoryFormat::ALL.map(files::trajectory).contains(&name.as_str());
        let mut idle: Vec<_> = start.files.iter().filter(is_trajectory).cloned().collect();
        let trajectory = match &scene.output.trajectory {
            None => None,
            Some(asked) => {
                let name = files::trajectory(asked.format);
                let path = directory.file(name);
                // A stage may be the first to write one.
                let begins = step == first && idle.is_empty();
                idle.clear();
                let trajectory = match if begins { None } else { written(name)? } {
                    None => TrajectoryWriter::create(&path, asked.format, model, *id)?,
                    Some(written) => TrajectoryWriter::resume(&path, asked.format, model, *id, written)?,
                };
                Some(trajectory.of_species(&asked.species))
            }
        };
        let pictures = Pictures::new(gpu, directory, scene, start, task.draws)?;
        directory.remove_snapshots_after(schedule.snapshots_before(step))?;
        Ok(Self {
            task,
            scene,
            first,
            gpu,
            directory,
            schedule,
            energies,
            analyses,
            carried,
            kept_sums,
            trajectory,
            idle,
            pictures,
            notices: &[],
            ranks: None,
            saved_step: step,
            saved_at: Instant::now(),
        })
    }

    /// Advances to the end of the part, whose step belongs to the next one if there is one.
    pub(super) fn advance_to_end(
        &mut self,
        engine: &mut dyn Stepper,
        start: &mut Checkpoint,
        pace: &mut Pace,
        observer: &mut dyn FnMut(Event<'_>),
    ) -> Result<(), RunError> {
        let begun = pace.done().0;
        let first = engine.step();
        // Kernels may have been compiled until now.
        pace.begin();
        self.visit(engine, pace)?;
        // What a run goes back to is on the disk from now on, and need not be in memory.
        start.state = State::default();
        while engine.step() < self.scene.time.steps {
            let event = self.schedule.next(engine.step());
            pace::advance(engine, pace, event, &mut |engine, pace, advanced| {
                let samples = engine.take_samples();
                self.record(&samples, engine)?;
                self.energies.file.flush()?;
                advanced?;
                observer(Event::Advanced(self.progress(first, begun, pace)));
                // Here nothing has been added yet of what is due at this step.
                // The end is that of the run or belongs to the next part, which save it.
                let is_within = engine.step() < self.scene.time.steps;
                let interrupted = is_within && self.task.interrupt.is_asked();
                if interrupted || is_within && self.schedule.checkpoint_after(self.saved_at.elapsed()) {
                    self.save(engine, pace)?;
                }
                if interrupted {
                    self.obey()?;
                }
                Ok::<_, RunError>(ControlFlow::Continue(()))
            })?;
            if engine.step() < self.scene.time.steps || self.is_last() {
                self.visit(engine, pace)?;
            }
            observer(Event::Advanced(self.progress(first, begun, pace)));
        }
        Ok(())
    }

    /// True in the last part.
    pub(super) fn is_last(&self) -> bool {
        self.scene.time.steps == self.task.scene.time.steps
    }

    /// Stops if the run is asked to. What is not saved is lost.
    fn obey(&self) -> Result<(), RunError> {
        self.task.obey(self.saved_step)
    }

    /// Does what is due at the current step: a checkpoint, then the samples, then pictures and frames.
    fn visit(&mut self, engine: &mut dyn Stepper, pace: &mut Pace) -> Result<(), RunError> {
        let step = engine.step();
        // Where a stage begins is a checkpoint, as the start is.
        if self.schedule.checkpoint(step) || step == self.first {
            self.save(engine, pace)?;
        }
        let last = step == self.task.scene.time.steps;
        if self.saved_step == step {
            // Whatever follows can be done later too.
            self.obey()?;
        }
        // A report moves the particles of split steps on.
        let frame = self.schedule.frame(step).then(|| engine.frame());
        let samples = if frame.is_some() { engine.take_samples() } else { Vec::new() };
        self.record(&samples, engine)?;
        let frame = frame.transpose()?;
        let samples = engine.finish()?;
        pace.finished();
        self.record(&samples, engine)?;
        self.energies.file.flush()?;
        if let (Some(mut frame), Some(trajectory)) = (frame, &mut self.trajectory) {
            with_flow(&mut frame, self.scene);
            trajectory.append(&frame)?;
            trajectory.flush()?;
            engine.keep_alive();
        }
        let number = self.schedule.snapshot(step);
        let taken = self.analyses.take_state(step);
        let fields = self.scene.model().picture() == PictureKind::Fields;
        let is_shown = (number.is_some() || last) && (fields || self.task.draws && !self.scene.output.snapshot.is_off);
        if is_shown || taken {
            let most = most_shown(self.scene);
            let all = if taken { Shown::all(engine.reported()?) } else { engine.shown(most)? };
            let state = &all.state;
            let setting = Setting { scene: self.scene, plan: engine.plan() };
            self.analyses.add_state(state, &setting);
            if fields && is_shown {
                let depth = mesh_depth(engine, self.scene.model())?;
                for number in number.map(Some).into_iter().chain(last.then_some(None)) {
                    self.pictures.fields(number, state, &depth, self.scene.model())?;
                    engine.keep_alive();
                }
            } else if is_shown {
                let shown = if all.numbers.is_some() { all } else { Shown::of(all.state, most) };
                if let Some(number) = number {
                    self.pictures.snapshot(&files::snapshot(number), &shown, self.scene.model())?;
                    engine.keep_alive();
                }
                if last {
                    self.pictures.snapshot(files::SNAPSHOT, &shown, self.scene.model())?;
                }
            }
        }
        Ok(())
    }

    /// Saves a checkpoint.
    fn save(&mut self, engine: &mut dyn Stepper, pace: &mut Pace) -> Result<(), RunError> {
        let Checkpoint { run_id, scene, state, files: written, sections } = self.checkpoint(engine, pace)?;
        checkpoint::save(&self.directory.file(files::CHECKPOINT), run_id, &scene, &state, &written, &sections)?;
        engine.keep_alive();
        self.saved_step = state.step;
        self.saved_at = Instant::now();
        pace.begin();
        Ok(())
    }

    /// A checkpoint of the current step.
    pub(super) fn checkpoint(&mut self, engine: &mut dyn Stepper, pace: &mut Pace) -> Result<Checkpoint, RunError> {
        let state = engine.state();
        pace.finished();
        let samples = engine.take_samples();
        self.record(&samples, engine)?;
        let state = state?;
        // The checkpoint counts on what is in the files before its step.
        self.energies.file.sync()?;
        if let Some(trajectory) = &mut self.trajectory {
            trajectory.flush()?;
        }
        engine.keep_alive();
        let [mut sections, of_states] = self.analyses.sections();
        sections.extend(self.analyses.open_windows(engine)?);
        if !self.notices.is_empty() {
            sections.push((NOTICES.to_owned(), serde_json::json!(self.notices).to_string().into_bytes()));
        }
        sections.push((energies::SECTION.to_owned(), self.energies.section()));
        sections.extend(of_states);
        sections.extend(self.kept_sums.sections());
        sections.extend(self.pictures.sections());
        sections.extend(self.carried.section(self.scene.model(), engine)?);
        let mut written = vec![(files::ENERGIES.to_owned(), self.energies.file.extent())];
        if let (Some(trajectory), Some(asked)) = (&self.trajectory, &self.scene.output.trajectory) {
            written.push((files::trajectory(asked.format).to_owned(), trajectory.extent()));
        }
        written.extend_from_slice(&self.idle);
        written.extend_from_slice(self.pictures.arrays());
        let (run_id, scene) = (self.task.id, self.task.scene.clone());
        Ok(Checkpoint { run_id, scene, state, files: written, sections })
    }

    /// The beginning of the part that follows.
    pub(super) fn hand_over(&mut self, engine: &mut dyn Stepper, pace: &mut Pace) -> Result<Checkpoint, RunError> {
        let mut next = self.checkpoint(engine, pace)?;
        let ends = self.task.scene.ends_of_stages();
        if let Some(number) = ends.iter().position(|end| *end == next.state.step)
            && !self.scene.output.analyses().is_empty()
        {
            self.conclude_stage(number, &next, engine)?;
        }
        let following = &self.task.parts[self.task.part_at(next.state.step)];
        // Numbers may decide what is kept.
        let kept = |scene: &Checked| scene.model().physics().kept(scene.model(), &next.state).len();
        if kept(self.scene) != kept(following) {
            let fresh = KeptSums::new(
                following.model(),
                &next.state,
                &Sections::new(Path::new(""), 0, &[]),
                self.kept_sums.sharing(),
            )?;
            next.sections.retain(|(name, _)| name != kept_sums::SECTION);
            next.sections.extend(fresh.sections());
        }
        if following.model().follows_paths(&following.output) && next.state.images.is_empty() {
            next.state.images = vec![[0; 3]; next.state.len()];
        }
        Ok(next)
    }

    /// Leaves what analyses of a stage have found in a directory of its own: tables, pictures and a summary.
    fn conclude_stage(&self, number: usize, end: &Checkpoint, engine: &dyn Stepper) -> Result<(), RunError> {
        let directory = self.directory.make_stage(number)?;
        let adapter = AdapterSummary::from(self.gpu.description());
        let model = self.scene.model();
        let mut summary = Summary::new(self.task.id, self.scene.clone().into_scene(), adapter, model.particle_count());
        summary.steps = end.state.step;
        self.energies.summarise(&mut summary);
        let setting = Setting { scene: self.scene, plan: engine.plan() };
        // What comes next may take long, and the stage is concluded again if the run stops before it is done.
        let go_on = || {
            engine.keep_alive();
            self.obey()
        };
        self.analyses.conclude(&setting, &directory, &mut summary, &go_on)?;
        summary.tables = directory.tables()?;
        if self.task.draws {
            Pictures::again(self.gpu, &directory, self.scene, end).analyses(model, &summary, &go_on)?;
        } else {
            directory.remove_last_pictures()?;
        }
        let path = directory.file(files::SUMMARY);
        // Written first, for it is one of its files.
        summary.save(&path)?;
        summary.files = Some(directory.written());
        Ok(summary.save(&path)?)
    }

    fn record(&mut self, samples: &[Sample], engine: &dyn Stepper) -> Result<(), RunError> {
        let setting = Setting { scene: self.scene, plan: engine.plan() };
        for sample in samples {
            if sample.sampler == 0 {
                self.kept_sums.compare(sample);
                if let Some(reason) = self.kept_sums.refused() {
                    let reason = format!("{reason}: the ranks do not compute alike{}", remedy(engine.ranks()));
                    return Err(EngineError::Ranks { reason }.into());
                }
                let mut observables = observables_of(sample, engine.plan(), self.scene.model());
                self.carried.complete(self.scene.model(), &mut observables);
                self.energies.add(&observables)?;
            } else {
                self.analyses.add(sample, &setting);
            }
        }
        Ok(())
    }

    fn progress(&self, first: u64, begun: u64, pace: &Pace) -> Progress {
        let rate = pace.rate().unwrap_or(0.0);
        let last_step = self.task.scene.time.steps;
        let step = first + pace.done().0 - begun;
        let left = last_step.saturating_sub(step) as f64 / rate;
        Progress {
            step,
            last_step,
            particle_steps_per_second: rate * self.scene.model().particle_count() as f64,
            remaining: Duration::try_from_secs_f64(left).ok(),
            temperature: self.energies.temperature(),
        }
    }

    /// Writes tables, summary and plots; `engine` has come to the end.
    pub(super) fn conclude(
        mut self,
        engine: &dyn Stepper,
        warnings: Vec<String>,
        (steps, spent): (u64, Duration),
    ) -> Result<Outcome, RunError> {
        let (task, saved_step) = (self.task, self.saved_step);
        // What comes next may take long.
        let go_on = || {
            engine.keep_alive();
            task.obey(saved_step)
        };
        let adapter = AdapterSummary::from(self.gpu.description());
        let mut summary = Summary::new(
            self.task.id,
            self.task.scene.clone().into_scene(),
            adapter,
            self.scene.model().particle_count(),
        );
        summary.start = StartSummary::new(self.scene);
        let model = self.scene.model();
        summary.columns.insert(files::ENERGIES.to_owned(), ColumnSummary::of_energies(model));
        // Parts of a run without pictures left none.
        let fields = self.scene.output.fields.clone().unwrap_or_default();
        let is_there = |number: u64| match model.picture() {
            PictureKind::Fields => {
                files::field_arrays(&fields, Some(number)).iter().any(|(name, _)| self.directory.file(name).exists())
            }
            _ => self.directory.file(&files::snapshot(number)).exists(),
        };
        let numbered = self.schedule.numbered().filter(|(number, _)| is_there(*number));
        let time_of = |step| task.time_of(step);
        let frame = |(number, step)| NumberedFrame { number, step, time: time_of(step) };
        summary.numbered = numbered.map(frame).collect();
        if let Some((nodes, quantities)) = model.physics().fields(self.scene) {
            for (name, held) in files::field_arrays(&fields, None) {
                let described = quantities.iter().filter(|known| held.iter().any(|field| field.stem() == known.name));
                let columns = described.map(|quantity| ColumnSummary::new(quantity.name, quantity, 2)).collect();
                summary.columns.insert(name, columns);
            }
            summary.mesh = Some(MeshSummary::new(nodes, [model.units.lengths[0], model.units.lengths[1]]));
        }
        let last_step = self.task.scene.time.steps;
        summary.set_duration(last_step, steps, spent.as_secs_f64());
        if let Some(earlier) = self.task.earlier.as_deref().filter(|earlier| steps == 0 && earlier.steps == last_step) {
            // What is added here took no step.
            summary.wall_seconds = earlier.wall_seconds;
            summary.particle_steps_per_second = earlier.particle_steps_per_second;
        }
        let composition = self.scene.composition().into_iter();
        summary.composition = composition.map(|(name, text)| format!("{name}: {text}")).collect();
        summary.warnings = warnings;
        summary.ranks = self.ranks.take();
        self.energies.summarise(&mut summary);
        summary.stages = self.stages(&mut summary);
        let setting = Setting { scene: self.scene, plan: engine.plan() };
        self.analyses.conclude(&setting, self.directory, &mut summary, &go_on)?;
        let changed = self.kept_sums.lost();
        let lost: Vec<KeptQuantity> = changed.iter().map(|(quantity, _)| *quantity).collect();
        summary.conserved_exactly = conserved(self.scene.model(), &lost, self.kept_sums.mixed);
        summary.not_conserved = not_conserved(self.scene.model(), &changed);
        summary.tables = self.directory.tables()?;
        summary.tables.extend(self.pictures.arrays().iter().cloned());
        // Numbers first: they are worth more than pictures if the disk is full.
        let path = self.directory.file(files::SUMMARY);
        summary.save(&path)?;
        go_on()?;
        if self.task.draws {
            self.pictures.energies(&self.energies.rows.table(), self.scene.model(), &summary)?;
            self.pictures.analyses(self.scene.model(), &summary, &go_on)?;
        } else {
            // Those that are there show an earlier end.
            self.directory.remove_last_pictures()?;
        }
        engine.keep_alive();
        // What was moved away or replaced under way is not what `run.json` speaks of.
        self.energies.file.check()?;
        if let Some(trajectory) = &self.trajectory {
            trajectory.check()?;
        }
        self.pictures.check()?;
        exists(&self.directory.file(files::CHECKPOINT))?;
        summary.files = Some(self.directory.written());
        summary.save(&path)?;
        let written = files::all().filter(|name| self.directory.file(name).exists()).collect();
        Ok(Outcome { summary, files: written, snapshots: self.directory.snapshots()? })
    }
}

impl Execution<'_> {
    /// The stages of the run, if it has some; what is to be known of the analyses of earlier ones is among the warnings of the summary.
    fn stages(&self, summary: &mut Summary) -> Vec<StageSummary> {
        let (task, ends) = (self.task, self.task.scene.ends_of_stages());
        let stages = (1..).zip(&task.scene.stages).zip(ends.windows(2));
        let described = stages.map(|((number, stage), ends)| {
            let [first_step, last_step] = [ends[0], ends[1]];
            let mut described = StageSummary {
                first_step,
                last_step,
                times: [first_step, last_step].map(|step| task.time_of(step)),
                set: stage.set.clone(),
                ramp: stage.ramp.clone(),
                push_off: stage.push_off,
                means: summary.means.clone(),
                directory: None,
                results: Map::new(),
            };
            if last_step == task.scene.time.steps {
                return described;
            }
            let mean =
                |(name, mean): (&str, Option<Estimate>)| (name.to_owned(), summary.mean_with_unit(name, mean.as_ref()));
            described.means = self.energies.rows.means_of(first_step..last_step).into_iter().map(mean).collect();
            let of_stage = stage.output(&task.scene.output, false).unwrap_or_default();
            if of_stage.analyses().is_empty() {
                return described;
            }
            let name = files::stage(number);
            match Summary::load(&self.directory.file(&name).join(files::SUMMARY)) {
                Ok(own) if own.run_id == task.id => {
                    described.directory = Some(name);
                    described.results = own.results;
                    summary.warnings.extend(own.warnings.iter().map(|warning| format!("stage {number}: {warning}")));
                }
                _ => summary.warnings.push(format!(
                    "stage {number}: no results of its analyses in `{name}`: the files were moved, or the stage was cut short"
                )),
            }
            described
        });
        described.collect()
    }
}

/// Name of the section of a checkpoint that holds what was done to the scene before the run.
pub(super) const NOTICES: &str = "notices";
