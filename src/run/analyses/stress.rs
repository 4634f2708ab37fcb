//! The pressure tensor, the surface tension of a slab, and the viscosity from the autocorrelation of the stress or from shear.

use super::{
    Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting, SumSampler, found, mean,
    printed_estimate,
};
use crate::engine::Sample;
use crate::families::{Checked, Model};
use crate::measure::green_kubo::{StressCorrelation, stress_correlation};
use crate::measure::statistics::estimate;
use crate::measure::stress::{Components, surface_tension};
use crate::plan::{Need, Plan, SamplerId};
use crate::plot::{Chart, stress_chart, stress_correlation_chart};
use crate::scene::{AnalysisId, Frame, Output};
use crate::shaders::{Array, Constant, Entry, analyses};
use crate::table::Table;
use serde_json::{Map, Value, json};

/// Names of the whole tensor and of its parts, in the order of the sums.
const PRESSURE: &str = "pressure";
const PARTS: [&str; 3] = ["kinetic", "conservative", "frictional"];
const SURFACE_TENSION: &str = "surface_tension";
/// The same of the conservative part alone: where nothing flows, the others are isotropic and add noise.
const CONSERVATIVE_TENSION: &str = "surface_tension_conservative";
/// The number of interfaces that share the tension.
const INTERFACES: &str = "interfaces";
/// The place of the conservative part.
const CONSERVATIVE: usize = 1;
const VISCOSITY: &str = "shear_viscosity";
/// Of the stress in a box whose boundaries shear.
const SHEARED: &str = "viscosity_in_shear";

/// The pressure tensor.
pub(super) struct Stress;

/// The pressure tensor of a sample: of motion, of conservative forces, of friction and noise.
fn parts_of_sample(sample: &Sample, plan: &Plan, model: &Model) -> [[f64; 6]; 3] {
    let units = [plan.quanta.energy, plan.stress_unit, plan.stress_unit];
    std::array::from_fn(|part| {
        std::array::from_fn(|component| sample.sums[6 * part + component] as f64 * units[part] / model.units.volume())
    })
}

/// The same, if the sample is one of the stress.
pub(in crate::run) fn stress_of_sample(sample: &Sample, plan: &Plan, model: &Model) -> Option<[[f64; 6]; 3]> {
    let is_stress = plan.samplers[sample.sampler].id == SamplerId::Analysis(AnalysisId::Stress);
    is_stress.then(|| parts_of_sample(sample, plan, model))
}

impl Descriptor for Stress {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let asked = scene.output.stress.as_ref()?;
        let sampling = Sampling::after_equilibration(scene, asked.every);
        let columns = 1 + 4 * Components::of(scene.model().units.dimension).len() as u64;
        let left_out = usize::from(asked.window.is_none());
        Some(Sampling { numbers: sampling.count(scene).saturating_mul(columns), left_out, ..sampling })
    }

    fn needs(&self, _: &Output) -> &'static [Need] {
        &[Need::Particles, Need::Momenta, Need::Stresses]
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.stress else { return };
        let (velocities, _) = planner.velocities(Some(Frame::Box));
        let motion = planner.model.units.momentum.powi(2) / planner.plan.quanta.energy;
        let is_charged = planner.model.particles().electrostatics.is_some();
        let choices = velocities.with_if(is_charged, analyses::StressShare::WithWaves);
        let buffers = [Array::StressSums, Array::StressSamples];
        planner.add_sums(&SumSampler {
            choices,
            constants: vec![(Constant::StressMotion, motion)],
            ..SumSampler::new(AnalysisId::Stress, Entry::SumStresses, buffers, 18, asked.every)
        });
    }

    fn parts(&self, _: &Checked) -> Vec<Part> {
        vec![Part::series(19)]
    }

    fn numbers_of_sample(&self, Setting { scene, plan }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let pressures = parts_of_sample(sample, plan, scene.model());
        Some(std::iter::once(sample.step as f64).chain(pressures.into_iter().flatten()).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = scene.output.stress.as_ref()?;
        let tensors = Tensors { model, samples: gathered.part(0).as_chunks().0 };
        let table = tensors.table();
        if tensors.samples.is_empty() {
            return Some(Conclusion::new(table, Err(NO_SAMPLE.to_owned())));
        }
        let mut result = json!({ "samples": tensors.samples.len(), PRESSURE: tensors.means(whole) });
        for (number, name) in PARTS.iter().enumerate() {
            result[*name] = tensors.means(|sample| part(sample, number));
        }
        if let Some(normal) = asked.normal {
            let normal = normal as usize;
            let interfaces = asked.interfaces.unwrap_or(2);
            let length = model.units.edges()[normal] / f64::from(interfaces);
            let tension = |of: &dyn Fn(&Kept) -> [f64; 6]| {
                let mut found =
                    tensors.mean(|sample| surface_tension(&of(sample), normal, model.units.dimension, length));
                found[INTERFACES] = json!(interfaces);
                found
            };
            if !model.is_driven() {
                result[CONSERVATIVE_TENSION] = tension(&|sample| part(sample, CONSERVATIVE));
            }
            result[SURFACE_TENSION] = tension(&whole);
        }
        if let Some((rate, component)) = sheared(model) {
            result[SHEARED] = tensors.mean(|sample| -whole(sample)[component] / rate);
        }
        let mut conclusion = Conclusion::new(table, Ok(result));
        if let Some(window) = asked.window {
            let series: Vec<[f64; 6]> = tensors.samples.iter().map(whole).collect();
            let interval = asked.every as f64 * model.time_step;
            let factor = model.units.volume() / model.temperature;
            let correlation = stress_correlation(&series, model.units.dimension, factor, interval, window as usize);
            let found = correlation.longest(asked.every);
            if let Ok(result) = &mut conclusion.result {
                result[VISCOSITY] = json!(found.as_ref().ok());
            }
            conclusion.warnings.extend(found.err().map(|error| format!("no `{VISCOSITY}`: {error}")));
            conclusion.tables.push(correlation_table(&correlation, interval));
        }
        Some(conclusion)
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        if drawn.place == 1 {
            return stress_correlation_chart(drawn.title(), drawn.table, found(&drawn.result[VISCOSITY]));
        }
        let means = |part: &str, component: &str| mean(&drawn.result[part][component]);
        stress_chart(drawn.title(), drawn.table, &|component| means(PRESSURE, component))
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("surface tension, conservative part", CONSERVATIVE_TENSION),
            ("surface tension", SURFACE_TENSION),
            ("viscosity in shear", SHEARED),
            ("shear viscosity (Green–Kubo)", VISCOSITY),
        ]
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let line = |(label, name): &(&str, &str)| {
            let interfaces = result[*name][INTERFACES].as_u64();
            let of_each = interfaces.map(|count| format!(", of each of {count} interfaces")).unwrap_or_default();
            Some((format!("{label}{of_each}"), printed_estimate(&result[*name])?))
        };
        self.labels().iter().filter_map(line).collect()
    }

    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let model = scene.model();
        let Some(asked) = &scene.output.stress else { return Vec::new() };
        let found = [
            (CONSERVATIVE_TENSION, asked.normal.is_some() && !model.is_driven()),
            (SURFACE_TENSION, asked.normal.is_some()),
            (SHEARED, sheared(model).is_some()),
            (VISCOSITY, asked.window.is_some()),
        ];
        found.into_iter().filter(|(_, is_found)| *is_found).map(|(name, _)| name).collect()
    }
}

