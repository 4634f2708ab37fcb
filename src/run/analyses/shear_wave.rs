//! The decay of the shear wave that particles start with.

use super::{Conclusion, Descriptor, Drawn, Gathered, Part, Sampling, Setting, found, total_mass};
use crate::families::{Checked, Model};
use crate::measure::shear_wave::WaveDecay;
use crate::plot::{Chart, shear_wave_chart};
use crate::scene::shear_waves;
use crate::state::Reported;
use crate::table::Table;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Names in the result.
const INITIAL_AMPLITUDE: &str = "initial_amplitude";
const DECAY_RATE: &str = "decay_rate";
const KINEMATIC_VISCOSITY: &str = "kinematic_viscosity";
const SHEAR_VISCOSITY: &str = "shear_viscosity";

/// The decay of a shear wave.
pub(super) struct ShearWave;

impl Descriptor for ShearWave {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        Some(Sampling::after_equilibration(scene, scene.output.shear_wave.as_ref()?.every))
    }

    fn takes_states(&self) -> bool {
        true
    }

    fn parts(&self, _: &Checked) -> Vec<Part> {
        // Step and amplitude.
        vec![Part::series(2)]
    }

    fn numbers_of_state(&self, Setting { scene, .. }: &Setting<'_>, state: &Reported) -> Option<Vec<f64>> {
        let (_, _, periods) = shear_waves(scene).next()?;
        Some(vec![state.step as f64, amplitude(state, scene.model(), f64::from(periods))])
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let (_, _, periods) = shear_waves(scene).next()?;
        let wave = Wave { model, periods: f64::from(periods), samples: gathered.part(0).as_chunks().0 };
        let decay = wave.decay();
        let result = decay.as_ref().map(|decay| wave.result(decay));
        let missing = || "its samples are too few or too far apart, or the wave does not decay".to_owned();
        Some(Conclusion::new(wave.table(decay.as_ref()), result.ok_or_else(missing)))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let text = |key: &str| found(&drawn.result[key]).map(|found| found.to_string());
        let viscosity = text(KINEMATIC_VISCOSITY).map(|text| format!("; kinematic viscosity {text}"));
        let subtitle =
            format!("velocity along x, projected on the wave that it started with{}", viscosity.unwrap_or_default());
        let fit = text(DECAY_RATE).map(|text| format!("exponential decay, rate {text}"));
        shear_wave_chart(drawn.title(), &subtitle, fit.as_deref().unwrap_or("exponential decay"), drawn.table)
    }

    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[("shear viscosity (wave)", SHEAR_VISCOSITY)]
    }

    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let known = scene.model().physics().known_viscosities().into_iter().map(|(name, _)| name);
        [INITIAL_AMPLITUDE, DECAY_RATE, KINEMATIC_VISCOSITY, SHEAR_VISCOSITY].into_iter().chain(known).collect()
    }
}

/// The amplitude of the wave of the velocity along x, 2 Σ P sin(2πny/L) / ΣM.
fn amplitude(state: &Reported, model: &Model, periods: f64) -> f64 {
    let each = state.momenta.iter().zip(&state.positions).map(|(momentum, position)| {
        let turns = f64::from(position[1]) / 4_294_967_296.0 * periods;
        f64::from(momentum[0]) * (TAU * turns).sin()
    });
    2.0 * each.sum::<f64>() * model.units.momentum / total_mass(model)
}

/// The wave that a run began with.
struct Wave<'a> {
    model: &'a Model,
    periods: f64,
    /// Steps and amplitudes.
    samples: &'a [[f64; 2]],
}

