//! Axis scales and their ticks: round numbers, readable powers of ten.

use super::chart::Scale;
use crate::numbers::{fixed, superscript, trimmed};

/// Maps values to fractions of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisMap {
    pub scale: Scale,
    pub low: f64,
    pub high: f64,
}

/// Values beyond this cannot be distinguished from infinity once margins are added.
pub(super) const LARGEST: f64 = 1e300;
pub(super) const SMALLEST: f64 = 1e-300;

impl AxisMap {
    pub(super) fn linear(low: f64, high: f64) -> Self {
        Self { scale: Scale::Linear, low, high }
    }

    /// The axis of a range that was given; none if that is left out, empty, not finite, or not positive where its
    /// logarithm is taken.
    pub(super) fn given(scale: Scale, range: Option<[f64; 2]>) -> Option<Self> {
        let [low, high] = range?;
        let has_length = high - low > 1e-12 * low.abs().max(high.abs());
        let is_finite = low.abs() <= LARGEST && high.abs() <= LARGEST;
        (has_length && is_finite && (scale == Scale::Linear || low >= SMALLEST)).then_some(Self { scale, low, high })
    }

    /// The linear axis of values between two ends, with a margin in parts of their distance. A constant gets a range in
    /// proportion to it, so that its noise in the last digit stays invisible.
    pub(super) fn around([low, high]: [f64; 2], margin: f64) -> Self {
        let (span, largest) = (high - low, low.abs().max(high.abs()));
        let grow = if span > (1e-11 * largest).max(SMALLEST) {
            margin * span
        } else if largest < SMALLEST {
            1.0
        } else {
            0.1 * largest
        };
        Self::linear(low - grow, high + grow)
    }

    /// Fraction of the axis, 0 at `low` and 1 at `high`; `None` where the axis has no place for the value.
    pub(super) fn fraction(&self, value: f64) -> Option<f64> {
        if !value.is_finite() {
            return None;
        }
        match self.scale {
            Scale::Linear => Some((value - self.low) / (self.high - self.low)),
            Scale::Log if value > 0.0 => Some((value / self.low).log10() / (self.high / self.low).log10()),
            Scale::Log => None,
        }
    }
}

/// Ticks of one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Ticks {
    /// Value and label.
    pub major: Vec<(f64, String)>,
    pub minor: Vec<f64>,
    /// What every label is to be multiplied by and added to, such as `×10⁴`.
    pub multiplier: Option<String>,
}

impl Ticks {
    /// All ticks, of which the major ones have labels.
    pub(super) fn all(&self) -> impl Iterator<Item = (f64, Option<&str>)> {
        let major = self.major.iter().map(|(value, text)| (*value, Some(text.as_str())));
        major.chain(self.minor.iter().map(|value| (*value, None)))
    }
}

/// Ticks of an axis with room for at most `count` labels: as many as fit. An axis whose ends are not two numbers in order,
/// or so close to zero or so far apart that no step between them is an ordinary number, has none.
pub(super) fn ticks(map: &AxisMap, count: usize) -> Ticks {
    let span = map.high - map.low;
    let has_steps = span.is_finite() && span * SMALLEST_STEP >= f64::MIN_POSITIVE;
    if !has_steps || map.scale == Scale::Log && map.low < f64::MIN_POSITIVE {
        return Ticks::default();
    }
    match map.scale {
        Scale::Linear => linear_ticks(map.low, map.high, count),
        Scale::Log if map.high / map.low < 4.0 => linear_ticks(map.low, map.high, count),
        Scale::Log => log_ticks(map.low, map.high, count),
    }
}

/// Ticks along an axis of a length, with labels of a size and these widths: as many as have room, or so few.
pub(super) fn ticks_along(map: &AxisMap, length: f64, label: f64, fewest: usize, width: impl Fn(&str) -> f64) -> Ticks {
    let mut wanted = ((length / (3.0 * label)) as usize).clamp(2, 10);
    loop {
        let found = ticks(map, wanted);
        // Labels of many digits need more room than the first guess gave them.
        let widest = found.major.iter().map(|(_, text)| width(text)).fold(0.0, f64::max);
        if wanted <= fewest || found.major.len() as f64 * (widest + 1.2 * label) <= length * 1.1 {
            return found;
        }
        wanted -= 1;
    }
}

/// A minor step is a larger part of the axis than this.
const SMALLEST_STEP: f64 = 1e-6;

