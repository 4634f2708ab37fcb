//! Curves fitted to decays by nonlinear least squares.

use super::correlation::WindowedAverage;
use super::statistics::{Estimate, jackknife};
use crate::scene::DecayFit;

/// Steps of the solver after which a fit counts as failed.
const MOST_STEPS: usize = 500;
/// A step that changes the sum of squares by less than this part ends the search.
const TOLERANCE: f64 = 1e-14;
/// Most groups of windows, one of which is left out at a time for the errors.
const BLOCKS: usize = 20;

/// A curve fitted to a normalised autocorrelation.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedDecay {
    shape: DecayFit,
    values: Vec<f64>,
    /// Parameters in the order of the formula, by name. Errors come from a jackknife over windows; there are none with
    /// fewer than five.
    pub parameters: Vec<(&'static str, Estimate)>,
    /// Root of the mean squared deviation from the points.
    pub deviation: f64,
}

/// Why nothing was fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// No more points than parameters.
    #[error("a fit of {parameters} parameters needs more than {points} points")]
    TooFewPoints {
        /// Number of parameters.
        parameters: usize,
        /// Number of points.
        points: usize,
    },
    /// The points do not fall by as much as a tenth within the window.
    #[error("it does not decay within the window")]
    NoDecay,
    /// The points fall to a tenth before there is one for every parameter.
    #[error(
        "it falls to a tenth within {points} samples, fewer than the {parameters} parameters of the curve; sample it more often"
    )]
    Coarse {
        /// Number of parameters.
        parameters: usize,
        /// Samples before it has fallen to a tenth.
        points: usize,
    },
    /// The search does not end, or ends where a parameter is not determined.
    #[error("the points do not determine the parameters of the curve")]
    Undetermined,
}

impl FittedDecay {
    /// Fits a curve to the normalised autocorrelation of windows sampled every `interval` units of time.
    ///
    /// All lags have the same weight: neighbouring lags come from the same particles and err together, so that their
    /// own errors are no guide. The errors of the parameters come from leaving out one of up to 20 groups of windows at
    /// a time, which knows of all correlations.
    ///
    /// ```
    /// use mesoscope::measure::{correlation::WindowedAverage, fit::FittedDecay};
    /// use mesoscope::scene::DecayFit;
    ///
    /// let samples: Vec<f64> = (0..50).map(|lag| 8.0 * (-3.0 * 0.02 * f64::from(lag)).exp()).collect();
    /// let fit = FittedDecay::of_windows(&WindowedAverage::from_samples(50, &samples), 0.02, DecayFit::Exponential)?;
    /// let (name, rate) = fit.parameters[1];
    /// assert!(name == "b" && (rate.value - 3.0).abs() < 1e-6);
    /// assert!((fit.at(0.5) - (-1.5_f64).exp()).abs() < 1e-6);
    /// # Ok::<(), mesoscope::measure::fit::FitError>(())
    /// ```
    ///
    /// # Errors
    /// [`FitError`] where the points do not determine the curve.
    pub fn of_windows(average: &WindowedAverage, interval: f64, shape: DecayFit) -> Result<Self, FitError> {
        let curve = |windows: &[&[f64]]| -> Vec<[f64; 2]> {
            let mean = |lag: usize| windows.iter().map(|window| window[lag]).sum::<f64>();
            (0..average.lags()).map(|lag| [lag as f64 * interval, mean(lag) / mean(0)]).collect()
        };
        let windows: Vec<&[f64]> = average.windows().collect();
        let points = curve(&windows);
        let values = fit(&points, shape)?;
        let blocks = windows.len().min(BLOCKS);
        let replicates = (0..blocks).map(|block| {
            let left = windows.len() * block / blocks..windows.len() * (block + 1) / blocks;
            let kept: Vec<&[f64]> = [&windows[..left.start], &windows[left.end..]].concat();
            least_squares(&curve(&kept), shape, &values)
        });
        let replicates: Vec<Vec<f64>> = replicates.collect::<Option<_>>().unwrap_or_default();
        let parameters = names(shape).iter().enumerate().map(|(index, name)| {
            let column: Vec<f64> = replicates.iter().map(|values| values[index]).collect();
            (*name, jackknife(values[index], &column))
        });
        let parameters = parameters.collect();
        let deviation = (sum_of_squares(&points, shape, &values) / points.len() as f64).sqrt();
        Ok(Self { shape, values, parameters, deviation })
    }

    /// The curve at a time.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        value(self.shape, &self.values, time)
    }
}

