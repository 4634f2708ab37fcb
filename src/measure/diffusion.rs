//! Diffusion coefficients from displacements and velocities.

use super::correlation::WindowedAverage;
use super::line::weighted_line;
use super::statistics::{Estimate, independent};
use std::ops::Range;

/// The least of the velocity autocorrelation that one sample may leave. An exponential is then integrated to 1 % by the trapezoidal rule, whose
/// error is (h/τ)²/12.
const KEPT_BY_A_SAMPLE: f64 = 0.7;
/// The most of it that may be left where a window ends, or a line begins: of an exponential it is what is missing of the coefficient.
const LEFT: f64 = 0.01;
/// How many of its standard errors more than that.
const LEFT_ERRORS: f64 = 2.0;
/// The most by which the slope of a line may change within it, and how many standard errors more.
const BEND: f64 = 0.05;
const BEND_ERRORS: f64 = 4.0;

/// Windows of the mean squared displacement and of the velocity autocorrelation of the same particles, sample by sample.
///
/// ```
/// use mesoscope::measure::correlation::WindowedAverage;
/// use mesoscope::measure::diffusion::{DiffusionError, DiffusionWindows};
///
/// // ⟨v(0)·v(t)⟩ = 3 exp(-2t), so ⟨Δr²⟩ = 3 (t - (1 - exp(-2t))/2), and D = ½.
/// let windows = |interval: f64, lags: u32| {
///     let times = || (0..lags).map(|lag| f64::from(lag) * interval);
///     let displacement: Vec<f64> = times().map(|time| 3.0 * (time - 0.5 * (1.0 - (-2.0 * time).exp()))).collect();
///     let velocity: Vec<f64> = times().map(|time| 3.0 * (-2.0 * time).exp()).collect();
///     let [displacement, velocity] = [displacement, velocity].map(|curve| WindowedAverage::from_samples(curve.len(),
/// &curve));
///     DiffusionWindows { displacement, velocity, interval, dimension: 3 }
/// };
/// let fine = windows(0.01, 1000);
/// assert!((fine.einstein()?.value - 0.5).abs() < 1e-3 && (fine.green_kubo()?.value - 0.5).abs() < 1e-4);
/// assert!(matches!(windows(1.0, 10).green_kubo(), Err(DiffusionError::Coarse { .. })));
/// assert!(matches!(windows(0.01, 100).einstein(), Err(DiffusionError::Short { .. })));
/// # Ok::<(), DiffusionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DiffusionWindows {
    /// The mean squared displacement since the window began.
    pub displacement: WindowedAverage,
    /// The mean product of the velocities now and when the window began.
    pub velocity: WindowedAverage,
    /// The time between two samples.
    pub interval: f64,
    /// The number of dimensions.
    pub dimension: usize,
}

/// Why no diffusion coefficient comes out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiffusionError {
    /// There is no full window, or it has fewer than four lags.
    #[error("there is no window of four samples")]
    Few,
    /// The velocity autocorrelation decays within a sample.
    #[error(
        "{:.0} % of the velocity autocorrelation are left after one sample, a time of {interval}, too few for its integral; sample more often \
         (smaller `output.diffusion.every`)", 100.0 * kept
    )]
    Coarse {
        /// What is left of it.
        kept: f64,
        /// The time between two samples.
        interval: f64,
    },
    /// The window ends before velocities are forgotten.
    #[error(
        "{:.1} % of the velocity autocorrelation are left after a time of {time}: the window is too short (larger `output.diffusion.window` or \
         `every`)", 100.0 * left
    )]
    Short {
        /// What is left of it.
        left: f64,
        /// When.
        time: f64,
    },
    /// The mean squared displacement does not grow linearly yet.
    #[error(
        "the slope of the mean squared displacement changes by {:.0} % within the second half of the window: particles do not diffuse yet \
         (larger `output.diffusion.window`)", 100.0 * change
    )]
    Bent {
        /// By what part of its mean the slope changes.
        change: f64,
    },
}

