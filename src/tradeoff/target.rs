//! What a choice is to reach, and whether it does.

use super::deviation::Deviation;
use super::measures;
use super::reference::Reference;
use crate::numbers::short;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The largest error that a measure may have.
///
/// ```
/// use mesoscope::tradeoff::{Amount, Target};
///
/// let target = Target::parse("configurational_temperature=1%")?;
/// assert_eq!((target.measure.as_str(), target.amount), ("configurational_temperature", Amount::Relative(0.01)));
/// assert_eq!(Target::parse("pressure=0.2")?.amount, Amount::Absolute(0.2));
/// assert!(Target::parse("pressure").is_err() && Target::parse("pressure=-1%").is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// The measure.
    pub measure: String,
    /// How far off it may be.
    pub amount: Amount,
}

/// An amount that an error is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Amount {
    /// A part of the reference.
    Relative(f64),
    /// In the units of the measure.
    Absolute(f64),
}

/// Whether a choice meets its targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, strum::Display)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Verdict {
    /// All errors with their uncertainty are within the targets.
    Meets,
    /// More samples are needed to tell.
    Open,
    /// Some error is beyond its target with all of its uncertainty.
    Misses,
}

impl Target {
    /// Reads `measure=1%` or `measure=0.2`.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn parse(argument: &str) -> Result<Self, String> {
        let accepted = "accepted: measure=1% of the reference, or measure=0.2 in its own units";
        let parts = argument.split_once('=').map(|(measure, text)| (measure.trim(), text.trim()));
        let (measure, text) = parts.filter(|(measure, _)| !measure.is_empty()).ok_or(accepted)?;
        let number = |text: &str| match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
            _ => Err(format!("found {text}; {accepted}, and more than zero")),
        };
        let amount = match text.strip_suffix('%') {
            Some(percent) => Amount::Relative(number(percent)? / 100.0),
            None => Amount::Absolute(number(text)?),
        };
        Ok(Self { measure: measure.to_owned(), amount })
    }

    /// True if it is a part of a reference of which there is none, as errors are not `relative` to it: zero is what
    /// drifts and distances should be, and these are parts of something else.
    pub(super) fn is_part_of_nothing(&self, relative: bool) -> bool {
        matches!(self.amount, Amount::Relative(_)) && !relative && !measures::is_part(&self.measure)
    }

    /// What to say where it is one.
    pub(super) fn part_of_nothing(&self, reference: &Reference) -> Option<String> {
        let measure = &self.measure;
        let reference_is = if reference.value == 0.0 { "is 0" } else { "cannot be told from 0" };
        self.is_part_of_nothing(!reference.is_zero()).then(|| {
            format!(
                "the reference of `{measure}` {reference_is}, so that a percentage of it means nothing: give an error in its own units, `--target {measure}=VALUE`"
            )
        })
    }

    /// The largest error allowed, for a reference of this value; as a part of it if `relative`.
    pub(super) fn most(&self, reference: f64, relative: bool) -> f64 {
        match self.amount {
            // What is no part of the reference is one of something else, as drifts and distances are.
            Amount::Relative(part) => part,
            Amount::Absolute(amount) if relative => amount / reference.abs(),
            Amount::Absolute(amount) => amount,
        }
    }

    /// The verdict on an error, for a reference of this value. An error that nothing is known about stays open, and so does a part of nothing.
    pub(crate) fn verdict(&self, deviation: &Deviation, reference: f64) -> Verdict {
        if self.is_part_of_nothing(deviation.relative) {
            return Verdict::Open;
        }
        deviation.within(self.most(reference, deviation.relative))
    }
}

impl fmt::Display for Target {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.amount {
            Amount::Relative(part) => write!(formatter, "{} within {} %", self.measure, short(100.0 * part)),
            Amount::Absolute(amount) => write!(formatter, "{} within {amount}", self.measure),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_meets_a_target_with_its_uncertainty_or_not() {
        let target = Target { measure: "pressure".to_owned(), amount: Amount::Relative(0.01) };
        let deviation = |error: f64, uncertainty: Option<f64>| Deviation {
            measure: "pressure".to_owned(),
            error,
            uncertainty,
            from_few_samples: false,
            relative: true,
            on_front: false,
            of_scheme: None,
        };
        let verdict = |error, uncertainty| target.verdict(&deviation(error, uncertainty), 23.6);
        assert_eq!(verdict(0.004, Some(0.002)), Verdict::Meets);
        assert_eq!(verdict(-0.009, Some(0.002)), Verdict::Open);
        assert_eq!(verdict(0.02, Some(0.002)), Verdict::Misses);
        assert_eq!(verdict(0.0, None), Verdict::Open);
        let absolute = Target { amount: Amount::Absolute(0.2), ..target.clone() };
        assert_eq!(absolute.verdict(&deviation(0.02, Some(0.0)), 23.6), Verdict::Misses);
        assert_eq!(absolute.verdict(&deviation(0.008, Some(0.0)), 23.6), Verdict::Meets);
        // No error is a part of nothing, but a drift is one of an energy.
        let of_nothing = |measure: &str| {
            let target = Target { measure: measure.to_owned(), ..target.clone() };
            let deviation = Deviation { measure: measure.to_owned(), relative: false, ..deviation(0.0, Some(0.0)) };
            target.verdict(&deviation, 0.0)
        };
        assert_eq!((of_nothing("momentum_x"), of_nothing("energy_drift")), (Verdict::Open, Verdict::Meets));
        assert!(Verdict::Meets < Verdict::Open && Verdict::Open < Verdict::Misses);
    }

    #[test]
    fn targets_are_read_or_refused() {
        for wrong in ["", "=1%", "a=", "a=x%", "a=0", "a=nan", "a=-3", "a=inf"] {
            assert!(Target::parse(wrong).is_err(), "{wrong}");
        }
        assert_eq!(Target::parse(" a = 2 % "), Ok(Target { measure: "a".to_owned(), amount: Amount::Relative(0.02) }));
    }
}
