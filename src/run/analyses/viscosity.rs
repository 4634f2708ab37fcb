//! The decay of transverse momentum waves and the viscosity it gives.

use super::{
    Analysis, Conclusion, Descriptor, Drawn, Gathering, Planner, Sampling, Setting, SumSampler, bytes, found,
    total_mass,
};
use crate::engine::Sample;
use crate::families::Model;
use crate::measure::shear_viscosity::{ShearViscosity, TransverseMode, WaveViscosity, shear_viscosity};
use crate::plan::Need;
use crate::plot::{Chart, Found, viscosity_chart};
use crate::scene::{AnalysisId, Output, Scene};
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
    fn asked(&self, scene: &Scene, _: &Model) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.viscosity.as_ref()?.every))
    }

    fn needs(&self, _: &Output) -> &'static [Need] {
        &[Need::Particles]
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

    fn begin(&self, setting: &Setting<'_>) -> Option<Gathering> {
        let (asked, model) = (setting.scene.output.viscosity.as_ref()?, setting.model);
        Some(Gathering::Samples(Box::new(Amplitudes {
            density: total_mass(model) / model.units.volume(),
            interval: asked.every as f64 * model.time_step,
            window: asked.window as usize,
            unit: model.units.momentum,
            modes: transverse_modes(model),
        })))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let waves = drawn.result[WAVES].as_array().map(Vec::as_slice).unwrap_or_default();
        let waves: Vec<Found> = waves.iter().filter_map(|wave| found(&wave[OF_WAVE])).collect();
        viscosity_chart(drawn.title(), drawn.table, &waves, found(&drawn.result[SHEAR_VISCOSITY]))
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("shear viscosity", SHEAR_VISCOSITY)]
    }

    fn finds(&self, _: &Scene, _: &Model) -> Vec<&'static str> {
        vec![SHEAR_VISCOSITY, KINEMATIC_VISCOSITY]
    }
}

/// The amplitudes of all modes, sample by sample.
struct Amplitudes {
    density: f64,
    interval: f64,
    window: usize,
    unit: f64,
    modes: Vec<TransverseMode>,
}

/// Empty series in the order in which the kernel sums them: for each axis the momenta across it.
fn transverse_modes(model: &Model) -> Vec<TransverseMode> {
    let axes = &model.units.lengths[..model.units.dimension];
    let modes = axes.iter().flat_map(|length| (1..axes.len()).map(move |_| TAU / length));
    modes.map(|wave_number| TransverseMode { wave_number, amplitudes: Vec::new() }).collect()
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

impl Analysis for Amplitudes {
    fn add(&mut self, sample: &Sample) {
        let sums: Vec<f64> = sample.sums.iter().map(|sum| *sum as f64 * self.unit).collect();
        for (mode, pair) in self.modes.iter_mut().zip(sums.chunks_exact(2)) {
            // exp(-ikr) = cos kr - i sin kr.
            mode.amplitudes.push([pair[0], -pair[1]]);
        }
    }

    fn section(&self) -> Vec<u8> {
        bytes(self.modes.iter().flat_map(|mode| mode.amplitudes.as_flattened()).copied())
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        samples.saturating_mul(2 * self.modes.len() as u64)
    }

    fn restore(&mut self, numbers: &[f64], _: u64) {
        let length = numbers.len() / self.modes.len().max(1);
        for (mode, part) in self.modes.iter_mut().zip(numbers.chunks_exact(length.max(1))) {
            mode.amplitudes = part.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        }
    }

    fn conclude(&self) -> Conclusion {
        let found = shear_viscosity(&self.modes, self.density, self.interval, self.window);
        let found = found.map_err(|error| error.to_string());
        let rows = found.iter().flat_map(|found| autocorrelations(found, self.interval)).collect();
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
        Conclusion::new(Table::new(["wave_number", "time", "autocorrelation", "fit"], rows), result)
    }
}
