//! What became of a scene.

use crate::tradeoff::Deviation;
use serde::{Deserialize, Serialize};

/// Standard errors by which a deviation has to be away from the tolerance for a verdict that is certain.
const CERTAIN: f64 = 2.0;

/// What became of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It ran, and everything that is compared is within the tolerance.
    Right,
    /// It ran, and something is beyond the tolerance.
    Biased,
    /// It became unstable.
    Unstable,
    /// It is no scene: it was not run.
    Refused,
}

impl Verdict {
    /// All of them.
    pub(super) const ALL: [Self; 4] = [Self::Right, Self::Biased, Self::Unstable, Self::Refused];

    /// Its word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Biased => "biased",
            Self::Unstable => "unstable",
            Self::Refused => "refused",
        }
    }
}

/// The verdict on a run that came to its end, and whether its deviations are certain enough for it.
pub(super) fn verdict(deviations: &[Deviation], tolerance: f64) -> (Verdict, bool) {
    let beyond = |deviation: &Deviation| !deviation.size().is_finite() || deviation.size() > tolerance;
    let margin =
        |deviation: &Deviation| (deviation.size() - tolerance) / deviation.uncertainty.unwrap_or(f64::INFINITY);
    if deviations.iter().any(beyond) {
        // One that is certain is enough; what is not a number is certainly not right.
        let is_certain = |deviation: &&Deviation| {
            !deviation.size().is_finite() || deviation.uncertainty == Some(0.0) || margin(deviation) > CERTAIN
        };
        return (
            Verdict::Biased,
            deviations.iter().filter(|deviation| beyond(deviation)).any(|found| is_certain(&found)),
        );
    }
    let certain = deviations.iter().all(|found| found.uncertainty == Some(0.0) || margin(found) < -CERTAIN);
    (Verdict::Right, certain)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deviation(error: f64, uncertainty: Option<f64>) -> Deviation {
        let (measure, relative) = (String::new(), true);
        Deviation { measure, error, uncertainty, from_few_samples: false, relative, on_front: false, of_scheme: None }
    }

    #[test]
    fn all_must_be_within_the_tolerance_with_their_uncertainties() {
        let judge = |list: &[(f64, Option<f64>)]| {
            let list: Vec<Deviation> =
                list.iter().map(|(error, uncertainty)| deviation(*error, *uncertainty)).collect();
            verdict(&list, 0.05)
        };
        assert_eq!(judge(&[]), (Verdict::Right, true));
        assert_eq!(judge(&[(0.01, Some(0.01)), (-0.02, Some(0.01))]), (Verdict::Right, true));
        assert_eq!(judge(&[(0.01, Some(0.01)), (0.04, Some(0.01))]), (Verdict::Right, false));
        assert_eq!(judge(&[(0.06, Some(0.01)), (0.0, Some(0.01))]), (Verdict::Biased, false));
        assert_eq!(judge(&[(0.06, Some(0.01)), (-0.08, Some(0.01))]), (Verdict::Biased, true));
        assert_eq!(judge(&[(f64::NAN, None)]), (Verdict::Biased, true));
        assert_eq!(judge(&[(0.01, None)]), (Verdict::Right, false));
        assert_eq!(judge(&[(0.05, Some(0.0))]), (Verdict::Right, true));
        assert_eq!(judge(&[(0.051, Some(0.0))]), (Verdict::Biased, true));
    }
}
