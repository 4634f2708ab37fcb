//! Normalised autocorrelations of velocities and forces, and the curves fitted to them.

use super::{
    Conclusion, Descriptor, Drawn, Gathered, Part, Planner, Sampling, Setting, SumSampler, found, of_species,
    windows_missing,
};
use crate::engine::Sample;
use crate::families::Checked;
use crate::measure::correlation::WindowedAverage;
use crate::measure::fit::FittedDecay;
use crate::plan::{Need, Plan, Window};
use crate::plot::{Chart, autocorrelation_chart};
use crate::scene::{self, AnalysisId, CorrelatedQuantity, DecayFit, Output};
use crate::shaders::analyses::Sampled;
use crate::shaders::{Array, Choices, Constant, Entry};
use crate::table::Table;
use serde_json::{Value, json};

const MEAN_SQUARE: &str = "mean_square";

/// The autocorrelation of a quantity.
pub(super) struct Autocorrelation(pub CorrelatedQuantity);

impl Autocorrelation {
    fn of<'a>(&self, output: &'a Output) -> Option<&'a scene::Autocorrelation> {
        output.autocorrelations.iter().find(|asked| asked.quantity == self.0)
    }
}

impl Descriptor for Autocorrelation {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let asked = self.of(&scene.output)?;
        Some(Sampling::after_equilibration(scene, asked.every).in_windows(asked.window))
    }

    fn needs(&self, _: &Output) -> &'static [Need] {
        match self.0 {
            CorrelatedQuantity::Velocity => &[Need::Particles, Need::Momenta],
            CorrelatedQuantity::Force => &[Need::Particles, Need::Forces],
        }
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = self.of(planner.output) else { return };
        let unit = match self.0 {
            CorrelatedQuantity::Velocity => planner.model.units.momentum,
            CorrelatedQuantity::Force => planner.plan.force_unit,
        };
        let quantum = quantum(planner.plan, self.0);
        let (choices, before, [origins, sums, samples]) = match self.0 {
            CorrelatedQuantity::Velocity => {
                let (velocities, before) = planner.velocities(asked.frame);
                (velocities, before, [Array::VelocityOrigins, Array::VelocityProducts, Array::VelocityProductSamples])
            }
            CorrelatedQuantity::Force => {
                let names = [Array::ForceOrigins, Array::ForceProducts, Array::ForceProductSamples];
                (Choices::new().with(Sampled::Force), Vec::new(), names)
            }
        };
        let (particles, species) = planner.particles_of(asked.species.as_deref());
        let bytes = 16 * planner.plan.particles;
        planner.plan.add_buffer(origins, bytes);
        let id = AnalysisId::Autocorrelation(self.0);
        planner.add_sums(&SumSampler {
            choices: choices.with_any(particles),
            constants: [(Constant::Window, asked.window as f64), (Constant::Product, unit * unit / quantum)]
                .into_iter()
                .chain(species)
                .collect(),
            renamed: vec![(Array::Origins, origins)],
            before,
            window: Some(Window { buffer: origins, samples: asked.window.max(1) }),
            ..SumSampler::new(id, Entry::CorrelateVectors, [sums, samples], 1, asked.every)
        });
    }

    fn parts(&self, _: &Checked) -> Vec<Part> {
        // Means over the particles that can move of products with the beginning of the window.
        vec![Part::series(1)]
    }

    fn numbers_of_sample(&self, Setting { scene, plan }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let species = self.of(&scene.output)?.species.as_deref();
        let particles = scene.model().mobile_particles_of(species) as f64;
        let mean = |sum: &i64| *sum as f64 * quantum(plan, self.0) / particles;
        Some(sample.sums.iter().map(mean).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = self.of(&scene.output)?;
        let interval = asked.every as f64 * model.time_step;
        let average = WindowedAverage::from_samples(asked.window as usize, gathered.part(0));
        let (covariances, normalised) = (average.average(), average.normalised());
        let first = covariances.first().copied();
        let missing = windows_missing(&average, model, asked.species.as_deref()).or_else(|| {
            first.is_none_or(|first| first.value <= 0.0).then(|| "it is zero for all particles".to_owned())
        });
        let is_fitted = asked.fit != DecayFit::None;
        let fit = (is_fitted && missing.is_none()).then(|| FittedDecay::of_windows(&average, interval, asked.fit));
        let warnings = fit
            .as_ref()
            .and_then(|fit| fit.as_ref().err())
            .map(|error| format!("no curve was fitted to the {} autocorrelation: {error}", asked.quantity));
        let fit = fit.and_then(Result::ok);
        let columns = ["time", "autocorrelation", "autocorrelation_error", "covariance", "covariance_error"];
        let columns = columns.into_iter().chain(fit.as_ref().map(|_| "fit"));
        let rows = normalised.iter().zip(&covariances).enumerate().map(|(lag, (normalised, covariance))| {
            let time = lag as f64 * interval;
            let mut row = [&[time], [normalised.cells(), covariance.cells()].as_flattened()].concat();
            row.extend(fit.as_ref().map(|fit| fit.at(time)));
            row
        });
        let table = Table::new(columns, rows.collect());
        let result = match (missing, first) {
            (None, Some(first)) => {
                let result = json!({ "windows": average.windows().len(), MEAN_SQUARE: first });
                let mut result = of_species(asked.species.as_deref(), result);
                if is_fitted {
                    result["fit"] = json!(fit.map(|fit| parameters(&fit, asked.fit)));
                }
                Ok(result)
            }
            (missing, _) => Err(missing.unwrap_or_default()),
        };
        Some(Conclusion { warnings: warnings.into_iter().collect(), ..Conclusion::new(table, result) })
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let [lags, values, errors, fit] =
            ["time", "autocorrelation", "autocorrelation_error", "fit"].map(|name| drawn.column(name));
        let fitted = (formula(&drawn.result["fit"]), fit);
        let measured = (&lags[..], &values[..], &errors[..]);
        drawn.of_species(autocorrelation_chart(drawn.title(), &self.0.to_string(), measured, (&fitted.0, &fitted.1)))
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        vec![MEAN_SQUARE]
    }
}

