//! The ranges of values that colours of pictures show: one for all pictures of a run.
//!
//! The first picture of a run fixes the range of each quantity, from the state that it shows and from what the temperature
//! of the scene leads one to expect. A checkpoint keeps it, so that a resumed run goes on with the same colours.

use super::sections::bytes;
use std::collections::BTreeMap;

/// Ranges by what is shown.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ColourRanges {
    fixed: BTreeMap<String, [f64; 2]>,
}

/// What the names of the sections of a checkpoint begin with.
const SECTION: &str = "colour_range.";

impl ColourRanges {
    /// Those that a checkpoint kept.
    pub(super) fn restored(sections: &[(String, Vec<u8>)]) -> Self {
        // One that makes no sense is replaced with the next picture.
        let range = |(name, section): &(String, Vec<u8>)| {
            let (words, _) = section.as_chunks();
            match words.iter().map(|word| f64::from_le_bytes(*word)).collect::<Vec<f64>>()[..] {
                [low, high] if low < high && (high - low).is_finite() => {
                    Some((name.strip_prefix(SECTION)?.to_owned(), [low, high]))
                }
                _ => None,
            }
        };
        Self { fixed: sections.iter().filter_map(range).collect() }
    }

    /// What a checkpoint has to keep.
    pub(super) fn sections(&self) -> Vec<(String, Vec<u8>)> {
        let section = |(name, range): (&String, &[f64; 2])| (format!("{SECTION}{name}"), bytes(range.iter().copied()));
        self.fixed.iter().map(section).collect()
    }

    /// The range of a quantity: that of the user, that of earlier pictures, or the one that begins with this picture.
    pub(super) fn of(&mut self, shown: &str, asked: Option<[f64; 2]>, begin: impl FnOnce() -> [f64; 2]) -> [f64; 2] {
        asked.unwrap_or_else(|| *self.fixed.entry(shown.to_owned()).or_insert_with(begin))
    }
}

/// Speeds and other values of particles beyond this share of them at each end do not set a range.
const BEYOND: f64 = 0.002;
/// Standard deviations of a thermal velocity up to which colours tell speeds apart: one particle in a thousand is faster.
const THERMAL: f64 = 4.0;
/// Standard deviations of a thermal fluctuation.
const FLUCTUATION: f64 = 3.0;
/// A range gains this part of its length at each end of a field, which sharpens as it flows.
const GAIN: f64 = 0.1;

/// The values of a first picture, but for a few at each end; none without a finite one.
fn extent(values: &[f64]) -> Option<[f64; 2]> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let left = (BEYOND * sorted.len() as f64) as usize;
    Some([*sorted.get(left)?, sorted[sorted.len() - 1 - left]])
}

/// A range, or one around it where it has no length.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let largest = low.abs().max(high.abs());
    if high - low > 1e-9 * largest && high - low > f64::MIN_POSITIVE {
        return [low, high];
    }
    let grow = if largest > f64::MIN_POSITIVE { 0.1 * largest } else { 1.0 };
    [low - grow, high + grow]
}

/// Of speeds, from 0 on: those of the first picture, and those at a temperature kT of particles of some mass.
pub(super) fn of_speeds(speeds: &[f64], temperature: f64, lightest: f64) -> [f64; 2] {
    let thermal = THERMAL * (temperature / lightest).sqrt();
    let found = extent(speeds).map_or(0.0, |range| range[1]);
    let high = found.max(if thermal.is_finite() { thermal } else { 0.0 });
    [0.0, if high > 0.0 { high } else { 1.0 }]
}

/// Of temperatures: those of the first picture, and that of the scene.
pub(super) fn of_temperatures(values: &[f64], temperature: f64) -> [f64; 2] {
    let [low, high] = extent(values).unwrap_or([temperature; 2]);
    widened([low.min(temperature), high.max(temperature)])
}

/// Of densities: those of the first picture, and those that an ideal gas has in cells of so many molecules on average.
pub(super) fn of_densities(values: &[f64], mean: f64, molecules: f64, warm: bool) -> [f64; 2] {
    let [low, high] = extent(values).unwrap_or([mean; 2]);
    let fluctuation = if warm && molecules > 0.0 { FLUCTUATION * mean / molecules.sqrt() } else { 0.0 };
    widened([low.min(mean - fluctuation).max(0.0), high.max(mean + fluctuation)])
}

/// Of a field: its values in the first picture, and somewhat more.
pub(super) fn of_field(extrema: Option<[f64; 2]>, from_zero: bool) -> [f64; 2] {
    let [low, high] = widened(extrema.unwrap_or([0.0, 1.0]));
    let gain = GAIN * (high - low);
    if from_zero { [0.0, high + gain] } else { [low - gain, high + gain] }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_first_picture_fixes_the_range_and_a_checkpoint_keeps_it() {
        let mut ranges = ColourRanges::default();
        assert_eq!(ranges.of("speed", None, || [0.0, 4.0]), [0.0, 4.0]);
        assert_eq!(ranges.of("speed", None, || [0.0, 9.0]), [0.0, 4.0]);
        assert_eq!(ranges.of("speed", Some([1.0, 2.0]), || [0.0, 9.0]), [1.0, 2.0], "what the user asks for");
        assert_eq!(ranges.of("density", None, || [3.0, 5.0]), [3.0, 5.0]);
        let restored = ColourRanges::restored(&ranges.sections());
        assert_eq!(restored, ranges);
        let damaged = [("colour_range.speed".to_owned(), bytes([2.0, 1.0].into_iter())), ("other".to_owned(), vec![1])];
        assert_eq!(ColourRanges::restored(&damaged), ColourRanges::default());
    }

    #[test]
    fn a_start_from_rest_has_the_range_of_its_temperature() {
        assert_eq!(of_speeds(&[0.0; 10], 4.0, 1.0), [0.0, 8.0]);
        assert_eq!(of_speeds(&[0.0, 30.0], 4.0, 1.0), [0.0, 30.0]);
        assert_eq!(of_speeds(&[0.0; 10], 0.0, 1.0), [0.0, 1.0]);
        assert_eq!(of_densities(&[5.0; 10], 5.0, 9.0, true), [0.0, 10.0]);
        assert_eq!(of_densities(&[5.0; 10], 5.0, 9.0, false), [4.5, 5.5]);
        assert_eq!(of_temperatures(&[0.4, 2.5], 1.0), [0.4, 2.5]);
        assert_eq!(of_temperatures(&[2.0], 1.0), [1.0, 2.0]);
    }

    #[test]
    fn one_wild_value_does_not_set_a_range() {
        let mut speeds = vec![1.0; 1000];
        speeds[17] = 1e6;
        assert_eq!(of_speeds(&speeds, 0.0, 1.0), [0.0, 1.0]);
        assert_eq!(of_speeds(&[f64::NAN; 3], 0.0, 1.0), [0.0, 1.0]);
    }

    #[test]
    fn fields_have_room_to_sharpen() {
        let [low, high] = of_field(Some([1.0, 2.0]), false);
        assert!(low < 1.0 && high > 2.0);
        assert_eq!(of_field(Some([1.0, 2.0]), true)[0], 0.0);
        let [low, high] = of_field(None, false);
        assert!(low < high);
    }
}