impl Wave<'_> {
    /// Unit of time of a sample, and of the first.
    fn times(&self) -> [f64; 2] {
        match *self.samples {
            [[first, _], [second, _], ..] => {
                [(second - first) * self.model.time_step, self.model.time.at_sample(first)]
            }
            _ => [f64::NAN; 2],
        }
    }

    fn decay(&self) -> Option<WaveDecay> {
        let amplitudes: Vec<f64> = self.samples.iter().map(|[_, amplitude]| *amplitude).collect();
        WaveDecay::of(&amplitudes, self.times()[0])
    }

    /// Viscosities from the rate νk² of the decay, and what is known beforehand for comparison.
    fn result(&self, decay: &WaveDecay) -> Value {
        let units = &self.model.units;
        let (wave_number, density) = (TAU * self.periods / units.lengths[1], total_mass(self.model) / units.volume());
        let mut result = json!({
            "samples": self.samples.len(),
            "wave_number": wave_number,
            INITIAL_AMPLITUDE: decay.amplitude,
            DECAY_RATE: decay.rate,
            KINEMATIC_VISCOSITY: decay.rate.times(wave_number.powi(-2)),
            SHEAR_VISCOSITY: decay.rate.times(density * wave_number.powi(-2)),
        });
        for (name, viscosity) in self.model.physics().known_viscosities() {
            result[name] = json!(viscosity);
        }
        result
    }

    fn table(&self, decay: Option<&WaveDecay>) -> Table {
        let [_, first] = self.times();
        let row = |[step, amplitude]: &[f64; 2]| {
            let time = self.model.time.at_sample(*step);
            vec![time, *amplitude, decay.map_or(f64::NAN, |decay| decay.at(time - first))]
        };
        Table::new(["time", "amplitude", "fit"], self.samples.iter().map(row).collect())
    }
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::Analyses;
    use super::*;
    use crate::families::{NETWORK_VISCOSITY, initial_state};
    use crate::plan::{Hardware, Options};
    use crate::run::plan;
    use crate::run::sections::Sections;
    use std::path::Path;

    pub(in super::super) fn scene() -> Checked {
        let text = r#"{"title": "t", "space": {"box": [20, 10]}, "time": {"step": 0.5, "steps": 100}, "temperature": 1e-9,
            "particles": [{"species": "A", "count": 200, "mass": 3, "placement": {"type": "lattice", "jitter": 0.4},
                "velocities": {"type": "shear-wave", "amplitude": 0.25, "periods": 2}}],
            "interactions": [{"type": "voronoi"}],
            "output": {"neighbours": {"every": 10}, "shear_wave": {"every": 5}}}"#;
        crate::scene::parse("t", text, &[]).unwrap()
    }

    #[test]
    fn states_survive_a_checkpoint_and_come_once() {
        let scene = scene();
        let plan = plan(&scene, Hardware::default(), Options::default());
        let setting = &Setting { scene: &scene, plan: &plan };
        let mut state: Reported = initial_state(&scene).into();
        let at = |step: u64, sections: &[(String, Vec<u8>)]| {
            Analyses::new(setting, &Sections::new(Path::new("checkpoint.bin"), step, sections))
        };
        let mut analyses = at(0, &[]).unwrap();
        assert_eq!(analyses.state_intervals(), [10, 5]);
        for step in [0, 5, 7, 10, 10, 5] {
            state.step = step;
            analyses.add_state(&state, setting);
        }
        let [_, sections] = analyses.sections();
        // Two samples have the last step and the cells with 0 to 32 neighbours; three have steps and amplitudes.
        assert_eq!([0, 1].map(|place| sections[place].1.len()), [8 + 2 * 33 * 8, 3 * 16]);
        assert_eq!(at(11, &sections).unwrap().sections()[1], sections);
        let fresh = at(0, &[]).unwrap().sections();
        assert!(fresh[1].iter().zip(&sections).all(|(fresh, kept)| fresh != kept));
        for step in [10, 16] {
            let refused = at(step, &sections).err().unwrap().to_string();
            assert!(refused.contains("is no valid checkpoint"), "{refused}");
        }
    }

    #[test]
    fn states_are_taken_after_equilibration() {
        let scene = scene().changed(|scene| scene.time.equilibration = 40);
        let plan = plan(&scene, Hardware::default(), Options::default());
        let sections = Sections::new(Path::new("checkpoint.bin"), 0, &[]);
        let analyses = Analyses::new(&Setting { scene: &scene, plan: &plan }, &sections).unwrap();
        let due: Vec<u64> = (0..=60).filter(|step| analyses.take_state(*step)).collect();
        assert_eq!(due, [40, 45, 50, 55, 60]);
    }

    #[test]
    fn the_amplitude_is_that_of_the_start() {
        let scene = scene();
        let model = scene.model();
        let state: Reported = initial_state(&scene).into();
        // On a lattice the squares of sines add up to a half, which jitter changes to 0.4 √(1/8N) · 2 or so.
        let found = amplitude(&state, model, 2.0);
        assert!((found - 0.25).abs() < 0.03, "{found}");
        assert!(amplitude(&state, model, 1.0).abs() < 0.03);
    }

    #[test]
    fn viscosity_follows_from_the_rate() {
        let scene = scene();
        let model = scene.model();
        let samples = (0..60).map(|sample| {
            let step = 5.0 * f64::from(sample);
            [step, 0.25 * (-0.01 * step * 0.5).exp()]
        });
        let wave = Wave { model, periods: 2.0, samples: &samples.collect::<Vec<_>>() };
        let decay = wave.decay().unwrap();
        let result = wave.result(&decay);
        // k = 2π · 2/10, density 3: η = 0.01 · 3/k².
        let viscosity = result["shear_viscosity"]["value"].as_f64().unwrap();
        assert!((viscosity - 0.03 / (0.4 * std::f64::consts::PI).powi(2)).abs() < 1e-9, "{viscosity}");
        assert_eq!(result["viscosity_of_the_network"], json!(NETWORK_VISCOSITY));
        let table = wave.table(Some(&decay));
        assert!(table.rows.iter().all(|row| (row[1] - row[2]).abs() < 1e-9), "{table:?}");
        assert_eq!(table.rows[1][0], 2.5);
    }
}