/// The names of the parameters. Those of the damped oscillation are its rate a and the square of its frequency Ω.
fn names(shape: DecayFit) -> &'static [&'static str] {
    match shape {
        DecayFit::None => &[],
        DecayFit::Exponential => &["a", "b"],
        DecayFit::StretchedExponential => &["a", "b", "c"],
        DecayFit::DampedOscillation => &["a", "frequency_squared"],
    }
}

fn value(shape: DecayFit, parameters: &[f64], time: f64) -> f64 {
    match (shape, parameters) {
        (DecayFit::Exponential, &[a, b]) => a * (-b * time).exp(),
        (DecayFit::StretchedExponential, &[a, b, c]) => a * (-(b * time).powf(c)).exp(),
        (DecayFit::DampedOscillation, &[a, square]) => damped_oscillation(a, square, time),
        _ => f64::NAN,
    }
}

/// exp(-at/2) \[cos Ωt + (a/2Ω) sin Ωt\] for a positive, zero or negative square of Ω.
fn damped_oscillation(rate: f64, square: f64, time: f64) -> f64 {
    let half = 0.5 * rate * time;
    let angle = square.abs().sqrt() * time;
    if angle < 1e-4 {
        // To fourth order in the angle, 1e-16.
        let x = square * time * time;
        return (-half).exp() * (1.0 - 0.5 * x + half * (1.0 - x / 6.0));
    }
    if square > 0.0 {
        return (-half).exp() * (angle.cos() + half * angle.sin() / angle);
    }
    // Two exponentials, neither of which overflows where their product with the other does not.
    let ratio = half / angle;
    0.5 * ((1.0 + ratio) * (angle - half).exp() + (1.0 - ratio) * (-angle - half).exp())
}

fn sum_of_squares(points: &[[f64; 2]], shape: DecayFit, parameters: &[f64]) -> f64 {
    points.iter().map(|[time, found]| (value(shape, parameters, *time) - found).powi(2)).sum()
}

/// The best of the fits from several starts.
fn fit(points: &[[f64; 2]], shape: DecayFit) -> Result<Vec<f64>, FitError> {
    let parameters = names(shape).len();
    if points.len() <= parameters {
        return Err(FitError::TooFewPoints { parameters, points: points.len() });
    }
    let first = points[0][1];
    // NaN, of windows that hold nothing, does not decay either.
    if !points.iter().any(|[_, found]| *found < 0.9 * first) {
        return Err(FitError::NoDecay);
    }
    let before = points.iter().take_while(|[_, found]| *found > 0.1 * first).count();
    if before < parameters {
        return Err(FitError::Coarse { parameters, points: before });
    }
    let fits = starts(points, shape).into_iter().filter_map(|start| least_squares(points, shape, &start));
    let ranked = fits.map(|found| (sum_of_squares(points, shape, &found), found));
    ranked.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found).ok_or(FitError::Undetermined)
}

/// Where the search may begin: rates from the time at which the points have fallen to 1/e, frequencies from that at which
/// they first change sign.
fn starts(points: &[[f64; 2]], shape: DecayFit) -> Vec<Vec<f64>> {
    let last = points[points.len() - 1][0];
    let first_below = |level: f64| points.iter().find(|[_, found]| *found < level).map(|[time, _]| *time);
    let rate = 1.0 / first_below((-1.0_f64).exp()).unwrap_or(3.0 * last);
    match shape {
        DecayFit::None => Vec::new(),
        DecayFit::Exponential => vec![vec![1.0, rate]],
        DecayFit::StretchedExponential => [0.5, 1.0, 2.0].map(|power| vec![1.0, rate, power]).to_vec(),
        DecayFit::DampedOscillation => {
            let mut starts = Vec::new();
            if let Some(zero) = first_below(0.0) {
                let frequency = std::f64::consts::FRAC_PI_2 / zero;
                starts.extend([0.1, 0.5, 2.0].map(|share| vec![share * frequency, frequency * frequency]));
            }
            // Overdamped, it relaxes at about (a/2)² - Ω² over a.
            starts
                .extend([4.5, 10.0, 100.0].map(|ratio| vec![ratio * rate, rate * rate * ratio * (1.0 - ratio / 4.0)]));
            starts
        }
    }
}