/// Numbers of a sample: the step and three tensors of six components.
type Kept = [f64; 19];

/// A part of the tensor of a sample.
fn part(sample: &Kept, part: usize) -> [f64; 6] {
    std::array::from_fn(|component| sample[1 + 6 * part + component])
}

/// The whole tensor of a sample.
fn whole(sample: &Kept) -> [f64; 6] {
    std::array::from_fn(|component| (0..3).map(|part| sample[1 + 6 * part + component]).sum())
}

/// The shear rate, and the component of the stress that it makes. Boundaries that are displaced and at rest have none.
fn sheared(model: &Model) -> Option<(f64, usize)> {
    let shear = model.particles().shear.filter(|shear| shear.velocity != 0.0)?;
    Some((shear.rate(model), shear.gradient + 2))
}

/// The tensors of all samples: steps, and the three parts of the pressure tensor.
struct Tensors<'a> {
    model: &'a Model,
    samples: &'a [Kept],
}

impl Tensors<'_> {
    fn components(&self) -> impl Iterator<Item = (&'static str, usize)> {
        Components::of(self.model.units.dimension).iter()
    }

    /// The mean of a number of the samples.
    fn mean(&self, of: impl Fn(&Kept) -> f64) -> Value {
        json!(estimate(&self.samples.iter().map(of).collect::<Vec<f64>>()))
    }

    /// Means of the components of a tensor.
    fn means(&self, of: impl Fn(&Kept) -> [f64; 6]) -> Value {
        let means = self.components().map(|(name, index)| (name.to_owned(), self.mean(|sample| of(sample)[index])));
        Value::Object(means.collect::<Map<String, Value>>())
    }

    fn table(&self) -> Table {
        let tensors = [PRESSURE].into_iter().chain(PARTS);
        let columns = tensors.flat_map(|tensor| self.components().map(move |(name, _)| format!("{tensor}_{name}")));
        let rows = self.samples.iter().map(|sample| {
            let tensors = [whole(sample), part(sample, 0), part(sample, 1), part(sample, 2)];
            let numbers = tensors.iter().flat_map(|tensor| self.components().map(|(_, index)| tensor[index]));
            std::iter::once(self.model.time.at_sample(sample[0])).chain(numbers).collect()
        });
        Table::new(std::iter::once("time".to_owned()).chain(columns), rows.collect())
    }
}

/// The table of the autocorrelation.
fn correlation_table(correlation: &StressCorrelation, interval: f64) -> Table {
    let lags = correlation.autocorrelation.iter().zip(&correlation.viscosity).enumerate();
    let rows = lags.map(|(lag, (autocorrelation, viscosity))| {
        let numbers = [autocorrelation, viscosity].map(|found| found.cells());
        [&[lag as f64 * interval], numbers.as_flattened()].concat()
    });
    let columns = ["time", "autocorrelation", "autocorrelation_error", "viscosity", "viscosity_error"];
    Table::new(columns, rows.collect())
}
