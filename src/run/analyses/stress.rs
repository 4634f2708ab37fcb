//! The pressure tensor, the surface tension of a slab, and the viscosity from the autocorrelation of the stress or from shear.

use super::{
    Analysis, Conclusion, Descriptor, Drawn, Gathering, NO_SAMPLE, Planner, Sampling, Setting, SumSampler, bytes,
    found, mean,
};
use crate::engine::Sample;
use crate::families::Model;
use crate::measure::green_kubo::{StressCorrelation, stress_correlation};
use crate::measure::statistics::estimate;
use crate::measure::stress::{Components, surface_tension};
use crate::plan::Need;
use crate::plot::{Chart, stress_chart, stress_correlation_chart};
use crate::scene::{self, AnalysisId, Frame, Output, Scene};
use crate::shaders::{Array, Constant, Entry};
use crate::table::Table;
use serde_json::{Map, Value, json};

/// Names of the whole tensor and of its parts, in the order of the sums.
const PRESSURE: &str = "pressure";
const PARTS: [&str; 3] = ["kinetic", "conservative", "frictional"];
const SURFACE_TENSION: &str = "surface_tension";
/// The same of the conservative part alone: where nothing flows, the others are isotropic and add noise.
const CONSERVATIVE_TENSION: &str = "surface_tension_conservative";
/// The place of the conservative part.
const CONSERVATIVE: usize = 1;
const VISCOSITY: &str = "shear_viscosity";
/// Of the stress in a box whose boundaries shear.
const SHEARED: &str = "viscosity_in_shear";

/// The pressure tensor.
pub(super) struct Stress;

impl Descriptor for Stress {
    fn asked(&self, scene: &Scene, model: &Model) -> Option<Sampling> {
        let asked = scene.output.stress.as_ref()?;
        let sampling = Sampling::after_equilibration(scene, asked.every);
        let columns = 1 + 4 * Components::of(model.units.dimension).len() as u64;
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
        let buffers = [Array::StressSums, Array::StressSamples];
        planner.add_sums(&SumSampler {
            choices: velocities,
            constants: vec![(Constant::StressMotion, motion)],
            ..SumSampler::new(AnalysisId::Stress, Entry::SumStresses, buffers, 18, asked.every)
        });
    }

