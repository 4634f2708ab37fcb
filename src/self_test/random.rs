//! Points at which an adapter is tried: the same on every machine.

use crate::noise::{centred_uniform, seed_key, words};
use crate::scene::Generator;

/// Apart from all that a run draws.
const STREAM: u32 = u32::MAX;

/// A number in (0, 1), by its number and part.
pub(super) fn uniform(number: u32, part: u32) -> f64 {
    centred_uniform(words(Generator::Threefry2x32, seed_key(1, STREAM), [number, part])[0]) + 0.5
}

/// A number between two of one sign, spread over their magnitudes as evenly as over their digits.
pub(super) fn of_any_magnitude(least: f64, most: f64, uniform: f64) -> f64 {
    least * (most / least).powf(uniform)
}
