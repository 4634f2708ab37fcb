//! Limited exchanges, and the last solution for the friction.

use super::plan::SOLVER;
use crate::families::{Counted, Model, Observables, Tally, Voronoi};
use crate::shaders::Array;

/// Words of `iterations` and `residual` in the struct `Solver` of `shaders/voronoi/friction.wgsl`.
const ITERATIONS: usize = 2;
const RESIDUAL: usize = 8;
/// Residuals are reported in units of this.
const RESIDUAL_UNITS: f64 = (1_u64 << 40) as f64;

/// Limited exchanges, iterations, residual.
impl Tally for Voronoi {
    fn section(&self) -> &'static str {
        "exchanges"
    }

    fn length(&self) -> u64 {
        3
    }

    fn array(&self, _: &Model) -> Option<Array> {
        self.solves().then_some(SOLVER)
    }

    fn after(&self, upload: &[f64], counted: &Counted) -> Vec<f64> {
        let [limited, iterations, residual] = numbers(upload);
        let limited = (limited as u64).saturating_add(counted.limited) as f64;
        let Some(words) = &counted.words else { return vec![limited, iterations, residual] };
        let word = |place: usize| words.get(place).copied().unwrap_or(0);
        let residual = (f64::from(f32::from_bits(word(RESIDUAL))) * RESIDUAL_UNITS).round_ties_even() / RESIDUAL_UNITS;
        vec![limited, f64::from(word(ITERATIONS)), residual]
    }

    fn complete(&self, upload: &[f64], is_upload: bool, observables: &mut Observables) {
        let Some(cells) = &mut observables.cells else { return };
        let [limited, iterations, residual] = numbers(upload);
        cells.limited_exchanges = cells.limited_exchanges.saturating_add(limited as u64);
        if is_upload {
            cells.iterations = iterations as u64;
            cells.residual = residual;
        }
    }
}

/// The numbers at an upload; zeros at the beginning of a run.
fn numbers(upload: &[f64]) -> [f64; 3] {
    upload.try_into().unwrap_or_default()
}