/// The smallest of 1, 2, 5 times a power of ten that is at least `raw`, and the number of minor intervals in it.
fn nice_step(raw: f64) -> (f64, u32) {
    let power = 10_f64.powf(raw.log10().floor());
    let fits = |(step, _): &(f64, u32)| raw / power <= step + 1e-9;
    let (step, parts) = [(1.0, 5), (2.0, 4), (5.0, 5)].into_iter().find(fits).unwrap_or((10.0, 5));
    (step * power, parts)
}

fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let tolerance = 1e-6;
    let first = (low / step - tolerance).ceil();
    let last = (high / step + tolerance).floor();
    let count = (last - first + 1.0).clamp(0.0, 1000.0) as usize;
    (0..count).map(|index| (first + index as f64) * step).collect()
}

fn linear_ticks(low: f64, high: f64, count: usize) -> Ticks {
    let span = high - low;
    let count = count.max(2);
    let (mut step, mut parts) = nice_step(span / (2 * count) as f64);
    let mut values = multiples(low, high, step);
    // A step as long as the axis leaves two.
    while values.len() > count && step < span {
        (step, parts) = nice_step(1.5 * step);
        values = multiples(low, high, step);
    }
    let minor = multiples(low, high, step / f64::from(parts));
    let largest = low.abs().max(high.abs());

    // Far from zero compared with the span: labels show the difference from a round number.
    let offset = if largest > 2e4 * span {
        let unit = 10_f64.powf(span.log10().ceil());
        (0.5 * (low + high) / unit).round() * unit
    } else {
        0.0
    };
    let reach = (low - offset).abs().max((high - offset).abs());
    let exponent = reach.log10().floor() as i32;
    let factor_exponent = if (-3..5).contains(&exponent) { 0 } else { exponent };
    let decimals = (factor_exponent - (step * 1.000_001).log10().floor() as i32).max(0) as usize;
    let factor = 10_f64.powi(-factor_exponent.clamp(-300, 300));
    let label = |value: f64| fixed((value - offset) * factor, decimals);

    let power = (factor_exponent != 0).then(|| format!("×10{}", superscript(factor_exponent)));
    let sign = if offset < 0.0 { '−' } else { '+' };
    let shift = (offset != 0.0).then(|| format!("{sign} {}", significant(offset.abs(), span)));
    let multiplier: Vec<String> = power.into_iter().chain(shift).collect();
    Ticks {
        major: values.into_iter().map(|value| (value, label(value))).collect(),
        minor,
        multiplier: (!multiplier.is_empty()).then(|| multiplier.join(" ")),
    }
}

fn log_ticks(low: f64, high: f64, count: usize) -> Ticks {
    let (first, last) = ((low.log10() - 1e-9).ceil() as i32, (high.log10() + 1e-9).floor() as i32);
    let decades = (last - first + 1).max(0) as usize;
    let every = decades.div_ceil(count.max(1)).max(1) as i32;
    let mut ticks = Ticks::default();
    for exponent in (first - 1)..=last {
        let power = 10_f64.powi(exponent);
        // With few decades in sight the twos and fives carry labels too.
        for lead in 1..=9 {
            let value = f64::from(lead) * power;
            if value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9) || value.is_infinite() {
                continue;
            }
            let labelled = match lead {
                1 => exponent.rem_euclid(every) == 0,
                2 | 5 => decades <= 2 && count >= 4,
                _ => false,
            };
            if labelled {
                ticks.major.push((value, power_label(lead, exponent)));
            } else if every == 1 || lead == 1 {
                ticks.minor.push(value);
            }
        }
    }
    ticks
}

fn power_label(lead: i32, exponent: i32) -> String {
    if (-3..4).contains(&exponent) {
        return fixed(f64::from(lead) * 10_f64.powi(exponent), (-exponent).max(0) as usize);
    }
    let power = format!("10{}", superscript(exponent));
    if lead == 1 { power } else { format!("{lead}×{power}") }
}

/// A positive number written to the precision of `span`.
fn significant(value: f64, span: f64) -> String {
    let exponent = value.log10().floor() as i32;
    let last = span.log10().floor() as i32;
    if (-4..7).contains(&exponent) {
        return trimmed(&fixed(value, (-last).max(0) as usize));
    }
    let digits = trimmed(&fixed(value / 10_f64.powi(exponent), (exponent - last).clamp(0, 16) as usize));
    format!("{digits}×10{}", superscript(exponent))
}

