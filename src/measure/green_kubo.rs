//! The shear viscosity from the autocorrelation of the stress.

use super::statistics::{Estimate, independent};

/// The least of the autocorrelation that a sample may leave, where samples are not those of every step: of an exponential 1 % is then missing.
const KEPT_BY_A_SAMPLE: f64 = 0.7;
/// The most that the second half of the lags may add, as a part of the viscosity, and how many of its standard errors more.
const GROWTH: f64 = 0.1;
const GROWTH_ERRORS: f64 = 4.0;

/// Blocks of time whose scatter gives the errors.
const BLOCKS: usize = 20;
/// Fewest blocks that give an error.
const FEWEST_BLOCKS: usize = 5;

/// The autocorrelation of the stress and its running sum, one value a lag.
#[derive(Debug, Clone, PartialEq)]
pub struct StressCorrelation {
    /// V/kT times the autocorrelation of a shear component.
    pub autocorrelation: Vec<Estimate>,
    /// The viscosity that its sum up to a lag gives.
    pub viscosity: Vec<Estimate>,
    /// What the second half of the lags adds to it.
    pub growth: Option<Estimate>,
}

/// Why no viscosity comes out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GreenKuboError {
    /// There are not twice as many samples as lags.
    #[error("the run is shorter than the longest lag")]
    Few,
    /// The stress decays within a sample.
    #[error(
        "{:.0} % of the autocorrelation of the stress are left after one sample, too few for its integral; sample more often (smaller \
         `output.stress.every`)", 100.0 * kept
    )]
    Coarse {
        /// What is left of it.
        kept: f64,
    },
    /// The integral still grows.
    #[error(
        "the second half of the lags adds {:.0} % to the viscosity: they are too short (larger `output.stress.window`)", 100.0 * part
    )]
    Short {
        /// What it adds, as a part of the viscosity.
        part: f64,
    },
}

impl StressCorrelation {
    /// The viscosity at the longest lag, from samples of every so many steps.
    ///
    /// # Errors
    /// [`GreenKuboError`] where samples that are further apart forget the stress, or the second half of the lags adds more than a tenth and
    /// than statistics explain.
    pub fn longest(&self, every: u64) -> Result<Estimate, GreenKuboError> {
        let found = *self.viscosity.last().ok_or(GreenKuboError::Few)?;
        if let [first, second, ..] = self.autocorrelation[..]
            && every > 1
            && second.value < KEPT_BY_A_SAMPLE * first.value
        {
            return Err(GreenKuboError::Coarse { kept: (second.value / first.value).max(0.0) });
        }
        if let Some(Estimate { value: growth, error: Some(error), .. }) = self.growth
            && growth.abs() - GROWTH_ERRORS * error > GROWTH * found.value.abs()
        {
            return Err(GreenKuboError::Short { part: growth / found.value });
        }
        Ok(found)
    }
}

/// Shear stresses with the same autocorrelation in an isotropic fluid, from a pressure tensor xx, yy, zz, xy, xz, yz: in three
/// dimensions xy, xz, yz, (xx - yy)/2 and (xx + yy - 2zz)/√12, in two xy and (xx - yy)/2.
///
/// ```
/// use mesoscope::measure::green_kubo::shear_stresses;
/// let tensor = [3.0, 1.0, -4.0, 0.1, 0.2, 0.3];
/// let [.., normal, last] = shear_stresses(&tensor, 3)[..] else { return };
/// assert!(normal == 1.0 && (last - 12.0 / 12.0_f64.sqrt()).abs() < 1e-15);
/// assert_eq!(shear_stresses(&tensor, 2), [0.1, 1.0]);
/// ```
#[must_use]
pub fn shear_stresses(pressure: &[f64; 6], dimension: usize) -> Vec<f64> {
    let [xx, yy, zz, xy, xz, yz] = *pressure;
    let normal = 0.5 * (xx - yy);
    if dimension == 3 { vec![xy, xz, yz, normal, (xx + yy - 2.0 * zz) / 12.0_f64.sqrt()] } else { vec![xy, normal] }
}

