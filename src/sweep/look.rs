//! What the plots of a sweep show.

use crate::run;
use crate::study::{StudyError, Sweep, Variant, each_once};
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
        let measured = |variant: &Variant| run::quantities(variant.scene.model());
        let accepted: Vec<&str> = each_once(sweep.variants().iter().flat_map(measured));
        let unknown = self.quantities.iter().find(|wanted| !accepted.contains(&wanted.as_str()));
        let mistake = |wanted| format!("there is no quantity `{wanted}` to plot; accepted: {}", accepted.join(", "));
        StudyError::refuse(unknown.map(mistake).into_iter().collect())
    }
}