/// The largest of 1, 2, 5 times a power of ten that is at most `limit`.
pub(super) fn nice_length(limit: f64) -> f64 {
    let power = 10_f64.powf(limit.log10().floor());
    [5.0, 2.0].into_iter().find(|step| limit / power >= *step).unwrap_or(1.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, count: usize) -> (Vec<String>, Option<String>) {
        let ticks = linear_ticks(low, high, count);
        (ticks.major.into_iter().map(|(_, label)| label).collect(), ticks.multiplier)
    }

    #[test]
    fn round_numbers() {
        assert_eq!(labels(0.0, 1.0, 7).0, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-1.3, 1.2, 5).0, ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(0.0, 80.0, 5), (["0", "20", "40", "60", "80"].map(String::from).to_vec(), None));
    }

    #[test]
    fn large_and_small_numbers_share_a_power_of_ten() {
        assert_eq!(labels(0.0, 4.0e5, 5).0, ["0", "1", "2", "3", "4"]);
        assert_eq!(labels(0.0, 4.0e5, 5).1.as_deref(), Some("×10⁵"));
        assert_eq!(labels(0.0, 2.0e-7, 5).1.as_deref(), Some("×10⁻⁷"));
        assert_eq!(labels(0.0, 2.0e-7, 5).0, ["0.0", "0.5", "1.0", "1.5", "2.0"]);
    }

    #[test]
    fn a_narrow_range_far_from_zero_shows_differences() {
        let (labels, multiplier) = labels(1_000_000.0, 1_000_000.004, 5);
        assert_eq!(multiplier.as_deref(), Some("+ 1000000"));
        assert_eq!(labels, ["0.000", "0.001", "0.002", "0.003", "0.004"]);
    }

    #[test]
    fn decades_and_their_parts() {
        let map = AxisMap { scale: Scale::Log, low: 0.01, high: 1e6 };
        let ticks = ticks(&map, 9);
        assert_eq!(ticks.major.first(), Some(&(0.01, "0.01".to_owned())));
        assert_eq!(ticks.major.last(), Some(&(1e6, "10⁶".to_owned())));
        assert_eq!(ticks.major.len(), 9);
        assert_eq!(ticks.minor.len(), 8 * 8);
    }

    #[test]
    fn no_number_of_ticks_is_absurd_over_many_ranges() {
        for exponent in -290..290 {
            for width in [1e-9, 1e-3, 0.7, 1.0, 300.0] {
                let low = 1.7 * 10_f64.powi(exponent);
                let high = low * (1.0 + width);
                let ticks = linear_ticks(low, high, 5);
                assert!((2..=5).contains(&ticks.major.len()), "{low} {high} {ticks:?}");
                assert!(ticks.major.iter().all(|(_, label)| label.len() < 12), "{ticks:?}");
                let distinct: std::collections::HashSet<_> = ticks.major.iter().map(|(_, label)| label).collect();
                assert_eq!(distinct.len(), ticks.major.len(), "{low} {high} {ticks:?}");
            }
        }
    }

    /// Every pair of ends, in order or not, with a step between them or not, gets its few ticks and no more.
    #[test]
    fn ticks_end_whatever_the_axis() {
        let tiny = [0.0, -0.0, 5e-324, 1e-310, f64::MIN_POSITIVE, 1e-300, 1e-12];
        let large = [1.0, 1.0 + f64::EPSILON, 3e5, 1e300, f64::MAX, f64::INFINITY, f64::NAN];
        let values: Vec<f64> = tiny.into_iter().chain(large).flat_map(|value| [value, -value]).collect();
        for (low, high) in values.iter().flat_map(|low| values.iter().map(move |high| (*low, *high))) {
            for (scale, count) in [(Scale::Linear, 2), (Scale::Linear, 9), (Scale::Log, 2), (Scale::Log, 9)] {
                let found = ticks(&AxisMap { scale, low, high }, count);
                assert!(found.major.len() + found.minor.len() < 1100, "{scale:?} {low} {high} {count}: {found:?}");
                let values = found.major.iter().map(|(value, _)| value).chain(&found.minor);
                assert!(values.into_iter().all(|value| value.is_finite()), "{scale:?} {low} {high}: {found:?}");
            }
        }
    }

    #[test]
    fn nice_lengths_never_exceed_the_limit() {
        assert_eq!(nice_length(4.9), 2.0);
        assert_eq!(nice_length(5.0), 5.0);
    }
}
