//! What a run of Voronoi DPD gathers from its states: numbers of neighbours, and the decay of a shear wave.

use super::sections::{Sections, bytes, samples};
use crate::families::{Model, NETWORK_VISCOSITY};
use crate::measure::neighbours::{MOST_NEIGHBOURS, NeighbourCounts, RANDOM_POINTS};
use crate::measure::shear_wave::WaveDecay;
use crate::measure::statistics::Estimate;
use crate::output::checkpoint::CheckpointError;
use crate::output::{OutputError, RunDirectory, Summary, files, write_table};
use crate::scene::{Scene, shear_waves};
use crate::state::State;
use crate::table::Table;
use crate::tessellation::Tessellation;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Names of the sections of a checkpoint and of the results.
const NEIGHBOURS: &str = "neighbours";
const SHEAR_WAVE: &str = "shear_wave";

/// What is due at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Due {
    pub neighbours: bool,
    pub shear_wave: bool,
}

impl Due {
    pub(super) fn any(self) -> bool {
        self.neighbours || self.shear_wave
    }
}

/// Gathers samples of Voronoi cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    neighbours: Option<Neighbours>,
    wave: Option<Wave>,
}

#[derive(Debug, Clone, PartialEq, Default)]
struct Neighbours {
    /// Step of the last sample.
    last: Option<u64>,
    counts: NeighbourCounts,
}

#[derive(Debug, Clone, PartialEq)]
struct Wave {
    periods: f64,
    /// Steps and amplitudes.
    samples: Vec<[f64; 2]>,
}

impl Cells {
    /// What a scene asks for, from the start or from the sections of a checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] where these are not as much as was sampled before the step.
    pub(super) fn new(scene: &Scene, sections: &Sections<'_>) -> Result<Self, CheckpointError> {
        let taken = |every: u64| samples(every, scene.time.equilibration, sections.step);
        let neighbours = match &scene.output.neighbours {
            None => None,
            Some(asked) => {
                let taken = taken(asked.every);
                let width = MOST_NEIGHBOURS as u64 + 1;
                let count = if taken > 0 { taken.saturating_mul(width).saturating_add(1) } else { 0 };
                Some(match sections.numbers(NEIGHBOURS, count)?.as_deref() {
                    Some([last, counts @ ..]) => {
                        Neighbours { last: Some(*last as u64), counts: NeighbourCounts::restored(counts) }
                    }
                    _ => Neighbours::default(),
                })
            }
        };
        let periods = shear_waves(scene).map(|(_, _, periods)| f64::from(periods)).next();
        let wave = match (&scene.output.shear_wave, periods) {
            (Some(asked), Some(periods)) => {
                let numbers = sections.numbers(SHEAR_WAVE, taken(asked.every).saturating_mul(2))?;
                Some(Wave { periods, samples: numbers.unwrap_or_default().as_chunks().0.to_vec() })
            }
            _ => None,
        };
        Ok(Self { neighbours, wave })
    }

    /// Adds what is due of the cells at a step, with full-step momenta. A step that was added already, before a run went
    /// back, is left out.
    pub(super) fn add(&mut self, due: Due, state: &State, model: &Model) {
        if let Some(neighbours) = self.neighbours.as_mut().filter(|_| due.neighbours)
            && neighbours.last.is_none_or(|last| last < state.step)
        {
            neighbours.last = Some(state.step);
            let lengths = [model.units.lengths[0], model.units.lengths[1]];
            neighbours.counts.push(&Tessellation::of_fractions(lengths, &state.positions));
        }
        if let Some(wave) = self.wave.as_mut().filter(|_| due.shear_wave)
            && wave.samples.last().is_none_or(|[last, _]| *last < state.step as f64)
        {
            wave.samples.push([state.step as f64, amplitude(state, model, wave.periods)]);
        }
    }

    /// What a checkpoint has to keep.
    pub(super) fn sections(&self) -> Vec<(String, Vec<u8>)> {
        let mut sections = Vec::new();
        if let Some(Neighbours { last, counts }) = &self.neighbours {
            let last = last.map(|last| last as f64);
            sections.push((NEIGHBOURS.to_owned(), bytes(last.into_iter().chain(counts.numbers()))));
        }
        if let Some(wave) = &self.wave {
            sections.push((SHEAR_WAVE.to_owned(), bytes(wave.samples.as_flattened().iter().copied())));
        }
        sections
    }

