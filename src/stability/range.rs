//! What a user wants varied: a range of numbers, or a list of values.

use crate::numbers::counted;
use crate::study::{Variation, numbers};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The most values of a key: more are taken for a slip.
const MOST_POINTS: usize = 200;

/// How values are spread over a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Spacing {
    /// Equal ratios.
    Log,
    /// Equal differences.
    Linear,
}

impl Spacing {
    /// The value in the middle of two.
    pub(super) fn middle(self, low: f64, high: f64) -> f64 {
        match self {
            Self::Log => (low * high).sqrt(),
            Self::Linear => f64::midpoint(low, high),
        }
    }

    /// How far two values are apart.
    pub(super) fn distance(self, low: f64, high: f64) -> f64 {
        match self {
            Self::Log => (high / low).ln(),
            Self::Linear => high - low,
        }
    }

    /// The value so far from another, in the sense of [`Self::distance`].
    pub(super) fn moved(self, value: f64, distance: f64) -> f64 {
        match self {
            Self::Log => value * distance.exp(),
            Self::Linear => value + distance,
        }
    }

    /// A distance below which values are as good as the same.
    pub(super) fn least(self) -> f64 {
        match self {
            Self::Log => std::f64::consts::LN_2,
            Self::Linear => f64::MIN_POSITIVE,
        }
    }

    /// The value at a part of the way from one to another.
    fn at(self, low: f64, high: f64, part: f64) -> f64 {
        match self {
            Self::Log => low * (high / low).powf(part),
            Self::Linear => low + part * (high - low),
        }
    }
}

/// A key of a scene and its values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Range {
    /// Path of the key, as in an override.
    pub key: String,
    /// The values, in their order.
    pub values: Vec<Value>,
    /// How they are spread.
    pub spacing: Spacing,
}

/// A number of four digits, as people write it.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

impl Range {
    /// Reads `key=low..high/points`, with `:linear` or `:log` after it, or `key=value,value,…`.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn parse(argument: &str) -> Result<Self, String> {
        let Some((key, text)) = argument.split_once('=').filter(|(_, text)| text.contains("..")) else {
            let Variation { key, values } =
                Variation::parse(argument).map_err(|message| format!("{message}, or {ACCEPTED}"))?;
            if values.len() > MOST_POINTS {
                return Err(format!("{} values; accepted: at most {MOST_POINTS}", values.len()));
            }
            let spacing = numbers(&values).map_or(Spacing::Linear, |numbers| spacing_of(&numbers));
            return Ok(Self { key, values, spacing });
        };
        let key = key.trim().replace('[', ".").replace(']', "");
        let wrong = || format!("accepted: {ACCEPTED}");
        let (ends, points) = text.rsplit_once('/').ok_or_else(wrong)?;
        let (points, asked) =
            points.split_once(':').map_or((points, None), |(points, asked)| (points, Some(asked.trim())));
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        let (low, high) =
            ends.split_once("..").and_then(|(low, high)| Some((number(low)?, number(high)?))).ok_or_else(wrong)?;
        let points: usize = points.trim().parse().map_err(|_| wrong())?;
        if !(2..=MOST_POINTS).contains(&points) {
            return Err(format!("{}; accepted: 2 to {MOST_POINTS}", counted(points as u64, "point")));
        }
        if low >= high {
            return Err(format!("{low} is not below {high}; accepted: the smaller end first"));
        }
        let spacing = match asked {
            None | Some("log") if low > 0.0 => Spacing::Log,
            None | Some("linear") => Spacing::Linear,
            Some("log") => return Err("a logarithmic range begins above zero".to_owned()),
            Some(_) => return Err(wrong()),
        };
        let value = |index: usize| rounded(spacing.at(low, high, index as f64 / (points - 1) as f64));
        let mut values: Vec<f64> = (0..points).map(value).collect();
        values.dedup();
        Ok(Self { key, values: values.into_iter().map(number_of).collect(), spacing })
    }

    /// The values as numbers that increase, if that is what they are.
    pub(super) fn numbers(&self) -> Option<Vec<f64>> {
        numbers(&self.values).filter(|numbers| numbers.is_sorted_by(|a, b| a < b))
    }
}

const ACCEPTED: &str =
    "key=low..high/points, as in time.step=0.01..0.2/9, with `:linear` after it for equal differences";

/// A number in JSON: whole numbers without a fraction, which keys for counts want.
pub(super) fn number_of(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 9e15 { Value::from(value as i64) } else { Value::from(value) }
}

/// How numbers of a list are spread: by ratios if all are above zero and they span much.
fn spacing_of(numbers: &[f64]) -> Spacing {
    let (low, high) =
        numbers.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(*value), high.max(*value)));
    if low > 0.0 && high >= 8.0 * low { Spacing::Log } else { Spacing::Linear }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn numbers(argument: &str) -> (Vec<f64>, Spacing) {
        let range = Range::parse(argument).unwrap();
        (range.numbers().unwrap(), range.spacing)
    }

    #[test]
    fn ranges_are_spread_by_ratios_or_differences() {
        assert_eq!(numbers("a=1e-2..100/5"), (vec![0.01, 0.1, 1.0, 10.0, 100.0], Spacing::Log));
        assert_eq!(numbers("a=0..4/5"), (vec![0.0, 1.0, 2.0, 3.0, 4.0], Spacing::Linear));
        assert_eq!(numbers("a=1..4/4:linear"), (vec![1.0, 2.0, 3.0, 4.0], Spacing::Linear));
        assert_eq!(numbers("a=-1..1/3"), (vec![-1.0, 0.0, 1.0], Spacing::Linear));
        assert_eq!(numbers("a=1..10/3").0, [1.0, 3.162, 10.0]);
        assert_eq!(numbers("a=1,2,4"), (vec![1.0, 2.0, 4.0], Spacing::Linear));
        assert_eq!(numbers("a=.1,1,10").1, Spacing::Log);
    }

    #[test]
    fn counts_are_whole_numbers() {
        assert_eq!(Range::parse("particles[0].count=10..1000/3").unwrap().values, [10, 100, 1000].map(Value::from));
        assert_eq!(Range::parse("particles[0].count=10..1000/3").unwrap().key, "particles.0.count");
    }

    #[test]
    fn what_is_no_range_is_refused() {
        for wrong in [
            "a=1..2",
            "a=1..2/1",
            "a=1..2/10000000",
            "a=2..1/5",
            "a=1..1/5",
            "a=x..2/5",
            "a=0..1/5:log",
            "a=1..2/5:cubic",
            "a",
            "a=1..inf/3",
            "=1..2/x",
        ] {
            assert!(Range::parse(wrong).is_err(), "{wrong}");
        }
        assert_eq!(Range::parse("integrator.type=splitting,none").unwrap().numbers(), None);
        assert_eq!(Range::parse("a=2,1").unwrap().numbers(), None);
    }
}
