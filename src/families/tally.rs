//! What the device counts from the upload of a state on, carried over from checkpoint to checkpoint.

use super::{Model, Observables};
use crate::shaders::Array;

/// What a family has the device count.
pub(crate) trait Tally {
    /// Name of the section of a checkpoint that keeps the numbers.
    fn section(&self) -> &'static str;

    /// How many numbers there are.
    fn length(&self) -> u64;

    /// The array of the plan that they are read from, besides the number of limited exchanges.
    fn array(&self, model: &Model) -> Option<Array>;

    /// The numbers at a step, from those at the upload and what was counted since.
    fn after(&self, upload: &[f64], counted: &Counted) -> Vec<f64>;

    /// Completes what was measured with the numbers at the upload; at that step itself the device knows of none.
    fn complete(&self, upload: &[f64], is_upload: bool, observables: &mut Observables);
}

/// What the device has counted since an upload.
pub(crate) struct Counted {
    /// Exchanges that a limit has cut.
    pub limited: u64,
    /// The words of [`Tally::array`]; none where there was no step since.
    pub words: Option<Vec<u32>>,
}
