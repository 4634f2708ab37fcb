//! Wave vectors of a periodic box.

use crate::noise::{direction, pcg4d};
use std::collections::HashSet;
use std::f64::consts::TAU;

/// The waves along an axis up to which all wave vectors are looked at, in one, two and three dimensions.
const REACH: [i32; 3] = [4096, 256, 24];

/// Wave vectors of a periodic box by their magnitude, in bins of equal width up to `range`: of each no more than `most`, chosen at random and
/// always alike. They are in waves along each axis, one of every two that point against each other. An axis without a length has none.
///
/// ```
/// use mesoscope::measure::wave_vectors::{wave_number, wave_vectors};
///
/// let edges = [Some(10.0), Some(10.0), None];
/// let bins = wave_vectors(edges, 1.0, 10, 8);
/// // The shortest are 2π/10 = 0.628, along each axis; the next 0.889, along the diagonals.
/// assert_eq!(bins[6], [[0, 1, 0], [1, 0, 0]]);
/// assert_eq!(bins[8], [[1, -1, 0], [1, 1, 0]]);
/// assert_eq!(bins.concat().len(), 4);
/// assert!((wave_number([1, 1, 0], edges) - 0.8886).abs() < 1e-4);
/// ```
#[must_use]
pub fn wave_vectors(edges: [Option<f64>; 3], range: f64, bins: u32, most: u32) -> Vec<Vec<[i32; 3]>> {
    let width = range / f64::from(bins);
    let bin_of = |waves: [i32; 3]| (wave_number(waves, edges) / width) as usize;
    let periodic = edges.iter().flatten().count();
    let Some(reach) = periodic.checked_sub(1).map(|place| REACH[place]) else { return vec![Vec::new(); bins as usize] };
    // A longer axis has more waves up to the range.
    let longest = edges.iter().flatten().fold(0.0_f64, |longest, edge| longest.max(*edge));
    let complete = f64::from(reach + 1) * TAU / longest;
    let ends = edges.map(|edge| edge.map_or(0, |edge| reach.min((range * edge / TAU) as i32)));
    let mut found = vec![Vec::new(); bins as usize];
    for x in -ends[0]..=ends[0] {
        for y in -ends[1]..=ends[1] {
            for z in -ends[2]..=ends[2] {
                let waves = [x, y, z];
                if let Some(bin) = found.get_mut(bin_of(waves)).filter(|_| is_first(waves)) {
                    bin.push(waves);
                }
            }
        }
    }
    for (bin, all) in found.iter_mut().enumerate() {
        let random = |waves: &[i32; 3]| pcg4d([waves[0] as u32, waves[1] as u32, waves[2] as u32, bin as u32]);
        all.sort_by_key(random);
        all.truncate(most as usize);
        if (bin + 1) as f64 * width > complete {
            // A shell of more than can be looked at has those next to points spread at random in it.
            let mut taken: HashSet<[i32; 3]> = all.iter().copied().collect();
            for words in (0..8 * most).map(|point| pcg4d([point, bin as u32, 0, 1])) {
                let way = direction([words[0], words[1]], periodic);
                let magnitude = (bin as f64 + f64::from(words[2]) / 2_f64.powi(32)) * width;
                let mut ways = way.into_iter();
                let waves = edges.map(|edge| match edge {
                    Some(edge) => (ways.next().unwrap_or(0.0) * magnitude * edge / TAU).round() as i32,
                    None => 0,
                });
                let waves = if is_first(waves) { waves } else { waves.map(|count| -count) };
                if all.len() < most as usize && is_first(waves) && bin_of(waves) == bin && taken.insert(waves) {
                    all.push(waves);
                }
            }
        }
        all.sort_unstable();
    }
    found
}

/// True for one of every two that point against each other; false for none at all.
fn is_first(waves: [i32; 3]) -> bool {
    waves.into_iter().find(|count| *count != 0).is_some_and(|first| first > 0)
}

/// The wave number of waves along each axis.
#[must_use]
pub fn wave_number(waves: [i32; 3], edges: [Option<f64>; 3]) -> f64 {
    let square = |axis: usize| edges[axis].map_or(0.0, |edge| (TAU * f64::from(waves[axis]) / edge).powi(2));
    (0..3).map(square).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where all are looked at, a bin without a limit has every lattice vector of its shell; beyond, those that are found are in their bins, each once,
    /// and in all directions.
    #[test]
    fn bins_hold_what_their_shells_hold() {
        let edges = [Some(8.0), Some(9.0), Some(7.5)];
        let bins = wave_vectors(edges, 8.0, 40, 100_000);
        let count: usize = bins.iter().map(Vec::len).sum();
        // Half of the ball of radius 8, in volumes (2π)³/V of a vector.
        let ball = 0.5 * 4.0 / 3.0 * std::f64::consts::PI * 512.0 * (8.0 * 9.0 * 7.5) / TAU.powi(3);
        assert!((count as f64 / ball - 1.0).abs() < 0.02, "{count} of {ball}");
        let far = wave_vectors([Some(100.0); 3], 30.0, 50, 64);
        for (bin, waves) in far.iter().enumerate().skip(1) {
            assert!(waves.len() > 48, "{bin}: {}", waves.len());
            let distinct: HashSet<_> = waves.iter().collect();
            assert_eq!(distinct.len(), waves.len());
            for waves in waves {
                let place = wave_number(*waves, [Some(100.0); 3]) / 0.6;
                assert!(place >= bin as f64 && place < (bin + 1) as f64 && is_first(*waves), "{waves:?}");
            }
            // Every octant has a quarter of half of all directions.
            let upper = waves.iter().filter(|waves| waves[1] > 0 && waves[2] > 0).count();
            assert!(upper > 3 && upper < 40, "{bin}: {upper}");
        }
        assert!(wave_vectors([None; 3], 8.0, 4, 10).concat().is_empty());
    }
}
