//! What the plots of a sweep show.

use super::error::SweepError;
use super::expansion::Sweep;
use crate::families::Model;
use crate::run;
use serde::{Deserialize, Serialize};

/// What the plots of a sweep show.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Look {
    /// Every quantity is divided by its own first value.
    pub relative: bool,
    /// The quantities to plot; none means all that change in any variant.
    pub quantities: Vec<String>,
}

impl Look {
    /// Looks for quantities that no variant measures.
    ///
    /// # Errors
    /// [`SweepError::Quantity`] names the first.
    pub(super) fn check(&self, sweep: &Sweep) -> Result<(), SweepError> {
        let mut accepted: Vec<String> = Vec::new();
        for variant in sweep.variants() {
            for quantity in run::quantities(&Model::new(&variant.scene)) {
                if accepted.iter().all(|known| known != quantity) {
                    accepted.push(quantity.to_owned());
                }
            }
        }
        match self.quantities.iter().find(|wanted| !accepted.contains(wanted)) {
            Some(wanted) => Err(SweepError::Quantity { wanted: wanted.clone(), accepted }),
            None => Ok(()),
        }
    }
}
