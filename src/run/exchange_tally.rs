//! What the device counts of Voronoi cells from the upload of a state on, carried over from checkpoint to checkpoint.

use super::RunError;
use super::sections::{Sections, bytes};
use crate::engine::{Control, Engine};
use crate::measure::Observables;
use crate::output::checkpoint::CheckpointError;
use std::mem::{offset_of, size_of};

/// Name of the section of a checkpoint.
pub(super) const SECTION: &str = "exchanges";

/// Words of `iterations` and `residual` in the struct of `common/solver.wgsl`.
const ITERATIONS: usize = 2;
const RESIDUAL: usize = 8;
/// Residuals are reported in units of this.
const RESIDUAL_UNITS: f64 = (1_u64 << 40) as f64;

/// Counts at the state that a run began with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ExchangeTally {
    step: u64,
    limited: u64,
    iterations: u64,
    residual: f64,
}

impl ExchangeTally {
    /// The counts at a step, from the sections of its checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] where there are no such counts.
    pub(super) fn new(sections: &Sections<'_>) -> Result<Self, CheckpointError> {
        let step = sections.step;
        Ok(match sections.numbers(SECTION, 3)?.as_deref() {
            Some([limited, iterations, residual]) => {
                Self { step, limited: *limited as u64, iterations: *iterations as u64, residual: *residual }
            }
            _ => Self { step, ..Self::default() },
        })
    }

    /// Completes what was measured: counts begin with the upload, and at that step no solution is known to the device.
    pub(super) fn complete(&self, observables: &mut Observables) {
        let Some(cells) = &mut observables.cells else { return };
        cells.limited_exchanges = cells.limited_exchanges.saturating_add(self.limited);
        if observables.step == self.step {
            cells.iterations = self.iterations;
            cells.residual = self.residual;
        }
    }

    /// What a checkpoint of the current step has to keep.
    pub(super) fn section(&self, engine: &mut Engine<'_>) -> Result<Vec<u8>, RunError> {
        let control = engine.words("control")?;
        let word = offset_of!(Control, limited) / size_of::<u32>();
        let [low, high] = [0, 1].map(|part| u64::from(control.get(word + part).copied().unwrap_or(0)));
        let solves = engine.plan().buffers.iter().any(|buffer| buffer.name == "solver");
        let solver = if solves { engine.words("solver")? } else { Vec::new() };
        let solver = |word: usize| solver.get(word).copied().unwrap_or(0);
        let residual =
            (f64::from(f32::from_bits(solver(RESIDUAL))) * RESIDUAL_UNITS).round_ties_even() / RESIDUAL_UNITS;
        let limited = self.limited.saturating_add(high << 32 | low);
        if engine.step() == self.step {
            // Nothing was solved for since the upload.
            return Ok(bytes([limited as f64, self.iterations as f64, self.residual].into_iter()));
        }
        Ok(bytes([limited as f64, f64::from(solver(ITERATIONS)), residual].into_iter()))
    }
}
