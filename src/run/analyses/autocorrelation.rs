//! Normalised autocorrelations of velocities and forces, and the curves fitted to them.

use super::{Analysis, Conclusion, Setting, bytes, windows_missing};
use crate::engine::Sample;
use crate::measure::correlation::{Coefficient, WindowedAverage};
use crate::measure::fit::FittedDecay;
use crate::output::files;
use crate::plan::analyses::{autocorrelation_name, correlation_quantum};
use crate::scene::{self, CorrelatedQuantity, DecayFit};
use crate::table::Table;
use serde_json::{Map, Value, json};

/// Means over particles of products with the beginning of the window, sample by sample.
pub(super) struct Autocorrelation {
    asked: scene::Autocorrelation,
    particles: f64,
    interval: f64,
    scale: f64,
    products: Vec<f64>,
}

impl Autocorrelation {
    pub(super) fn new(setting: &Setting<'_>, asked: &scene::Autocorrelation) -> Self {
        Self {
            asked: asked.clone(),
            particles: setting.plan.particles as f64,
            interval: asked.every as f64 * setting.model.time_step,
            scale: correlation_quantum(setting.plan, asked.quantity),
            products: Vec::new(),
        }
    }

    fn window(&self) -> usize {
        self.asked.window as usize
    }

    /// The fit and its parameters; why there is none, if one was asked for.
    fn fit(&self, average: &WindowedAverage) -> (Option<FittedDecay>, Value, Vec<String>) {
        if self.asked.fit == DecayFit::None {
            return (None, Value::Null, Vec::new());
        }
        match FittedDecay::of_windows(average, self.interval, self.asked.fit) {
            Ok(fit) => {
                let parameters = fit.parameters.iter().map(|(name, found)| ((*name).to_owned(), json!(found)));
                let mut result = Map::new();
                result.insert("curve".to_owned(), json!(self.asked.fit));
                result.extend(parameters);
                result.insert("deviation".to_owned(), json!(fit.deviation));
                (Some(fit), Value::Object(result), Vec::new())
            }
            Err(error) => {
                let warning =
                    format!("nothing was fitted to the {} autocorrelation: {error}", self.asked.quantity.name());
                (None, Value::Null, vec![warning])
            }
        }
    }
}

impl Analysis for Autocorrelation {
    fn name(&self) -> &'static str {
        autocorrelation_name(self.asked.quantity)
    }

    fn add(&mut self, sample: &Sample) {
        let sum = sample.sums.first().map_or(f64::NAN, |sum| *sum as f64);
        self.products.push(sum * self.scale / self.particles);
    }

    fn section(&self) -> Vec<u8> {
        bytes(self.products.iter().copied())
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        samples
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.products = numbers.to_vec();
    }

    fn path(&self) -> String {
        format!("output.autocorrelations ({})", self.asked.quantity.name())
    }

    fn conclude(&self) -> Conclusion {
        let average = WindowedAverage::of(self.window(), &self.products);
        let (covariances, normalised) = (average.average(), average.normalised());
        let first = covariances.first().copied();
        let missing = windows_missing(&average, self.particles)
            .or_else(|| first.is_none_or(|first| first.mean <= 0.0).then(|| "it is zero for all particles".to_owned()));
        let (fit, fitted, warnings) = match missing {
            None => self.fit(&average),
            Some(_) => (None, Value::Null, Vec::new()),
        };
        let mut columns =
            ["time", "autocorrelation", "autocorrelation_error", "covariance", "covariance_error"].to_vec();
        columns.extend(fit.as_ref().map(|_| "fit"));
        let rows = normalised.iter().zip(&covariances).enumerate().map(|(lag, (normalised, covariance))| {
            let time = lag as f64 * self.interval;
            let [error, covariance_error] =
                [normalised, covariance].map(|average| average.standard_error.unwrap_or(f64::NAN));
            let mut row = vec![time, normalised.mean, error, covariance.mean, covariance_error];
            row.extend(fit.as_ref().map(|fit| fit.at(time)));
            row
        });
        let table = Table { columns: columns.into_iter().map(str::to_owned).collect(), rows: rows.collect() };
        let result = match (missing, first) {
            (None, Some(first)) => {
                let mean_square = Coefficient { value: first.mean, standard_error: first.standard_error };
                let mut result = json!({ "windows": average.windows().len(), "mean_square": mean_square });
                if self.asked.fit != DecayFit::None {
                    result["fit"] = fitted;
                }
                Ok(result)
            }
            (missing, _) => Err(missing.unwrap_or_default()),
        };
        let file = match self.asked.quantity {
            CorrelatedQuantity::Velocity => files::VELOCITY_AUTOCORRELATION,
            CorrelatedQuantity::Force => files::FORCE_AUTOCORRELATION,
        };
        Conclusion { warnings, ..Conclusion::new(file, table, result) }
    }
}