/// The autocorrelation of the shear stress in equilibrium up to a lag of so many samples, and the viscosity
/// η = V/kT Δt [C(0)/2 + Σ C(k)] that it adds up to (Green and Kubo). `factor` is V/kT, and the samples are `interval` apart.
///
/// Where samples are those of every step and hold all impulses of the step between particles, noise included, this is exactly half
/// the rate at which the squared flow of momentum across a plane grows (Helfand, doi:10.1103/PhysRev.119.1): C(0) then has the part
/// of the viscosity that the noise of a step makes alone. Jung and Schmid, doi:10.1063/1.4950760, say why noise belongs in it.
///
/// Components are averaged as in Daivis and Evans, doi:10.1063/1.466970. Errors come from the scatter of up to 20 blocks of time, at
/// least twice as long as the longest lag; there are none where fewer than five fit in. Empty if the series is no longer than the lag.
///
/// ```
/// use mesoscope::measure::green_kubo::stress_correlation;
/// use mesoscope::noise::{gaussian, step_key};
///
/// // Independent stresses of variance 6, as of noise alone, every .1: η = 2 · .1 · 6/2.
/// let tensor = |step: u64| [0, 1, 2, 3, 4, 5].map(|part| {
///     let scale = if part < 3 { 12.0_f64.sqrt() } else { 6.0_f64.sqrt() };
///     scale * gaussian(step_key(1, 90 + part, step))
/// });
/// let series: Vec<[f64; 6]> = (0..20_000).map(tensor).collect();
/// let found = stress_correlation(&series, 3, 2.0, 0.1, 4);
/// let viscosity = found.longest(1)?;
/// assert_eq!(found.viscosity.len(), 5);
/// // The sum of four products of independent numbers scatters by 2 · .1 · 6 · √(4/100 000).
/// assert!((viscosity.value - 0.6).abs() < 4.0 * 0.0076, "{viscosity:?}");
/// # Ok::<(), mesoscope::measure::green_kubo::GreenKuboError>(())
/// ```
#[must_use]
pub fn stress_correlation(
    series: &[[f64; 6]],
    dimension: usize,
    factor: f64,
    interval: f64,
    longest_lag: usize,
) -> StressCorrelation {
    let lags = longest_lag + 1;
    let wanted = (series.len() / (2 * lags)).min(BLOCKS);
    let blocks = if wanted < FEWEST_BLOCKS { 1 } else { wanted };
    let length = series.len() / blocks;
    let mut found = StressCorrelation { autocorrelation: Vec::new(), viscosity: Vec::new(), growth: None };
    if length < lags {
        return found;
    }
    let correlations: Vec<Vec<f64>> =
        series.chunks_exact(length).take(blocks).map(|block| autocorrelation(block, dimension, lags)).collect();
    let mut sums = vec![0.0; correlations.len()];
    let mut half = sums.clone();
    for lag in 0..lags {
        let weight = if lag == 0 { 0.5 } else { 1.0 };
        let here: Vec<f64> = correlations.iter().map(|correlation| factor * correlation[lag]).collect();
        sums.iter_mut().zip(&here).for_each(|(sum, value)| *sum += weight * interval * value);
        for (values, averages) in [(&here, &mut found.autocorrelation), (&sums, &mut found.viscosity)] {
            averages.extend(independent(values));
        }
        if lag == longest_lag / 2 {
            half.clone_from(&sums);
        }
    }
    let growth: Vec<f64> = sums.iter().zip(&half).map(|(all, half)| all - half).collect();
    found.growth = independent(&growth);
    found
}

/// The autocorrelation of one block, all its samples taken as origins, averaged over the shear components.
fn autocorrelation(block: &[[f64; 6]], dimension: usize, lags: usize) -> Vec<f64> {
    let rows: Vec<Vec<f64>> = block.iter().map(|pressure| shear_stresses(pressure, dimension)).collect();
    let components = rows.first().map_or(0, Vec::len);
    let series: Vec<Vec<f64>> = (0..components).map(|index| rows.iter().map(|row| row[index]).collect()).collect();
    let at = |lag: usize| {
        let products = series.iter().map(|values| values.iter().zip(&values[lag..]).map(|(a, b)| a * b).sum::<f64>());
        products.sum::<f64>() / (components * (block.len() - lag)) as f64
    };
    (0..lags).map(at).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    /// Stresses that forget at the rate of one: the sum of C = exp(-kΔt) is Δt/2 (1 + e)/(1 - e), e = exp(-Δt), close to one.
    #[test]
    fn an_exponential_correlation_adds_up() {
        let (interval, samples) = (0.1_f64, 40_000_u64);
        let memory = (-interval).exp();
        let mut tensor = [0.0; 6];
        let series: Vec<[f64; 6]> = (0..samples)
            .map(|step| {
                for (part, value) in tensor.iter_mut().enumerate() {
                    let scale = if part < 3 { 2.0_f64.sqrt() } else { 1.0 };
                    let number = noise::gaussian(noise::step_key(7, 90 + part as u32, step));
                    *value = memory * *value + (1.0 - memory * memory).sqrt() * scale * number;
                }
                tensor
            })
            .collect();
        let found = stress_correlation(&series, 3, 1.0, interval, 80);
        let exact = 0.5 * interval * (1.0 + memory) / (1.0 - memory);
        let viscosity = found.longest(10).unwrap();
        // The sum up to a lag t scatters by 2√(t/T) of itself, T = 4000 for each of five components.
        let scatter = 2.0 * (8.0_f64 / (5.0 * 4000.0)).sqrt();
        assert!((viscosity.value - exact).abs() < 4.0 * scatter, "{viscosity:?} against {exact}");
        let error = viscosity.error.unwrap();
        // Of 20 blocks: known to 16 %.
        assert!(error < 1.64 * scatter && error > 0.2 * scatter, "{error} against {scatter}");
        assert!((found.autocorrelation[0].value - 1.0).abs() < 0.1);
        assert!((found.autocorrelation[10].value - (-1.0_f64).exp()).abs() < 0.1);
        // Of a lag of one relaxation time, e^(-1/2) - e^(-1) of 1 - e^(-1) comes from the second half; samples ten times as far apart forget.
        let short = stress_correlation(&series, 3, 1.0, interval, 10);
        let part = ((-0.5_f64).exp() - (-1.0_f64).exp()) / (1.0 - (-1.0_f64).exp());
        let error = short.longest(1).unwrap_err();
        assert!(matches!(error, GreenKuboError::Short { part: found } if (found - part).abs() < 0.04), "{error}");
        let coarse: Vec<[f64; 6]> = series.iter().step_by(10).copied().collect();
        let coarse = stress_correlation(&coarse, 3, 1.0, 10.0 * interval, 8);
        assert!(matches!(coarse.longest(10), Err(GreenKuboError::Coarse { kept }) if (kept - 0.37).abs() < 0.05));
        assert!(coarse.longest(1).is_ok());
    }

    #[test]
    fn short_series() {
        let series = vec![[1.0; 6]; 10];
        assert_eq!(stress_correlation(&series, 2, 1.0, 1.0, 10).longest(1), Err(GreenKuboError::Few));
        let one = stress_correlation(&series, 2, 1.0, 1.0, 4);
        assert_eq!((one.viscosity.len(), one.longest(1).unwrap().error), (5, None));
    }
}
