//! The circulations of material loops over a run.

use super::{Analysis, Conclusion, Descriptor, Drawn, Gathering, Planner, Sampling, Setting, bytes};
use crate::engine::Sample;
use crate::families::{MaterialLoops, Model};
use crate::measure::circulation::{circulation, largest_gap};
use crate::plan::recording::SAMPLE_ROWS;
use crate::plan::{Kernel, Sampler, SamplerId};
use crate::plot::{Chart, circulation_chart};
use crate::scene::{AnalysisId, Scene};
use crate::shaders::{Array, Choices, Entry};
use crate::state::Units;
use crate::table::Table;
use serde_json::{Map, Value, json};
use std::ops::Range;

/// The buffer of tracers at reports.
const SAMPLES: Array = Array::TracerSamples;

/// Bytes of tracers kept on the device between two readbacks.
const TRACER_BYTES: u64 = 1 << 24;

/// Names in the result.
const INITIAL: &str = "initial";
const CHANGE: &str = "largest_change";
const RELATIVE_CHANGE: &str = "largest_relative_change";

/// The circulations of material loops.
pub(super) struct Circulation;

impl Descriptor for Circulation {
    fn asked(&self, scene: &Scene, model: &Model) -> Option<Sampling> {
        let loops = model.physics().material_loops(model).map_or(0, |found| found.loops.len() as u64);
        let every = scene.output.energies.every;
        let rows = scene.time.steps.checked_div(every).map_or(0, |times| times.saturating_add(1));
        (loops > 0).then(|| Sampling { every, numbers: rows.saturating_mul(loops + 2), ..Sampling::default() })
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(MaterialLoops { tracers, loops, .. }) = planner.model.physics().material_loops(planner.model) else {
            return;
        };
        // Tracers that are on no loop have no circulation.
        if loops.iter().all(|(_, range)| range.is_empty()) {
            return;
        }
        let plan = &mut *planner.plan;
        let record = plan.add_kernel(
            Kernel::new("record_tracers", Entry::RecordTracers, Choices::new(), 1)
                .renamed(vec![(Array::Samples, SAMPLES)]),
        );
        let row = 8 * (1 + 2 * tracers);
        // Two rows at the least: one is taken, and room is left for the next.
        let capacity = (TRACER_BYTES / row).clamp(2, SAMPLE_ROWS);
        plan.add_buffer(SAMPLES, 8 + capacity * row);
        plan.samplers.push(Sampler {
            id: SamplerId::Analysis(AnalysisId::Circulation),
            first: 0,
            every: planner.output.energies.every,
            kernels: vec![record],
            samples: SAMPLES,
            quantities: 2 * tracers as usize,
            capacity,
            needs_report: true,
            gathered: false,
            window: None,
            whole: 0..2 * tracers as usize,
        });
    }

    fn begin(&self, setting: &Setting<'_>) -> Option<Gathering> {
        let model = setting.model;
        let MaterialLoops { rotation, spacing, loops, .. } = model.physics().material_loops(model)?;
        let (units, time_step, rows) = (model.units, model.time_step, Vec::new());
        Some(Gathering::Samples(Box::new(Circulations { units, rotation, time_step, spacing, loops, rows })))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        circulation_chart(drawn.title(), drawn.table)
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let of_loop = |(name, circulation): (&String, &Value)| {
            let initial = circulation[INITIAL].as_f64()?;
            let change = match [RELATIVE_CHANGE, CHANGE].map(|key| circulation[key].as_f64()) {
                [Some(relative), _] => format!(", changes by up to {relative:.1e} of it"),
                [None, Some(change)] => format!(", changes by up to {change:.1e}"),
                [None, None] => String::new(),
            };
            Some((format!("circulation of `{name}`"), format!("{initial:.4}{change}")))
        };
        result.as_object().into_iter().flatten().filter_map(of_loop).collect()
    }
}

/// The largest change of a circulation among all loops, as a part of what it was at first and as long as its loop was a curve; none where
/// no loop had any.
pub(in crate::run) fn largest_change(result: &Value) -> Option<f64> {
    let loops = result.as_object()?.values();
    loops.filter_map(|found| found[RELATIVE_CHANGE].as_f64()).reduce(f64::max)
}

/// Circulations of all closed loops, one row a sample; not a number once a loop is no curve any more.
struct Circulations {
    units: Units,
    rotation: f64,
    time_step: f64,
    /// Neighbours on a loop that are further apart than this have lost each other.
    spacing: f64,
    /// Name and place among the tracers.
    loops: Vec<(String, Range<usize>)>,
    /// Time and circulations.
    rows: Vec<Vec<f64>>,
}

impl Circulations {
    fn table(&self) -> Table {
        let names = std::iter::once("time").chain(self.loops.iter().map(|(name, _)| name.as_str()));
        Table::new(names, self.rows.clone())
    }

    /// First value of each loop, the time up to which its points are closer together than nodes, and the largest
    /// change until then, relative too unless the first value is 0; null where there is none.
    fn result(&self) -> Value {
        let result = |(index, (name, _)): (usize, &(String, Range<usize>))| {
            let values = || self.rows.iter().map(move |row| row[index + 1]);
            let first = values().next().unwrap_or(f64::NAN);
            let resolved = || values().zip(&self.rows).take_while(|(value, _)| value.is_finite());
            let change = resolved().map(|(value, _)| (value - first).abs()).reduce(f64::max);
            let relative = change.filter(|_| first != 0.0).map(|change| change / first.abs());
            let until = resolved().last().map(|(_, row)| row[0]);
            let result = json!({
                INITIAL: first,
                "resolved_until": until,
                CHANGE: change,
                RELATIVE_CHANGE: relative,
            });
            (name.clone(), result)
        };
        Value::Object(self.loops.iter().enumerate().map(result).collect::<Map<_, _>>())
    }
}

impl Analysis for Circulations {
    /// Adds a sample of all tracers: position and velocity of each, two integers a word.
    fn add(&mut self, sample: &Sample) {
        let halves = |word: &i64| [*word as u32, (*word >> 32) as u32];
        let mut row = vec![sample.step as f64 * self.time_step];
        for (_, range) in &self.loops {
            let Some(words) = sample.sums.get(2 * range.start..2 * range.end) else { return };
            let (mut positions, mut velocities) = (Vec::new(), Vec::new());
            for point in words.chunks_exact(2) {
                let ([x, y], [u, v]) = (halves(&point[0]), halves(&point[1]));
                positions.push([x, y, 0]);
                velocities.push([u as i32, v as i32, 0]);
            }
            let resolved = positions.len() > 2 && largest_gap(&self.units, &positions) < self.spacing;
            row.push(if resolved {
                circulation(&self.units, &positions, &velocities, self.rotation)
            } else {
                f64::NAN
            });
        }
        self.rows.push(row);
    }

    fn section(&self) -> Vec<u8> {
        bytes(self.rows.iter().flatten().copied())
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        samples.saturating_mul(1 + self.loops.len() as u64)
    }

    fn restore(&mut self, numbers: &[f64], _: u64) {
        self.rows = numbers.chunks_exact(1 + self.loops.len()).map(<[f64]>::to_vec).collect();
    }

    fn is_idle(&self) -> bool {
        self.loops.is_empty()
    }

    fn conclude(&self) -> Conclusion {
        Conclusion::new(self.table(), Ok(self.result()))
    }
}