    /// Writes all tables and adds the results, or why there are none, to the summary.
    pub(super) fn conclude(
        &self,
        directory: &RunDirectory,
        model: &Model,
        summary: &mut Summary,
    ) -> Result<(), OutputError> {
        if let Some(Neighbours { counts, .. }) = &self.neighbours {
            if counts.is_empty() {
                summary
                    .warnings
                    .push("no result for `output.neighbours`: no sample was taken after equilibration".to_owned());
            } else {
                let result = json!({ "samples": counts.len(), "mean": counts.mean(), "variance": counts.variance() });
                summary.results.insert(NEIGHBOURS.to_owned(), result);
            }
            write_table(&directory.file(files::NEIGHBOURS), &fractions(counts))?;
        }
        if let Some(wave) = &self.wave {
            let decay = wave.decay(model);
            match decay {
                Some(decay) => {
                    summary.results.insert(SHEAR_WAVE.to_owned(), wave.result(&decay, model));
                }
                None => summary.warnings.push(
                    "no result for `output.shear_wave`: its samples are too few, or the wave does not decay".to_owned(),
                ),
            }
            write_table(&directory.file(files::SHEAR_WAVE), &wave.table(decay.as_ref(), model))?;
        }
        Ok(())
    }
}

/// The amplitude of the wave of the velocity along x, 2 Σ P sin(2πny/L) / ΣM.
fn amplitude(state: &State, model: &Model, periods: f64) -> f64 {
    let each = state.momenta.iter().zip(&state.positions).map(|(momentum, position)| {
        let turns = f64::from(position[1]) / 4_294_967_296.0 * periods;
        f64::from(momentum[0]) * (TAU * turns).sin()
    });
    2.0 * each.sum::<f64>() * model.units.momentum / mass(model)
}

fn mass(model: &Model) -> f64 {
    model.species.iter().map(|species| species.mass * species.count as f64).sum()
}

impl Wave {
    /// Unit of time of a sample, and of the first.
    fn times(&self, model: &Model) -> [f64; 2] {
        match self.samples[..] {
            [[first, _], [second, _], ..] => [second - first, first],
            _ => [f64::NAN; 2],
        }
        .map(|steps| steps * model.time_step)
    }

    fn decay(&self, model: &Model) -> Option<WaveDecay> {
        let amplitudes: Vec<f64> = self.samples.iter().map(|[_, amplitude]| *amplitude).collect();
        WaveDecay::of(&amplitudes, self.times(model)[0])
    }

    /// Viscosities from the rate νk² of the decay, beside that of the network of cells alone.
    fn result(&self, decay: &WaveDecay, model: &Model) -> Value {
        let wave_number = TAU * self.periods / model.units.lengths[1];
        let density = mass(model) / model.units.volume();
        let scaled = |factor: f64| {
            let error = decay.rate.standard_error.map(|error| error * factor);
            json!({ "value": decay.rate.value * factor, "standard_error": error })
        };
        let mut result = json!({
            "samples": self.samples.len(),
            "wave_number": wave_number,
            "initial_amplitude": decay.amplitude,
            "decay_rate": scaled(1.0),
            "kinematic_viscosity": scaled(wave_number.powi(-2)),
            "shear_viscosity": scaled(density * wave_number.powi(-2)),
        });
        if let Some(cells) = model.voronoi() {
            result["viscosity_of_friction"] = json!(cells.viscosity);
            result["viscosity_of_the_network"] = json!(NETWORK_VISCOSITY * cells.viscosity);
        }
        result
    }

    fn table(&self, decay: Option<&WaveDecay>, model: &Model) -> Table {
        let [_, first] = self.times(model);
        let row = |[step, amplitude]: &[f64; 2]| {
            let time = step * model.time_step;
            vec![time, *amplitude, decay.map_or(f64::NAN, |decay| decay.at(time - first))]
        };
        Table {
            columns: ["time", "amplitude", "fit"].map(str::to_owned).to_vec(),
            rows: self.samples.iter().map(row).collect(),
        }
    }
}