/// The parameters with the least sum of squared deviations near a start: Marquardt, doi:10.1137/0111030. None if the
/// search does not end or the points do not determine a parameter there.
fn least_squares(points: &[[f64; 2]], shape: DecayFit, start: &[f64]) -> Option<Vec<f64>> {
    let mut parameters = start.to_vec();
    let mut least = sum_of_squares(points, shape, &parameters);
    let mut damping = 1e-3;
    for _ in 0..MOST_STEPS {
        let (matrix, slope) = normal_equations(points, shape, &parameters);
        let mut damped = matrix.clone();
        for (index, row) in damped.iter_mut().enumerate() {
            row[index] *= 1.0 + damping;
        }
        let step = solve(damped, slope)?;
        let trial: Vec<f64> = parameters.iter().zip(&step).map(|(value, change)| value + change).collect();
        let found = sum_of_squares(points, shape, &trial);
        // Where the curve is not a number, the step was too long.
        if found.is_nan() || found > least {
            damping *= 10.0;
            if damping > 1e12 {
                // No direction leads further down.
                return Some(parameters);
            }
            continue;
        }
        let done = least - found <= TOLERANCE * least;
        (parameters, least) = (trial, found);
        if done {
            return Some(parameters);
        }
        damping = (damping / 10.0).max(1e-12);
    }
    None
}

/// The matrix `JᵀJ` and the vector `-Jᵀr` of the deviations r with derivatives J, from central differences.
fn normal_equations(points: &[[f64; 2]], shape: DecayFit, parameters: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let count = parameters.len();
    let (mut matrix, mut slope) = (vec![vec![0.0; count]; count], vec![0.0; count]);
    let shifted = |index: usize, sign: f64| {
        let shift = 1e-6 * parameters[index].abs().max(1e-12);
        let mut shifted = parameters.to_vec();
        shifted[index] += sign * shift;
        (shifted, shift)
    };
    let shifts: Vec<_> = (0..count).map(|index| (shifted(index, 1.0), shifted(index, -1.0).0)).collect();
    for [time, found] in points {
        let deviation = value(shape, parameters, *time) - found;
        let derivatives = shifts.iter().map(|((up, shift), down)| {
            let derivative = (value(shape, up, *time) - value(shape, down, *time)) / (2.0 * shift);
            if derivative.is_finite() { derivative } else { 0.0 }
        });
        let derivatives: Vec<f64> = derivatives.collect();
        for row in 0..count {
            slope[row] -= derivatives[row] * deviation;
            for column in 0..count {
                matrix[row][column] += derivatives[row] * derivatives[column];
            }
        }
    }
    (matrix, slope)
}

