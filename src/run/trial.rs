//! A run in memory, of which nothing but the table of energies is kept.

use super::adapter::plan_for;
use super::energy_rows::EnergyRows;
use super::pace::Pace;
use super::{Interrupt, RunError};
use crate::engine::{Engine, EngineError, Sample};
use crate::families::{self, Checked, Instability};
use crate::gpu::Gpu;
use crate::measure::observables_of;
use crate::measure::statistics::Estimate;
use crate::plan::Options;
use crate::state::State;
use crate::table::Table;

/// A run without files, which can be made longer.
pub(crate) struct Trial<'a> {
    gpu: &'a Gpu,
    scene: Checked,
    options: Options,
    engine: Engine<'a>,
    rows: EnergyRows,
    /// Where to begin again if an array turns out too small.
    saved: State,
    pace: Pace,
}

/// How far a trial came.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Stop {
    /// To the step that was asked for.
    Reached,
    /// It became unstable, for this reason.
    Unstable(String),
    /// It was asked to stop.
    Interrupted,
}

impl<'a> Trial<'a> {
    /// A trial of a scene at its start.
    ///
    /// # Errors
    /// [`RunError`] if the adapter cannot run it.
    pub(crate) fn new(gpu: &'a Gpu, scene: &Checked) -> Result<Self, RunError> {
        let scene = scene.clone().changed(|scene| scene.output = scene.output.energies_alone());
        let state = families::initial_state(&scene);
        families::check_start(&scene, &state)?;
        let (engine, options) = open(gpu, &scene, &state, Options::default())?;
        let rows = EnergyRows::new(&scene);
        let pace = Pace::new(scene.model().particle_count(), engine.plan().operations_per_particle);
        Ok(Self { gpu, scene, options, engine, rows, saved: state, pace })
    }

    /// Goes on until a step, which has a row.
    ///
    /// # Errors
    /// [`RunError`] if the adapter fails. A run that becomes unstable is no error.
    pub(crate) fn advance(&mut self, last: u64, interrupt: &Interrupt) -> Result<Stop, RunError> {
        loop {
            match self.advance_once(last, interrupt) {
                Err(EngineError::Crowded { .. }) if self.options.has_room_left() => {
                    // From where it was, with more room, as a run does.
                    let options = self.options.with_room(self.scene.model().particle_count());
                    (self.engine, self.options) = open(self.gpu, &self.scene, &self.saved, options)?;
                }
                Err(EngineError::Unstable(failure)) => {
                    let reason = Instability::new(&failure, self.engine.plan(), self.scene.model());
                    return Ok(Stop::Unstable(format!("{} at step {}", reason.quantity, reason.step)));
                }
                Err(error @ EngineError::GaveUp { .. }) => return Ok(Stop::Unstable(error.to_string())),
                Err(error) => return Err(error.into()),
                Ok(false) => return Ok(Stop::Interrupted),
                Ok(true) if self.engine.step() >= last => return Ok(Stop::Reached),
                Ok(true) => {}
            }
        }
    }

    /// Some steps, after which all rows are known: whether nobody asked to stop.
    fn advance_once(&mut self, last: u64, interrupt: &Interrupt) -> Result<bool, EngineError> {
        self.pace.begin();
        let mut left = (last - self.engine.step().min(last)).min(STEPS_BETWEEN_STATES);
        while left > 0 {
            if interrupt.is_asked() {
                return Ok(false);
            }
            let steps = self.pace.batch().min(left);
            self.engine.advance(steps, steps)?;
            self.pace.submitted(steps);
            left -= steps;
        }
        // A state can be read before the samples of its step are taken.
        self.saved = self.engine.state()?;
        let samples = self.engine.take_samples();
        self.add(&samples);
        let samples = self.engine.finish()?;
        self.add(&samples);
        self.pace.finished();
        Ok(true)
    }

    /// Adds rows; what is repeated has some already.
    fn add(&mut self, samples: &[Sample]) {
        for sample in samples.iter().filter(|sample| sample.sampler == 0) {
            if self.rows.last_step().is_none_or(|step| sample.step > step) {
                self.rows.add(&observables_of(sample, self.engine.plan(), self.scene.model()));
            }
        }
    }

    /// The step that it has come to.
    pub(crate) fn step(&self) -> u64 {
        self.engine.step()
    }

    /// The means of the table of energies after equilibration.
    pub(crate) fn means(&self) -> Vec<(&'static str, Option<Estimate>)> {
        self.rows.means()
    }

    /// The rows of the table of energies after equilibration.
    pub(crate) fn settled(&self) -> Table {
        self.rows.settled()
    }

    /// The table of energies.
    pub(crate) fn table(&self) -> Table {
        self.rows.table()
    }
}

/// Steps that are repeated at most where an array turns out too small.
const STEPS_BETWEEN_STATES: u64 = 4096;

/// An engine with as much room as its first state needs.
fn open<'a>(
    gpu: &'a Gpu,
    scene: &Checked,
    state: &State,
    mut options: Options,
) -> Result<(Engine<'a>, Options), RunError> {
    loop {
        match Engine::new(gpu, plan_for(scene, gpu, options), state) {
            Err(EngineError::Crowded { .. }) if options.has_room_left() => {
                options = options.with_room(scene.model().particle_count());
            }
            opened => return Ok((opened?, options)),
        }
    }
}
