//! Whatever acts on particles: half kicks of each term, and what its baths remember.

pub(super) mod angles;
pub(super) mod bonds;
pub(super) mod coloured_noise;
pub(super) mod pair_list;
pub(super) mod pairs;
pub(super) mod position_baths;
pub(super) mod tethers;

use super::pairs::MOST_UNITS;

/// Adds an impulse to that of one particle, rounded half to even to whole units.
fn push(sum: &mut [i64; 3], impulse: [f64; 3], unit: f64) {
    for axis in 0..3 {
        sum[axis] += (impulse[axis] / unit).round_ties_even().clamp(-MOST_UNITS, MOST_UNITS) as i64;
    }
}