/// Solves a symmetric positive system of a few unknowns by elimination; none where it is singular to rounding.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for pivot in 0..count {
        let scale = matrix[pivot][pivot];
        if scale.is_nan() || scale <= 0.0 {
            return None;
        }
        for row in pivot + 1..count {
            let factor = matrix[row][pivot] / scale;
            for column in pivot..count {
                matrix[row][column] -= factor * matrix[pivot][column];
            }
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    const INTERVAL: f64 = 0.1;
    const LAGS: usize = 80;

    /// Windows of a curve with independent noise of deviation `noise` on every lag but the first.
    fn windows(shape: DecayFit, parameters: &[f64], count: u64, noise: f64) -> WindowedAverage {
        let sample = |window: u64, lag: usize| {
            let random = noise::gaussian(noise::step_key(window, 77, lag as u64));
            let exact = value(shape, parameters, lag as f64 * INTERVAL);
            3.0 * (exact + if lag == 0 { 0.0 } else { noise * random })
        };
        let samples = (0..count).flat_map(|window| (0..LAGS).map(move |lag| sample(window, lag)));
        WindowedAverage::from_samples(LAGS, &samples.collect::<Vec<f64>>())
    }

    const CASES: &[(DecayFit, &[f64])] = &[
        (DecayFit::Exponential, &[1.0, 0.8]),
        (DecayFit::Exponential, &[1.0, 5.0]),
        (DecayFit::StretchedExponential, &[1.0, 0.7, 0.62]),
        (DecayFit::StretchedExponential, &[1.0, 0.9, 1.4]),
        (DecayFit::DampedOscillation, &[0.6, 4.0]),
        (DecayFit::DampedOscillation, &[2.0, 0.3]),
        (DecayFit::DampedOscillation, &[6.0, -5.0]),
    ];

    #[test]
    fn exact_curves_give_their_parameters_back() {
        for (shape, parameters) in CASES {
            let fit = FittedDecay::of_windows(&windows(*shape, parameters, 5, 0.0), INTERVAL, *shape).unwrap();
            for (found, exact) in fit.parameters.iter().zip(*parameters) {
                let (name, Estimate { value, .. }) = *found;
                assert!((value - exact).abs() < 1e-5 * exact.abs(), "{shape:?} {parameters:?}: {name} = {value}");
            }
            assert!(fit.deviation < 1e-7 && (fit.at(0.3) - value(*shape, parameters, 0.3)).abs() < 1e-6);
        }
    }

    #[test]
    fn noisy_curves_give_them_back_within_errors_that_are_the_true_ones() {
        for (shape, parameters) in CASES {
            let count = 40;
            let noise = 0.05;
            let fit = FittedDecay::of_windows(&windows(*shape, parameters, count, noise), INTERVAL, *shape).unwrap();
            // What noise on all points but the first makes of the parameters: A⁻¹ (A - jjᵀ) A⁻¹ times the variance of a
            // point, with A = JᵀJ and j the derivatives at the first point.
            let points: Vec<[f64; 2]> = (0..LAGS).map(|lag| [lag as f64 * INTERVAL, 0.0]).collect();
            let (matrix, _) = normal_equations(&points, *shape, parameters);
            let (first, _) = normal_equations(&points[..1], *shape, parameters);
            for (index, (name, found)) in fit.parameters.iter().enumerate() {
                let mut unit = vec![0.0; parameters.len()];
                unit[index] = 1.0;
                let column = solve(matrix.clone(), unit).unwrap();
                let known: f64 = (0..column.len())
                    .flat_map(|a| (0..column.len()).map(move |b| (a, b)))
                    .map(|(a, b)| column[a] * first[a][b] * column[b])
                    .sum();
                let variance = (column[index] - known) * noise * noise / count as f64;
                let (exact, error) = (variance.sqrt(), found.error.unwrap());
                // An error from 20 blocks is itself known to 1/√38.
                assert!((error / exact).ln().abs() < 4.0 / 38_f64.sqrt(), "{shape:?} {name}: {error} against {exact}");
                let off = (found.value - parameters[index]).abs();
                assert!(off < 4.0 * exact, "{shape:?} {name} = {} ± {exact}", found.value);
            }
            assert!((fit.deviation / (noise / (count as f64).sqrt()) - 1.0).abs() < 4.0 / (2.0 * LAGS as f64).sqrt());
        }
    }

    #[test]
    fn the_damped_oscillation_is_one_curve_across_the_aperiodic_limit() {
        for time in [0.0, 0.4, 3.0] {
            let [below, at, above] = [-1e-9, 0.0, 1e-9].map(|square| damped_oscillation(1.7, square, time));
            assert!((below - at).abs() < 1e-8 && (above - at).abs() < 1e-8, "{below} {at} {above}");
        }
        assert!((damped_oscillation(1.7, 0.0, 0.4) - (-0.34_f64).exp() * 1.34).abs() < 1e-15);
        // The differential equation C'' + aC' + (Ω² + a²/4) C = 0, by central differences.
        for (rate, square) in [(0.6, 4.0), (6.0, -5.0), (300.0, -22_000.0)] {
            let (time, h) = (0.02, 1e-5);
            let [before, now, after] = [-h, 0.0, h].map(|shift| damped_oscillation(rate, square, time + shift));
            let (velocity, second) = ((after - before) / (2.0 * h), (after - 2.0 * now + before) / (h * h));
            let rest = second + rate * velocity + (square + 0.25 * rate * rate) * now;
            assert!(rest.abs() < 1e-4 * (second.abs() + (rate * velocity).abs()) + 1e-4, "{rate} {square}: {rest}");
        }
    }

    #[test]
    fn what_cannot_be_fitted_says_why() {
        let constant = windows(DecayFit::Exponential, &[1.0, 0.0], 5, 0.0);
        for shape in [DecayFit::Exponential, DecayFit::StretchedExponential, DecayFit::DampedOscillation] {
            assert_eq!(FittedDecay::of_windows(&constant, INTERVAL, shape), Err(FitError::NoDecay));
        }
        let short = WindowedAverage::from_samples(3, &[3.0, 2.0, 1.0]);
        let error = FittedDecay::of_windows(&short, 1.0, DecayFit::StretchedExponential);
        assert_eq!(error, Err(FitError::TooFewPoints { parameters: 3, points: 3 }));
        let single = FittedDecay::of_windows(&short, 1.0, DecayFit::Exponential).unwrap();
        assert_eq!(single.parameters[0].1.error, None);
        assert_eq!(
            FittedDecay::of_windows(&WindowedAverage::from_samples(9, &[]), 1.0, DecayFit::Exponential),
            Err(FitError::NoDecay)
        );
    }
}
