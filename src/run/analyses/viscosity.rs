//! The decay of transverse momentum waves and the viscosity it gives.

use super::{Analysis, Conclusion, Setting, bytes};
use crate::engine::Sample;
use crate::families::Model;
use crate::measure::correlation::{ShearViscosity, TransverseMode, WaveViscosity, shear_viscosity};
use crate::output::files;
use crate::scene;
use crate::table::Table;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// The amplitudes of all modes, sample by sample.
pub(super) struct Viscosity {
    density: f64,
    interval: f64,
    window: usize,
    unit: f64,
    modes: Vec<TransverseMode>,
}

impl Viscosity {
    pub(super) fn new(setting: &Setting<'_>, asked: &scene::Viscosity) -> Self {
        let mass: f64 = setting.model.species.iter().map(|species| species.mass * species.count as f64).sum();
        Self {
            density: mass / setting.model.units.volume(),
            interval: asked.every as f64 * setting.model.time_step,
            window: asked.window as usize,
            unit: setting.model.units.momentum,
            modes: transverse_modes(setting.model),
        }
    }
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

impl Analysis for Viscosity {
    fn name(&self) -> &'static str {
        "viscosity"
    }

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

    fn restore(&mut self, numbers: &[f64]) {
        let length = numbers.len() / self.modes.len().max(1);
        for (mode, part) in self.modes.iter_mut().zip(numbers.chunks_exact(length.max(1))) {
            mode.amplitudes = part.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        }
    }

    fn conclude(&self) -> Conclusion {
        let found = shear_viscosity(&self.modes, self.density, self.interval, self.window);
        let found = found.map_err(|error| error.to_string());
        let columns = ["wave_number", "time", "autocorrelation", "fit"].map(str::to_owned).to_vec();
        let rows = found.iter().flat_map(|found| autocorrelations(found, self.interval)).collect();
        let result = found.map(|found| {
            let wave = |wave: &WaveViscosity| json!({ "wave_number": wave.wave_number, "modes": wave.modes, "viscosity": wave.viscosity });
            json!({
                "shear_viscosity": found.viscosity,
                "kinematic_viscosity": found.kinematic_viscosity,
                "waves": found.waves.iter().map(wave).collect::<Vec<Value>>(),
            })
        });
        Conclusion::new(files::VISCOSITY, Table { columns, rows }, result)
    }
}
