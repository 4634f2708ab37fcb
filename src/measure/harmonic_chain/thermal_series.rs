//! Averages over a chain of clusters in equilibrium.

use crate::measure::statistics::{Estimate, estimate};

/// Displacements and momenta of all clusters of one chain at equal intervals of time.
///
/// Every normal mode of a chain without friction keeps its energy, so that the average over any time is not the canonical
/// one: what counts as independent is clusters that are far apart. Averages over time are taken of each cluster first,
/// and errors then from blocks of clusters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ThermalSeries {
    clusters: usize,
    /// Sample after sample, the momenta of all clusters.
    momenta: Vec<f64>,
    /// For every pair of neighbours, the sum of `(X_{μ+1} - X_μ)²` over the samples.
    separations: Vec<f64>,
    /// Means of P² and of `(X_{μ+1} - X_μ)²` over the chain, sample after sample.
    pub(crate) history: Vec<[f64; 2]>,
}

/// What a series amounts to.
#[derive(Debug, Clone, PartialEq)]
pub struct ThermalEstimates {
    /// ⟨P²⟩.
    pub momentum_variance: Option<Estimate>,
    /// The variance of `X_{μ+1} - X_μ`.
    pub separation_variance: Option<Estimate>,
}

impl ThermalSeries {
    /// An empty series of a chain of clusters.
    #[must_use]
    pub fn new(clusters: usize) -> Self {
        Self { clusters, separations: vec![0.0; clusters.saturating_sub(1)], ..Self::default() }
    }

    /// The series of samples of which these numbers are known: one after the other the momenta of all clusters, the
    /// sums of
    /// `(X_{μ+1} - X_μ)²` of all pairs of neighbours, and one after the other the means over the chain of P² and of
    /// `(X_{μ+1} - X_μ)²`.
    pub(crate) fn from_parts(momenta: &[f64], separations: &[f64], history: &[[f64; 2]]) -> Self {
        let clusters = momenta.len().checked_div(history.len()).unwrap_or(0);
        Self { clusters, momenta: momenta.to_vec(), separations: separations.to_vec(), history: history.to_vec() }
    }

    /// The numbers that a sample adds to those of [`Self::from_parts`]: its momenta, the squares of its pairs, and the
    /// two means.
    pub(crate) fn numbers_of(displacements: &[f64], momenta: &[f64]) -> Vec<f64> {
        let squares: Vec<f64> =
            displacements.windows(2).map(|pair| (pair[1] - pair[0]) * (pair[1] - pair[0])).collect();
        let momentum: f64 = momenta.iter().map(|momentum| momentum * momentum).sum();
        let means = [momentum / momenta.len() as f64, squares.iter().sum::<f64>() / squares.len() as f64];
        [momenta, &squares, &means].concat()
    }