/// Fractions of cells by their number of neighbours, from the smallest number found to the largest.
fn fractions(counts: &NeighbourCounts) -> Table {
    let found: Vec<(usize, Estimate)> =
        (0..=MOST_NEIGHBOURS).filter_map(|number| Some((number, counts.fraction(number)?))).collect();
    let there = |(_, fraction): &&(usize, Estimate)| fraction.mean > 0.0;
    let range = [found.iter().find(there), found.iter().rfind(there)].map(|end| end.map(|(number, _)| *number));
    let within =
        |number: usize| range[0].is_some_and(|low| low <= number) && range[1].is_some_and(|high| high >= number);
    let row = |(number, fraction): &(usize, Estimate)| {
        let error = fraction.standard_error.unwrap_or(f64::NAN);
        let random = RANDOM_POINTS.get(*number).copied().unwrap_or(0.0);
        vec![*number as f64, fraction.mean, error, random]
    };
    Table {
        columns: ["neighbours", "fraction", "fraction_error", "random_points"].map(str::to_owned).to_vec(),
        rows: found.iter().filter(|(number, _)| within(*number)).map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::initial_state;
    use std::path::Path;

    fn scene() -> Scene {
        let text = r#"{"title": "t", "space": {"box": [20, 10]}, "time": {"step": 0.5, "steps": 100}, "temperature": 1e-9,
            "particles": [{"species": "A", "count": 200, "mass": 3, "placement": {"type": "lattice", "jitter": 0.4},
                "velocities": {"type": "shear-wave", "amplitude": 0.25, "periods": 2}}],
            "interactions": [{"type": "voronoi"}],
            "output": {"neighbours": {"every": 10}, "shear_wave": {"every": 5}}}"#;
        crate::scene::parse("t", text, &[]).unwrap()
    }

    #[test]
    fn samples_survive_a_checkpoint_and_come_once() {
        let scene = scene();
        let model = Model::new(&scene);
        let mut state = initial_state(&scene, &model);
        let at = |step: u64, sections: &[(String, Vec<u8>)]| {
            Cells::new(&scene, &Sections::new(Path::new("checkpoint.bin"), step, sections))
        };
        let mut cells = at(0, &[]).unwrap();
        let (both, wave) = (Due { neighbours: true, shear_wave: true }, Due { neighbours: false, shear_wave: true });
        for (step, due) in [(0, both), (5, wave), (10, both), (10, both), (5, wave)] {
            state.step = step;
            cells.add(due, &state, &model);
        }
        assert_eq!(cells.neighbours.as_ref().unwrap().counts.len(), 2);
        assert_eq!(cells.wave.as_ref().unwrap().samples.len(), 3);
        assert_eq!(at(11, &cells.sections()).unwrap(), cells);
        assert_ne!(at(0, &[]).unwrap(), cells);
        for step in [10, 16] {
            let refused = at(step, &cells.sections()).unwrap_err().to_string();
            assert!(refused.contains("is no valid checkpoint"), "{refused}");
        }
        let table = fractions(&cells.neighbours.as_ref().unwrap().counts);
        assert!((table.column("fraction").unwrap().iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_amplitude_is_that_of_the_start() {
        let scene = scene();
        let model = Model::new(&scene);
        let state = initial_state(&scene, &model);
        // On a lattice the squares of sines add up to a half, which jitter changes to 0.4 √(1/8N) · 2 or so.
        let found = amplitude(&state, &model, 2.0);
        assert!((found - 0.25).abs() < 0.03, "{found}");
        assert!(amplitude(&state, &model, 1.0).abs() < 0.03);
    }

    #[test]
    fn viscosity_follows_from_the_rate() {
        let scene = scene();
        let model = Model::new(&scene);
        let samples = (0..60).map(|sample| {
            let step = 5.0 * f64::from(sample);
            [step, 0.25 * (-0.01 * step * 0.5).exp()]
        });
        let wave = Wave { periods: 2.0, samples: samples.collect() };
        let decay = wave.decay(&model).unwrap();
        let result = wave.result(&decay, &model);
        // k = 2π · 2/10, density 3: η = 0.01 · 3/k².
        let viscosity = result["shear_viscosity"]["value"].as_f64().unwrap();
        assert!((viscosity - 0.03 / (0.4 * std::f64::consts::PI).powi(2)).abs() < 1e-9, "{viscosity}");
        assert_eq!(result["viscosity_of_the_network"], json!(NETWORK_VISCOSITY));
        let table = wave.table(Some(&decay), &model);
        assert!(table.rows.iter().all(|row| (row[1] - row[2]).abs() < 1e-9), "{table:?}");
        assert_eq!(table.rows[1][0], 2.5);
    }
}
