//! Means with their errors, and what they have to be.

use mesoscope::measure::Observables;
use mesoscope::scene::Generator;

/// A standard Gaussian number for each pair of counters, apart from all that a run draws.
pub fn deviate(seed: u64, counters: [u32; 2]) -> f64 {
    let key = mesoscope::noise::seed_key(seed, u32::MAX);
    mesoscope::noise::gaussian(mesoscope::noise::words(Generator::Threefry2x32, key, counters))
}

/// A mean and its standard error.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    pub mean: f64,
    pub error: f64,
}

impl Measured {
    /// The mean of a correlated series, with its error.
    pub fn of(series: &[f64]) -> Self {
        let estimate = mesoscope::measure::statistics::estimate(series).expect("a series");
        Self { mean: estimate.value, error: estimate.error.expect("more than one sample") }
    }

    /// The mean of independent numbers.
    pub fn of_independent(numbers: &[f64]) -> Self {
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        let variance = numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / (count - 1.0);
        Self { mean, error: (variance / count).sqrt() }
    }

    /// The ratio of two means; its error to first order is that of the mean of (a - ⟨a⟩b/⟨b⟩)/⟨b⟩.
    pub fn ratio(above: &[f64], below: &[f64]) -> Self {
        let mean_below = below.iter().sum::<f64>() / below.len() as f64;
        let ratio = above.iter().sum::<f64>() / below.iter().sum::<f64>();
        let deviations: Vec<f64> = above.iter().zip(below).map(|(a, b)| (a - ratio * b) / mean_below).collect();
        Self { mean: ratio, error: Self::of(&deviations).error }
    }

    /// The mean is `expected` within `allowance` and four standard errors, which are at most `largest_error` each, so
    /// that the comparison says something.
    #[track_caller]
    pub fn assert(self, what: &str, expected: f64, allowance: f64, largest_error: f64) {
        let Self { mean, error } = self;
        println!("{what}: {mean:.5} ± {error:.5}, expected {expected} ± {allowance}");
        assert!(error <= largest_error, "{what}: the standard error {error} is larger than {largest_error}");
        let tolerance = allowance + 4.0 * error;
        assert!((mean - expected).abs() <= tolerance, "{what}: {mean} ± {error}, expected {expected} ± {allowance}");
    }
}

/// Kinetic temperature, configurational temperature and pressure of conservative forces over a series.
pub fn equilibrium(series: &[Observables]) -> [Measured; 3] {
    let column = |value: fn(&Observables) -> f64| -> Vec<f64> { series.iter().map(value).collect() };
    [
        Measured::of(&column(Observables::kinetic_temperature)),
        Measured::ratio(&column(|row| row.gradient_squared), &column(|row| row.laplacian)),
        Measured::of(&column(Observables::conservative_pressure)),
    ]
}

/// Slope of a straight line through (log x, log y): the order of an error y in a step x.
pub fn order(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let logs = || points.iter().map(|(x, y)| (x.ln(), y.ln()));
    let [mean_x, mean_y] = [logs().map(|p| p.0).sum::<f64>() / count, logs().map(|p| p.1).sum::<f64>() / count];
    let covariance: f64 = logs().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / logs().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
}
