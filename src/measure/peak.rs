//! The maximum of a curve that is known in bins.

/// Bins on each side of the highest that a parabola is fitted to: noise makes the highest single bin too high.
const PEAK_BINS: usize = 4;

/// Place and height of the maximum of (x, y) rows; none without a positive value, nor where the last bins are the highest: what lies
/// beyond the range may be higher. Near contact the highest bin is taken.
pub(crate) fn peak(rows: &[[f64; 2]]) -> Option<[f64; 2]> {
    let highest =
        (0..rows.len()).filter(|bin| rows[*bin][1] > 0.0).max_by(|a, b| rows[*a][1].total_cmp(&rows[*b][1]))?;
    let plain = Some([rows[highest][0], rows[highest][1]]);
    let Some(first) = highest.checked_sub(PEAK_BINS) else { return plain };
    let window = rows.get(first..=highest + PEAK_BINS)?;
    // Least squares in units of bins from the middle, where odd moments vanish.
    let half = PEAK_BINS as f64;
    let offsets = || (0..window.len()).map(|bin| bin as f64 - half);
    let moment = |power: i32| offsets().map(|x| x.powi(power)).sum::<f64>();
    let product = |power: i32| offsets().zip(window).map(|(x, row)| x.powi(power) * row[1]).sum::<f64>();
    let (count, second, fourth) = (window.len() as f64, moment(2), moment(4));
    let curvature = (count * product(2) - second * product(0)) / (count * fourth - second * second);
    let level = (product(0) - curvature * second) / count;
    let slope = product(1) / second;
    let top = -slope / (2.0 * curvature);
    if curvature < 0.0 && top.abs() <= half {
        let bin = window[1][0] - window[0][0];
        Some([rows[highest][0] + top * bin, level + 0.5 * slope * top])
    } else {
        plain
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_peak_of_a_parabola_is_found_between_bins() {
        let rows: Vec<[f64; 2]> = (0..40)
            .map(|bin| 0.02 * (f64::from(bin) + 0.5))
            .map(|x| [x, 1.2 - 3.0 * (x - 0.433_f64).powi(2)])
            .collect();
        let [place, height] = peak(&rows).unwrap();
        assert!((place - 0.433).abs() < 1e-12 && (height - 1.2).abs() < 1e-12, "{place} {height}");
        assert_eq!(peak(&[[1.0, 2.0], [2.0, 1.0]]), Some([1.0, 2.0]));
        assert_eq!(peak(&[[1.0, 0.0]]), None);
        let rising: Vec<[f64; 2]> = (0..20).map(|bin| [f64::from(bin), f64::from(bin)]).collect();
        assert_eq!(peak(&rising), None);
        assert_eq!(peak(&[[1.0, f64::NAN]]), None);
    }
}