impl DiffusionWindows {
    /// Self-diffusion coefficient D = slope / 2d of the mean squared displacement in d dimensions.
    ///
    /// A line with free intercept (the ballistic start shifts it) is fitted to the second half of each window, with weights
    /// 1/t²: the scatter of a squared displacement grows like its mean. The fit is linear in the data, so the mean of the
    /// slopes is the slope of the mean. Where velocities decay exponentially, the slope at a time t lacks the part exp(-t/τ).
    ///
    /// # Errors
    /// [`DiffusionError`] where more than 1 % of the velocity autocorrelation is left in the second half of the window, or the
    /// displacement bends there, by more than what statistics explain.
    pub fn einstein(&self) -> Result<Estimate, DiffusionError> {
        let lags = self.displacement.lags();
        let start = lags.div_ceil(2);
        if lags < 4 {
            return Err(DiffusionError::Few);
        }
        self.check_forgotten(start)?;
        let slopes = self.slopes(start..lags).ok_or(DiffusionError::Few)?;
        let middle = usize::midpoint(start, lags);
        let halves = self.slopes(start..middle + 1).zip(self.slopes(middle..lags));
        let found = coefficient(&slopes)?;
        if let Some((early, late)) = halves.filter(|_| middle > start + 1) {
            let changes: Vec<f64> = early.iter().zip(&late).map(|(early, late)| late - early).collect();
            let change = coefficient(&changes)?;
            let excess = change.value.abs() - BEND_ERRORS * change.error.unwrap_or(f64::INFINITY);
            if excess > BEND * found.value.abs() {
                return Err(DiffusionError::Bent { change: (change.value / found.value).abs() });
            }
        }
        Ok(found)
    }

    /// Self-diffusion coefficient D = (1/d) ∫ ⟨v(0)·v(t)⟩ dt (Green and Kubo), by the trapezoidal rule up to the end of the window; what lies
    /// beyond is left out.
    ///
    /// # Errors
    /// [`DiffusionError`] where less than 70 % of the velocity autocorrelation is left after one sample, or significantly more than 1 % at
    /// the end of the window.
    pub fn green_kubo(&self) -> Result<Estimate, DiffusionError> {
        let lags = self.velocity.lags();
        let second = self.velocity.normalised().get(1).map(|second| second.value).ok_or(DiffusionError::Few)?;
        if second < KEPT_BY_A_SAMPLE {
            return Err(DiffusionError::Coarse { kept: second.max(0.0), interval: self.interval });
        }
        self.check_forgotten(lags - lags.div_ceil(8))?;
        let integral = |window: &[f64]| -> f64 { window.windows(2).map(|pair| f64::midpoint(pair[0], pair[1])).sum() };
        let scale = self.interval / self.dimension as f64;
        let values: Vec<f64> = self.velocity.windows().map(|window| integral(window) * scale).collect();
        coefficient(&values)
    }

    /// Half the slope of the displacement over some lags in each window, a dimension.
    fn slopes(&self, lags: Range<usize>) -> Option<Vec<f64>> {
        let slope = |window: &[f64]| {
            let points = lags.clone().zip(&window[lags.clone()]).map(|(lag, value)| {
                let time = lag as f64 * self.interval;
                (time, *value, 1.0 / (time * time))
            });
            Some(weighted_line(points)?.slope / (2.0 * self.dimension as f64))
        };
        self.displacement.windows().map(slope).collect()
    }

    /// Whether velocities are forgotten from a lag on.
    fn check_forgotten(&self, from: usize) -> Result<(), DiffusionError> {
        let Some(Estimate { value: left, error, .. }) = self.velocity.normalised_mean(from) else {
            return Err(DiffusionError::Few);
        };
        if left - LEFT_ERRORS * error.unwrap_or(0.0) > LEFT {
            return Err(DiffusionError::Short { left, time: from as f64 * self.interval });
        }
        Ok(())
    }
}

