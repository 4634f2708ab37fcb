//! The decay of transverse momentum waves and the viscosity it gives.

use super::{Conclusion, Descriptor, Drawn, Gathered, Part, Planner, Sampling, Setting, SumSampler, found, total_mass};
use crate::engine::Sample;
use crate::families::{Checked, Model};
use crate::measure::shear_viscosity::{ShearViscosity, TransverseMode, WaveViscosity, shear_viscosity};
use crate::measure::statistics::Estimate;
use crate::plot::{Chart, viscosity_chart};
use crate::scene::AnalysisId;
use crate::shaders::{Array, Entry};
use crate::table::Table;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Names in the result.
const SHEAR_VISCOSITY: &str = "shear_viscosity";
const KINEMATIC_VISCOSITY: &str = "kinematic_viscosity";
const WAVES: &str = "waves";
const OF_WAVE: &str = "viscosity";

/// The decay of transverse momentum waves.
pub(super) struct Viscosity;

impl Descriptor for Viscosity {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.viscosity.as_ref()?.every))
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.viscosity else { return };
        let dimension = planner.model.units.dimension;
        let buffers = [Array::ModeSums, Array::ModeSamples];
        let quantities = 2 * dimension * (dimension - 1);
        let sampler =
            SumSampler::new(AnalysisId::Viscosity, Entry::SumTransverseModes, buffers, quantities, asked.every);
        planner.add_sums(&SumSampler { constants: planner.of_all_particles(), ..sampler });
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        wave_numbers(scene.model()).map(|_| Part::series(2)).collect()
    }

    fn numbers_of_sample(&self, Setting { scene, .. }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        // exp(-ikr) = cos kr - i sin kr.
        let (signs, unit) = ([1.0, -1.0].into_iter().cycle(), scene.model().units.momentum);
        Some(sample.sums.iter().zip(signs).map(|(sum, sign)| sign * (*sum as f64 * unit)).collect())
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = scene.output.viscosity.as_ref()?;
        let modes = wave_numbers(model).enumerate().map(|(place, wave_number)| {
            let amplitudes = gathered.part(place).as_chunks().0.to_vec();
            TransverseMode { wave_number, amplitudes }
        });
        let (density, interval) = (total_mass(model) / model.units.volume(), asked.every as f64 * model.time_step);
        let found = shear_viscosity(&modes.collect::<Vec<_>>(), density, interval, asked.window as usize);
        let found = found.map_err(|error| error.to_string());
        let rows = found.iter().flat_map(|found| autocorrelations(found, interval)).collect();
        let result = found.map(|found| {
            let wave = |wave: &WaveViscosity| {
                json!({ "wave_number": wave.wave_number, "modes": wave.modes, OF_WAVE: wave.viscosity })
            };
            json!({
                SHEAR_VISCOSITY: found.viscosity,
                KINEMATIC_VISCOSITY: found.kinematic_viscosity,
                WAVES: found.waves.iter().map(wave).collect::<Vec<Value>>(),
            })
        });
        Some(Conclusion::new(Table::new(["wave_number", "time", "autocorrelation", "fit"], rows), result))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let waves = drawn.result[WAVES].as_array().map(Vec::as_slice).unwrap_or_default();
        let waves: Vec<Estimate> = waves.iter().filter_map(|wave| found(&wave[OF_WAVE])).collect();
        viscosity_chart(drawn.title(), drawn.table, &waves, found(&drawn.result[SHEAR_VISCOSITY]))
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("shear viscosity", SHEAR_VISCOSITY)]
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        vec![SHEAR_VISCOSITY, KINEMATIC_VISCOSITY]
    }
}

/// Wave numbers of the modes in the order in which the kernel sums them: for each axis the momenta across it.
fn wave_numbers(model: &Model) -> impl Iterator<Item = f64> {
    let axes = &model.units.lengths[..model.units.dimension];
    axes.iter().flat_map(|length| (1..axes.len()).map(move |_| TAU / length))
}

fn autocorrelations(found: &ShearViscosity, interval: f64) -> Vec<Vec<f64>> {
    let wave = |wave: &WaveViscosity| {
        let fit = |lag: usize| lag.checked_sub(wave.fit_from).and_then(|place| wave.fit.get(place)).copied();
        let row = |(lag, value): (usize, &f64)| {
            vec![wave.wave_number, lag as f64 * interval, *value, fit(lag).unwrap_or(f64::NAN)]
        };
        wave.autocorrelation.iter().enumerate().map(row).collect::<Vec<_>>()
    };
    found.waves.iter().flat_map(wave).collect()
}
