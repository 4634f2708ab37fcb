//! What the plots of a sweep show.

use crate::families::Model;
use crate::run;
use crate::study::{StudyError, Sweep};
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
    /// [`StudyError::Arguments`] names the first.
    pub(super) fn check(&self, sweep: &Sweep) -> Result<(), StudyError> {
        let mut accepted: Vec<String> = Vec::new();
        for variant in sweep.variants() {
            for quantity in run::quantities(&Model::new(&variant.scene)) {
                if accepted.iter().all(|known| known != quantity) {
                    accepted.push(quantity.to_owned());
                }
            }
        }
        match self.quantities.iter().find(|wanted| !accepted.contains(wanted)) {
            Some(wanted) => Err(StudyError::mistake(format!(
                "there is no quantity `{wanted}` to plot; accepted: {}",
                accepted.join(", ")
            ))),
            None => Ok(()),
        }
    }
}