    fn begin(&self, setting: &Setting<'_>) -> Option<Gathering> {
        let (asked, model, plan) = (setting.scene.output.stress.as_ref()?, setting.model, setting.plan);
        Some(Gathering::Samples(Box::new(Tensors {
            asked: asked.clone(),
            components: Components::of(model.units.dimension),
            time_step: model.time_step,
            volume: model.units.volume(),
            temperature: model.temperature,
            length: asked.normal.map_or(0.0, |axis| model.units.edges()[axis as usize]),
            is_driven: model.is_driven(),
            shear: sheared(model),
            units: [plan.quanta.energy, plan.stress_unit, plan.stress_unit],
            samples: Vec::new(),
        })))
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

    fn kept_bytes(&self, scene: &Scene, model: &Model) -> u64 {
        self.asked(scene, model).map_or(0, |sampling| sampling.count(scene).saturating_mul(8 * KEPT as u64))
    }

    fn finds(&self, scene: &Scene, model: &Model) -> Vec<&'static str> {
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
const KEPT: usize = 19;

/// The tensors of all samples.
struct Tensors {
    asked: scene::Stress,
    components: Components,
    time_step: f64,
    volume: f64,
    temperature: f64,
    length: f64,
    /// Whether something drives a flow.
    is_driven: bool,
    /// The shear rate, and the component of the stress that it makes.
    shear: Option<(f64, usize)>,
    /// The value of a unit of the sums of each part.
    units: [f64; 3],
    /// Steps, and the three parts of the pressure tensor.
    samples: Vec<[f64; KEPT]>,
}

/// The shear rate, and the component of the stress that it makes. Boundaries that are displaced and at rest have none.
fn sheared(model: &Model) -> Option<(f64, usize)> {
    let shear = model.particles().shear.filter(|shear| shear.velocity != 0.0)?;
    Some((shear.rate(model), shear.gradient + 2))
}

impl Tensors {
    /// A part of the tensor of a sample.
    fn part(sample: &[f64; KEPT], part: usize) -> [f64; 6] {
        std::array::from_fn(|component| sample[1 + 6 * part + component])
    }

    /// The whole tensor of a sample.
    fn whole(sample: &[f64; KEPT]) -> [f64; 6] {
        std::array::from_fn(|component| (0..3).map(|part| sample[1 + 6 * part + component]).sum())
    }

    /// The autocorrelation of the shear stress, if it is asked for.
    fn correlation(&self) -> Option<StressCorrelation> {
        let window = self.asked.window?;
        let series: Vec<[f64; 6]> = self.samples.iter().map(Self::whole).collect();
        let interval = self.asked.every as f64 * self.time_step;
        let dimension = self.components.dimension();
        Some(stress_correlation(&series, dimension, self.volume / self.temperature, interval, window as usize))
    }

    /// The table of the autocorrelation.
    fn correlation_table(&self, correlation: &StressCorrelation) -> Table {
        let lags = correlation.autocorrelation.iter().zip(&correlation.viscosity).enumerate();
        let rows = lags.map(|(lag, (autocorrelation, viscosity))| {
            let numbers =
                [autocorrelation, viscosity].map(|found| [found.mean, found.standard_error.unwrap_or(f64::NAN)]);
            [&[lag as f64 * self.asked.every as f64 * self.time_step], numbers.as_flattened()].concat()
        });
        let columns = ["time", "autocorrelation", "autocorrelation_error", "viscosity", "viscosity_error"];
        Table::new(columns, rows.collect())
    }

    /// Means of the components of a tensor.
    fn means(&self, of: impl Fn(&[f64; KEPT]) -> [f64; 6]) -> Value {
        let means = self.components.iter().map(|(name, index)| {
            let series: Vec<f64> = self.samples.iter().map(|sample| of(sample)[index]).collect();
            (name.to_owned(), json!(estimate(&series)))
        });
        Value::Object(means.collect::<Map<String, Value>>())
    }
}

impl Analysis for Tensors {
    fn add(&mut self, sample: &Sample) {
        if sample.sums.len() + 1 == KEPT {
            self.samples.push(std::array::from_fn(|place| match place.checked_sub(1) {
                Some(sum) => sample.sums[sum] as f64 * self.units[sum / 6] / self.volume,
                None => sample.step as f64,
            }));
        }
    }

    fn section(&self) -> Vec<u8> {
        bytes(self.samples.as_flattened().iter().copied())
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        samples.saturating_mul(KEPT as u64)
    }

    fn restore(&mut self, numbers: &[f64], _: u64) {
        self.samples = numbers.as_chunks().0.to_vec();
    }

    fn conclude(&self) -> Conclusion {
        let named =
            |tensor: &str| self.components.iter().map(|(name, _)| format!("{tensor}_{name}")).collect::<Vec<_>>();
        let columns = [PRESSURE].iter().chain(&PARTS).flat_map(|tensor| named(tensor));
        let columns: Vec<String> = std::iter::once("time".to_owned()).chain(columns).collect();
        let rows = self.samples.iter().map(|sample| {
            let tensors = [Self::whole(sample), Self::part(sample, 0), Self::part(sample, 1), Self::part(sample, 2)];
            let numbers = tensors
                .iter()
                .flat_map(|tensor| self.components.iter().map(|(_, index)| tensor[index]))
                .collect::<Vec<_>>();
            [&[sample[0] * self.time_step], &numbers[..]].concat()
        });
        let table = Table::new(columns, rows.collect());
        if self.samples.is_empty() {
            return Conclusion::new(table, Err(NO_SAMPLE.to_owned()));
        }
        let mut result = json!({ "samples": self.samples.len(), PRESSURE: self.means(Self::whole) });
        for (part, name) in PARTS.iter().enumerate() {
            result[*name] = self.means(|sample| Self::part(sample, part));
        }
        if let Some(normal) = self.asked.normal {
            let dimension = self.components.dimension();
            let tension = |of: &dyn Fn(&[f64; KEPT]) -> [f64; 6]| {
                let samples = self.samples.iter();
                let series =
                    samples.map(|sample| surface_tension(&of(sample), normal as usize, dimension, self.length));
                json!(estimate(&series.collect::<Vec<f64>>()))
            };
            if !self.is_driven {
                result[CONSERVATIVE_TENSION] = tension(&|sample| Self::part(sample, CONSERVATIVE));
            }
            result[SURFACE_TENSION] = tension(&Self::whole);
        }
        if let Some((rate, component)) = self.shear {
            let series: Vec<f64> = self.samples.iter().map(|sample| -Self::whole(sample)[component] / rate).collect();
            result[SHEARED] = json!(estimate(&series));
        }
        let correlation = self.correlation();
        let mut warnings = Vec::new();
        if let Some(correlation) = &correlation {
            let found = correlation.longest(self.asked.every == 1);
            result[VISCOSITY] = json!(found.as_ref().ok());
            warnings.extend(found.err().map(|error| format!("no `{VISCOSITY}`: {error}")));
        }
        let more = correlation.iter().map(|correlation| self.correlation_table(correlation));
        let tables = std::iter::once(table).chain(more).collect();
        Conclusion { tables, result: Ok(result), warnings }
    }
}
