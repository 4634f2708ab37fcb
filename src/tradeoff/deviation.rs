//! How far a measure of a choice is from its reference.

use super::measures::{self, Measured};
use super::reference::Reference;
use super::target::Verdict;
use serde::{Deserialize, Serialize};

/// Standard errors that an error may lie beyond what was found: one in twenty does by chance.
const CONFIDENCE: f64 = 2.0;

/// The error of a measure, with its uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// The measure.
    pub measure: String,
    /// The value less its reference, as a part of the reference where `relative`.
    pub error: f64,
    /// Standard error of that, of the value and of the reference together, as [`Measured::uncertainty`] counts it; none where one of them is
    /// unknown.
    pub uncertainty: Option<f64>,
    /// Whether there were too few samples to know the standard error of the value.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub from_few_samples: bool,
    /// Whether both are parts of the reference.
    pub relative: bool,
    /// Whether no other choice costs less and errs less.
    pub on_front: bool,
    /// The error that the scheme has with its time step by itself, where that is known exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of_scheme: Option<f64>,
}

impl Deviation {
    /// The deviation of what was measured. It is relative unless the reference is zero for all that is known.
    pub(crate) fn new(measured: &Measured, reference: &Reference) -> Self {
        let relative = !reference.is_zero();
        let scale = if relative { reference.value.abs() } else { 1.0 };
        let uncertainty =
            measured.uncertainty().zip(reference.uncertainty).map(|(own, other)| own.hypot(other) / scale);
        Self {
            measure: measured.measure.clone(),
            error: (measured.value - reference.value) / scale,
            uncertainty,
            from_few_samples: measured.from_few_samples,
            relative,
            on_front: false,
            of_scheme: None,
        }
    }

    /// The same with the value that the scheme gives by itself, where that is known.
    pub(super) fn with_scheme(self, value: Option<f64>, reference: &Reference) -> Self {
        let scale = if self.relative { reference.value.abs() } else { 1.0 };
        Self { of_scheme: value.map(|value| (value - reference.value) / scale), ..self }
    }

    /// Whether it is a part of something: of the reference, or what a drift, a distance or a share is one of.
    pub(crate) fn is_part(&self) -> bool {
        self.relative || measures::is_part(&self.measure)
    }

    /// The error without its sign.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.error.abs()
    }

    /// The largest that the error may be by its uncertainty.
    pub(super) fn largest(&self) -> f64 {
        self.size() + CONFIDENCE * self.uncertainty.unwrap_or(0.0)
    }

    /// The verdict on an error that may be as large as `most`, with its uncertainty; open where nothing is known of
    /// that.
    pub(crate) fn within(&self, most: f64) -> Verdict {
        let Some(uncertainty) = self.uncertainty else { return Verdict::Open };
        let (size, margin) = (self.size(), CONFIDENCE * uncertainty);
        if size + margin <= most {
            Verdict::Meets
        } else if size - margin > most {
            Verdict::Misses
        } else {
            Verdict::Open
        }
    }

    /// Where it lies on a logarithmic axis, which has no zero: what is zero by chance lies at its uncertainty.
    pub(crate) fn on_log_axis(&self) -> Option<f64> {
        if self.size() > 0.0 { Some(self.size()) } else { self.uncertainty.filter(|error| *error > 0.0) }
    }

    /// Whether the error may as well be zero: it is within two standard errors.
    pub(crate) fn is_within_noise(&self) -> bool {
        self.uncertainty.is_some_and(|uncertainty| self.size() <= CONFIDENCE * uncertainty)
    }
}

#[cfg(test)]
mod tests {
    use super::super::reference::Source;
    use super::*;

    fn measured(value: f64, standard_error: Option<f64>) -> Measured {
        let measure = "pressure".to_owned();
        Measured { measure, value, standard_error, fluctuates: true, from_few_samples: false }
    }

    fn reference(value: f64, uncertainty: Option<f64>) -> Reference {
        Reference { measure: "pressure".to_owned(), value, uncertainty, source: Source::Given }
    }

    #[test]
    fn errors_add_in_squares_and_are_parts_of_the_reference() {
        let found = Deviation::new(&measured(21.0, Some(0.3)), &reference(20.0, Some(0.4)));
        let found = found.with_scheme(Some(20.5), &reference(20.0, Some(0.4)));
        assert!((found.error - 0.05).abs() < 1e-15 && found.relative);
        assert!((found.uncertainty.unwrap_or(0.0) - 0.025).abs() < 1e-15);
        assert!(found.is_within_noise() && found.of_scheme == Some(0.025));
        let absolute = Deviation::new(&measured(-0.1, Some(0.01)), &reference(0.0, Some(0.0)));
        assert_eq!((absolute.error, absolute.relative, absolute.is_within_noise()), (-0.1, false, false));
        assert_eq!(Deviation::new(&measured(1.0, None), &reference(1.0, Some(0.1))).uncertainty, None);
        // No part of what may be zero.
        let beside_nothing = |error| Deviation::new(&measured(-0.05, Some(0.01)), &reference(-0.02, Some(error)));
        assert_eq!([0.009, 0.011].map(|error| beside_nothing(error).relative), [true, false]);
        assert!((beside_nothing(0.011).error + 0.03).abs() < 1e-15);
    }

    #[test]
    fn standard_errors_from_few_samples_count_three_times() {
        let few = Measured { from_few_samples: true, ..measured(21.0, Some(0.1)) };
        let found = Deviation::new(&few, &reference(20.0, Some(0.4)));
        assert!((found.uncertainty.unwrap_or(0.0) - 0.025).abs() < 1e-15 && found.from_few_samples, "{found:?}");
        let enough = Deviation::new(&measured(21.0, Some(0.3)), &reference(20.0, Some(0.4)));
        assert!(enough.uncertainty == found.uncertainty && !enough.from_few_samples, "{enough:?}");
    }
}
