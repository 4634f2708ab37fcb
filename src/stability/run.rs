//! A map of stability from its first scene to its page.

use super::bounds::bounds;
use super::cell::{Cell, evaluate, is_of_the_scene};
use super::summary::{MOST_EDGES, StabilitySummary};
use crate::families::Checked;
use crate::gpu::{AdapterChoice, AdapterKind, Gpu};
use crate::host_memory;
use crate::numbers::{self, short};
use crate::plan::{Hardware, Options};
use crate::run::{self, RunError};
use crate::study::{self, Observer, StudyError, StudyEvent, StudyOutcome, StudyRun, at_once};
use std::fmt;
use std::time::Instant;

/// A map to be made.
pub type StabilityRun = StudyRun<StabilitySummary>;

/// What follows once all scenes so far have ended: this number of scenes between them, which locate edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bisecting(pub usize);

impl fmt::Display for Bisecting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} more to locate edges", self.0)
    }
}

/// A scene to be run: its row and its value.
type Place = (usize, f64);

impl StudyRun<StabilitySummary> {
    /// Runs the scenes of the grid, then those that locate edges, and writes table, picture and page.
    ///
    /// # Errors
    /// [`StudyError`]. Scenes that become unstable are in the outcome.
    pub fn execute(
        mut self,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, StabilitySummary>,
    ) -> Result<StudyOutcome<StabilitySummary>, StudyError> {
        self.check_place()?;
        for (number, row) in self.summary.rows.iter_mut().enumerate() {
            // Also of a map that goes on: this version may know of other laws.
            [row.bounds, row.outside] = bounds(&self.request, number)?;
        }
        let mut waiting = self.waiting();
        let gpu = run::adapter_for(&self.request.base, adapter).map_err(|source| match source {
            RunError::Gpu(source) => source.into(),
            source => StudyError::of_run(&self.request.base.title, source),
        })?;
        // Beside those of the grid there may be so many that locate edges, in every row.
        let (bisections, points) = (self.request.arguments.bisections as usize, self.request.along.values.len());
        let more = (MOST_EDGES * bisections) as f64 / points.max(1) as f64;
        let scenes = waiting.iter().filter_map(|(row, value)| self.request.scene(*row, *value, 0).ok());
        let scenes: Vec<Checked> = scenes.collect();
        let seconds = self.expected(&scenes, &gpu).map(|seconds| (1.0 + more) * seconds);
        self.refuse_long(seconds.unwrap_or_default())?;
        self.check_memory(scenes.iter(), &gpu)?;
        let place = self.open_place()?;
        self.summary.adapter = Some(gpu.description().into());
        self.save()?;
        let largest = study::largest(scenes.iter()).unwrap_or(&self.request.base);
        // Seeds are side by side already.
        let at_once = if self.request.seeds() > 1 { 1 } else { self.request.cell_count() };
        let jobs = self.jobs_for(largest, at_once, &gpu);
        let together = self.replicas_for(largest, self.request.seeds() as usize, &gpu);
        observer(StudyEvent::Started { adapter: gpu.description(), runs: waiting.len(), at_once: jobs, seconds });
        while !waiting.is_empty() {
            self.run_all(&waiting, jobs, together, adapter, observer)?;
            waiting = self.waiting();
            if !waiting.is_empty() {
                observer(StudyEvent::Phase { phase: &Bisecting(waiting.len()), runs: waiting.len() });
            }
        }
        self.finish(&place, &gpu, observer)
    }

    /// Refuses seeds that do not fit into the memory of a software adapter, which is that of this machine.
    fn check_memory<'s>(&self, scenes: impl Iterator<Item = &'s Checked>, gpu: &Gpu) -> Result<(), StudyError> {
        let bytes = |scene: &Checked| run::plan(scene, Hardware::from(gpu), Options::default()).bytes();
        let needed = u64::from(self.request.seeds()) * scenes.map(bytes).max().unwrap_or(0);
        let Some(free) = host_memory::free().filter(|free| self.request.seeds() > 1 && needed > *free) else {
            return Ok(());
        };
        if gpu.description().kind != AdapterKind::Software {
            return Ok(());
        }
        let (seeds, [needed, free]) = (self.request.seeds(), [needed, free].map(numbers::bytes));
        Err(StudyError::mistake(format!(
            "{seeds} seeds side by side take {needed}, and {free} are free: fewer --seeds"
        )))
    }

    /// Scenes to be run next: those of the grid, or else those that locate edges.
    fn waiting(&self) -> Vec<Place> {
        let along = &self.request.along;
        let mut grid = self.request.places();
        grid.retain(|(row, value)| self.summary.rows[*row].cells.iter().all(|cell| cell.value != *value));
        if !grid.is_empty() {
            return grid;
        }
        let neighbours = along.values.windows(2).map(|pair| along.spacing.distance(pair[0], pair[1]));
        let spacing = neighbours.fold(f64::INFINITY, f64::min);
        // A little more, as values are rounded to four digits.
        let nearest = 1.01 * spacing / 2.0_f64.powi(self.summary.arguments.bisections as i32);
        let next = self.summary.rows.iter().map(|row| row.next(along.spacing, nearest));
        next.enumerate().flat_map(|(row, values)| values.into_iter().map(move |value| (row, value))).collect()
    }

    /// Seconds that scenes take at the speed of the scene as it is; none where its first steps fail.
    fn expected(&self, scenes: &[Checked], gpu: &Gpu) -> Option<f64> {
        // Scenes of a map are measured in memory.
        let base = self.request.base.clone().changed(|scene| scene.output = scene.output.energies_alone());
        let seconds = run::expected_time(&base, gpu).ok()?.seconds / base.time.steps.max(1) as f64;
        let seeds = f64::from(self.request.seeds());
        Some(seeds * seconds * scenes.iter().map(|scene| scene.time.steps as f64).sum::<f64>())
    }

    fn run_all(
        &mut self,
        places: &[Place],
        jobs: usize,
        together: usize,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, StabilitySummary>,
    ) -> Result<(), StudyError> {
        let (start, before) = (Instant::now(), self.summary.spent);
        let (request, interrupt, measures) =
            (self.request.clone(), self.interrupt().clone(), self.summary.measures.clone());
        let work = |(row, value): &Place, report: &(dyn Fn(Result<Option<Cell>, RunError>) + Sync)| {
            let arguments = &request.arguments;
            let ended = request.scenes(*row, *value).map_err(RunError::from);
            report(
                match ended
                    .and_then(|scenes| evaluate(*value, &scenes, &measures, arguments, together, adapter, &interrupt))
                {
                    Err(error) if is_of_the_scene(&error) => Ok(Some(Cell::refused(*value, error.to_string()))),
                    ended => ended,
                },
            );
        };
        at_once(places, jobs, &interrupt, work, |number, ended| {
            let (row, value) = places[number];
            let label = self.summary.rows[row].label.as_str();
            let row_name = if label.is_empty() { String::new() } else { format!("{label}, ") };
            match ended {
                Ok(Some(cell)) => {
                    observer(StudyEvent::Ended { run: &format!("{row_name}{}", short(value)), ended: &cell });
                    self.summary.rows[row].add(cell);
                    self.summary.spent = before + start.elapsed().as_secs_f64();
                    Ok(self.save()?)
                }
                Ok(None) => Ok(()),
                Err(source) => {
                    let key = request.short_keys().short(&request.along.key).to_owned();
                    Err(StudyError::of_run(&format!("{row_name}{key} = {value}"), source))
                }
            }
        })?;
        self.proceed()
    }
}