    /// Adds a sample. What does not have one number for each cluster is left out.
    pub fn push(&mut self, displacements: &[f64], momenta: &[f64]) {
        if displacements.len() != self.clusters || momenta.len() != self.clusters {
            return;
        }
        let numbers = Self::numbers_of(displacements, momenta);
        let (momenta, rest) = numbers.split_at(self.clusters);
        let (squares, means) = rest.split_at(self.separations.len());
        self.momenta.extend_from_slice(momenta);
        self.separations.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square);
        self.history.extend_from_slice(means.as_chunks().0);
    }

    /// Averages over time and clusters.
    #[must_use]
    pub fn estimates(&self) -> ThermalEstimates {
        let samples = self.history.len() as f64;
        let separations: Vec<f64> = self.separations.iter().map(|sum| sum / samples).collect();
        let products = self.products(0, self.history.len());
        ThermalEstimates { momentum_variance: estimate(&products), separation_variance: estimate(&separations) }
    }

    /// ⟨P(0)P(t)⟩ with t = 0, 1, … `lags` - 1 intervals, averaged over clusters and, for each lag alike, over the
    /// origins from which the largest lag is within the series. Empty if there is none.
    #[must_use]
    pub fn momentum_correlation(&self, lags: usize) -> Vec<Estimate> {
        let Some(origins) = (self.history.len() + 1).checked_sub(lags).filter(|origins| *origins > 0) else {
            return Vec::new();
        };
        (0..lags).filter_map(|lag| estimate(&self.products(lag, origins))).collect()
    }

    /// For each cluster, the mean of P(0)P(lag) over the first origins.
    fn products(&self, lag: usize, origins: usize) -> Vec<f64> {
        let mut products = vec![0.0; self.clusters];
        let width = self.clusters.max(1);
        let later = self.momenta.get(lag * width..).unwrap_or_default().chunks_exact(width);
        for (now, later) in self.momenta.chunks_exact(width).zip(later).take(origins) {
            for ((product, now), later) in products.iter_mut().zip(now).zip(later) {
                *product += now * later / origins as f64;
            }
        }
        products
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::{HarmonicChain, SpringChain};
    use crate::measure::harmonic_chain::{NormalModes, equilibrium, thermal_start};
    use rand::{RngExt, SeedableRng, rngs::StdRng};

    fn gaussian(rng: &mut StdRng) -> f64 {
        let uniform = 1.0 - rng.random::<f64>();
        (-2.0 * uniform.ln()).sqrt() * (std::f64::consts::TAU * rng.random::<f64>()).cos()
    }

    #[test]
    fn averages_by_hand() {
        let mut series = ThermalSeries::new(2);
        series.push(&[0.0, 1.0], &[1.0, 2.0]);
        series.push(&[0.0, 3.0], &[3.0, -1.0]);
        series.push(&[0.0], &[3.0]);
        assert_eq!(series.history, [[2.5, 1.0], [5.0, 9.0]]);
        let estimates = series.estimates();
        assert_eq!(estimates.momentum_variance.unwrap().value, 3.75);
        assert_eq!(estimates.separation_variance.unwrap().value, 5.0);
        let correlation: Vec<f64> = series.momentum_correlation(2).iter().map(|lag| lag.value).collect();
        assert_eq!(correlation, [2.5, 0.5]);
        assert!(series.momentum_correlation(3).is_empty());
        assert_eq!(ThermalSeries::from_parts(&series.momenta, &series.separations, &series.history), series);
        assert!(ThermalSeries::new(0).estimates().momentum_variance.is_none());
    }

    /// A frictionless chain, moved exactly: variances and correlations within 4 standard errors of the exact ones, and
    /// the errors as large as they have to be. The energies of about N' modes are all that counts, so the error of ⟨P²⟩
    /// is near √(1/N') however long the series is.
    #[test]
    fn errors_come_from_clusters_and_not_from_time() {
        let clusters = 512;
        let layout = HarmonicChain { clusters, cluster_size: 4, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };
        let chain: SpringChain = layout.frictionless();
        let modes = NormalModes::new(chain);
        let mut rng = StdRng::seed_from_u64(3);
        let start = thermal_start(&chain, 2.0, || gaussian(&mut rng));
        let mut series = ThermalSeries::new(clusters);
        let interval = 0.5 * layout.cluster_time();
        for sample in 0..40 {
            let (x, p) = modes.evolved(&start.0, &start.1, interval * f64::from(sample));
            series.push(&x, &p);
        }
        let estimates = series.estimates();
        let within = |found: Estimate, exact: f64| {
            let error = found.error.unwrap();
            assert!((found.value - exact).abs() < 4.0 * error, "{found:?}, {exact}");
            error / exact
        };
        let exact = equilibrium::momentum_variance(&layout, 2.0);
        let error = within(estimates.momentum_variance.unwrap(), exact);
        assert!((0.5..2.0).contains(&(error * (clusters as f64).sqrt())), "{error}");
        within(estimates.separation_variance.unwrap(), equilibrium::separation_variance(&chain, 2.0));
        let times: Vec<f64> = (0..8).map(|lag| interval * f64::from(lag)).collect();
        for (found, expected) in
            series.momentum_correlation(8).into_iter().zip(modes.momentum_autocorrelation(1, &times))
        {
            let error = found.error.unwrap();
            assert!((found.value - exact * expected).abs() < 4.0 * error, "{found:?}, {}", exact * expected);
            assert!(error < 0.1 * exact);
        }
    }
}