/// The value of one unit of the sums.
fn quantum(plan: &Plan, quantity: CorrelatedQuantity) -> f64 {
    match quantity {
        CorrelatedQuantity::Velocity => plan.quanta.velocity_squared,
        CorrelatedQuantity::Force => plan.force_unit.powi(2) * force_product_quantum(plan.particles),
    }
}

/// The value of one unit in which products of forces are summed, over the square of the unit of forces: sums of all
/// particles have room for forces that give each sixteen times its natural momentum in a step.
fn force_product_quantum(particles: u64) -> f64 {
    ((particles.max(1) as f64).log2().ceil() - 6.0).max(0.0).exp2()
}

/// The parameters of a fit, for the result.
fn parameters(fit: &FittedDecay, curve: DecayFit) -> Value {
    let mut result = json!({ "curve": curve });
    for (name, found) in &fit.parameters {
        result[*name] = json!(found);
    }
    result["deviation"] = json!(fit.deviation);
    result
}

/// The curve that was fitted to an autocorrelation, with its parameters.
fn formula(fit: &Value) -> String {
    let parameter = |name: &str, key: &str| found(&fit[key]).map(|found| format!("{name} = {found}"));
    let (curve, parameters) = match fit["curve"].as_str() {
        Some("exponential") => ("a exp(−bt)", vec![("a", "a"), ("b", "b")]),
        Some("stretched-exponential") => ("a exp(−(bt)^{c})", vec![("a", "a"), ("b", "b"), ("c", "c")]),
        Some("damped-oscillation") => ("damped oscillation", vec![("a", "a"), ("Ω²", "frequency_squared")]),
        _ => return "fit".to_owned(),
    };
    let parameters: Vec<String> = parameters.into_iter().filter_map(|(name, key)| parameter(name, key)).collect();
    format!("fit {curve}: {}", parameters.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fits_have_their_numbers_and_errors() {
        let fit = json!({
            "curve": "exponential", "a": { "value": 1.0, "error": null },
            "b": { "value": 4.51234, "error": 0.0312 }, "deviation": 0.1,
        });
        assert_eq!(formula(&fit), "fit a exp(−bt): a = 1, b = 4.512 ± 0.031");
        assert_eq!(formula(&Value::Null), "fit");
    }
}
