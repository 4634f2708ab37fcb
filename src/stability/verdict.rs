//! What became of a scene.

use crate::tradeoff::{self, Deviation};
use serde::{Deserialize, Serialize};

/// What became of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize, strum::Display)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Verdict {
    /// It ran, and everything that is compared is within the tolerance.
    #[default]
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
}

/// The verdict on a run that came to its end, and whether its deviations are certain enough for it.
pub(super) fn verdict(deviations: &[Deviation], tolerance: f64) -> (Verdict, bool) {
    // A value that is not a number is certainly not right.
    let within = |deviation: &Deviation| {
        if deviation.size().is_finite() { deviation.within(tolerance) } else { tradeoff::Verdict::Misses }
    };
    let mut verdicts = deviations.iter().map(within);
    if deviations.iter().all(|deviation| deviation.size() <= tolerance) {
        return (Verdict::Right, verdicts.all(|verdict| verdict == tradeoff::Verdict::Meets));
    }
    // One that is certain is enough.
    (Verdict::Biased, verdicts.any(|verdict| verdict == tradeoff::Verdict::Misses))
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