fn coefficient(values: &[f64]) -> Result<Estimate, DiffusionError> {
    independent(values).filter(|found| found.value.is_finite()).ok_or(DiffusionError::Few)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    fn gaussian(seed: u64, step: u64) -> f64 {
        noise::gaussian(noise::step_key(seed, 99, step))
    }

    /// Windows of curves, with the velocities of a fluid that forgets them at the rate of one.
    fn windows(curves: &[Vec<f64>], interval: f64, dimension: usize) -> DiffusionWindows {
        let lags = curves[0].len();
        let velocity: Vec<f64> = (0..lags).map(|lag| (-(lag as f64) * interval).exp()).collect();
        let [displacement, velocity] = [curves.concat(), velocity.repeat(curves.len())]
            .map(|samples| WindowedAverage::from_samples(lags, &samples));
        DiffusionWindows { displacement, velocity, interval, dimension }
    }

    #[test]
    fn diffusion_of_exact_curves() {
        let line = |slope: f64| (0..21).map(|lag| (slope * f64::from(lag) - 1.0).max(0.0)).collect::<Vec<f64>>();
        let found = windows(&[line(5.0), line(7.0)], 1.0, 3).einstein().unwrap();
        assert!((found.value - 1.0).abs() < 1e-12);
        // Of two values, 1 ± 1/6, with Student's factor of 1.837.
        assert!((found.error.unwrap() - 1.8367 / 6.0).abs() < 1e-3, "{found:?}");
        let none =
            DiffusionWindows { displacement: WindowedAverage::from_samples(21, &[]), ..windows(&[line(1.0)], 1.0, 3) };
        assert_eq!(none.einstein(), Err(DiffusionError::Few));
        assert_eq!(windows(&[vec![0.0; 3]], 9.0, 3).einstein(), Err(DiffusionError::Few));
    }

    #[test]
    fn diffusion_of_a_random_walk() {
        // 200 walkers in two dimensions, unit steps of variance 0.02 per axis: D = 0.01 per unit of time.
        let (walkers, lags) = (200_u64, 40_u64);
        let walk = |window: u64| {
            let mut sums = vec![0.0; lags as usize];
            for axis in 0..2 * walkers {
                let mut place = 0.0;
                for lag in 0..lags {
                    sums[lag as usize] += place * place / walkers as f64;
                    place += 0.02_f64.sqrt() * gaussian(axis, window * lags + lag);
                }
            }
            sums
        };
        let found = windows(&(0..50).map(walk).collect::<Vec<_>>(), 1.0, 2).einstein().unwrap();
        let error = found.error.unwrap();
        assert!((found.value - 0.01).abs() < 4.0 * error, "{found:?}");
        // A single window's slope scatters by a good part of 1/√walkers; over 50 windows a few percent at most.
        assert!(error > 1e-5 && error < 8e-4, "{found:?}");
    }

    /// ⟨v·v⟩ = 3 e^(-t) and its displacement, 6 (t - 1 + e^(-t)), of D = 1.
    fn exponential(interval: f64, lags: u32) -> DiffusionWindows {
        let time = |lag: u32| f64::from(lag) * interval;
        let displacement = (0..lags).map(|lag| 6.0 * (time(lag) - 1.0 + (-time(lag)).exp())).collect::<Vec<_>>();
        windows(&[displacement], interval, 3)
    }

    #[test]
    fn green_kubo_of_an_exponential() {
        let interval = 0.01;
        let mut fine = exponential(interval, 2001);
        fine.velocity = WindowedAverage::from_samples(
            2001,
            &fine.velocity.windows().flatten().map(|c| 3.0 * c).collect::<Vec<_>>(),
        );
        let found = fine.green_kubo().unwrap();
        // ∫ exp(-t) = 1; the trapezoidal rule adds h²/12, the cut takes e⁻²⁰.
        assert!((found.value - 1.0 - interval * interval / 12.0).abs() < 1e-8);
        assert_eq!(found.error, None);
        // At the limit the rule is 1 % off; beyond it there is no value.
        fine = exponential(0.35, 30);
        fine.dimension = 1;
        assert!((fine.green_kubo().unwrap().value - 1.0).abs() < 0.011);
        assert_eq!(
            exponential(0.4, 30).green_kubo().unwrap_err().to_string().split(';').next().unwrap(),
            "67 % of the velocity autocorrelation are left after one sample, a time of 0.4, too few for its integral"
        );
        assert!(matches!(exponential(0.1, 40).green_kubo(), Err(DiffusionError::Short { .. })));
    }

    /// What is left of the velocity is missing from the slope: 4 % in a window of 4.6 relaxation times.
    #[test]
    fn a_window_that_is_short_against_the_relaxation_gives_no_slope() {
        let short = exponential(0.077, 60);
        let error = short.einstein().unwrap_err();
        assert!(matches!(error, DiffusionError::Short { left, .. } if (left - 0.04).abs() < 0.01), "{error}");
        assert!((short.slopes(30..60).unwrap()[0] - 0.96).abs() < 0.01);
        let long = exponential(0.3, 60).einstein().unwrap();
        assert!((long.value - 1.0).abs() < 2e-3, "{long:?}");
    }

    /// Beads of a long chain: ⟨Δr²⟩ grows like √t while velocities are long forgotten.
    #[test]
    fn a_displacement_that_bends_gives_no_slope() {
        let curve = |window: u64| {
            let scatter = 1.0 + 0.02 * gaussian(3, window);
            (0..60).map(|lag| scatter * f64::from(lag).sqrt()).collect::<Vec<f64>>()
        };
        let curves: Vec<Vec<f64>> = (0..10).map(curve).collect();
        assert!(matches!(windows(&curves, 1.0, 3).einstein(), Err(DiffusionError::Bent { .. })));
    }
}
