//! The circulations of material loops over a run.

use super::{Conclusion, Descriptor, Drawn, Gathered, Part, Planner, Sampling, Setting, number};
use crate::engine::Sample;
use crate::families::{Checked, MaterialLoops};
use crate::measure::circulation::{circulation, largest_gap};
use crate::plan::recording::SAMPLE_ROWS;
use crate::plan::{Kernel, Sampler};
use crate::plot::{Chart, circulation_chart};
use crate::scene::AnalysisId;
use crate::shaders::{Array, Choices, Entry};
use crate::table::Table;
use serde_json::{Map, Value, json};

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
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let model = scene.model();
        let loops = model.physics().material_loops(model).map_or(0, |found| found.loops.len() as u64);
        let sampling = Sampling { every: scene.output.energies.every, ..Sampling::default() };
        (loops > 0).then(|| Sampling { numbers: sampling.count(scene).saturating_mul(loops + 2), ..sampling })
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(MaterialLoops { tracers, loops, .. }) = planner.model.physics().material_loops(planner.model) else {
            return;
        };
        // Tracers that are on no loop have no circulation.
        if loops.iter().all(|(_, range)| range.is_empty()) {
            return;
        }
        let kernel = Kernel::new("record_tracers", Entry::RecordTracers, Choices::new(), 1);
        let record = planner.plan.add_kernel(kernel.renamed(vec![(Array::Samples, SAMPLES)]));
        // Two rows at the least: one is taken, and room is left for the next.
        let capacity = (TRACER_BYTES / (8 * (1 + 2 * tracers))).clamp(2, SAMPLE_ROWS);
        let (every, quantities) = (planner.output.energies.every, 2 * tracers as usize);
        let plain = planner.sampler(AnalysisId::Circulation, every, SAMPLES, quantities, capacity);
        planner.plan.samplers.push(Sampler { first: 0, kernels: vec![record], whole: 0..quantities, ..plain });
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        let model = scene.model();
        // Time and circulations.
        vec![Part::series(1 + model.physics().material_loops(model).map_or(0, |found| found.loops.len()))]
    }

    /// Time and circulations of all closed loops, from position and velocity of every tracer, two integers a word. A
    /// circulation is not a number once its loop is no curve any more.
    fn numbers_of_sample(&self, Setting { scene, .. }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let model = scene.model();
        let MaterialLoops { rotation, spacing, loops, .. } = model.physics().material_loops(model)?;
        let halves = |word: &i64| [*word as u32, (*word >> 32) as u32];
        let mut row = vec![model.time.at(sample.step)];
        for (_, range) in loops {
            let (mut positions, mut velocities) = (Vec::new(), Vec::new());
            for point in sample.sums.get(2 * range.start..2 * range.end)?.chunks_exact(2) {
                let ([x, y], [u, v]) = (halves(&point[0]), halves(&point[1]));
                positions.push([x, y, 0]);
                velocities.push([u as i32, v as i32, 0]);
            }
            let resolved = positions.len() > 2 && largest_gap(&model.units, &positions) < spacing;
            row.push(if resolved { circulation(&model.units, &positions, &velocities, rotation) } else { f64::NAN });
        }
        Some(row)
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let loops = model.physics().material_loops(model)?.loops;
        let rows = gathered.part(0).chunks_exact(1 + loops.len()).map(<[f64]>::to_vec).collect();
        let names = std::iter::once("time").chain(loops.iter().map(|(name, _)| name.as_str()));
        let table = Table::new(names, rows);
        let result = loops.iter().enumerate().map(|(place, (name, _))| (name.clone(), change(&table, place + 1)));
        let result = Value::Object(result.collect::<Map<_, _>>());
        (!loops.is_empty()).then(|| Conclusion::new(table, Ok(result)))
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        circulation_chart(drawn.title(), drawn.table)
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let of_loop = |(name, circulation): (&String, &Value)| {
            let initial = number(&circulation[INITIAL])?;
            let change = match [RELATIVE_CHANGE, CHANGE].map(|key| number(&circulation[key])) {
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
    loops.filter_map(|found| number(&found[RELATIVE_CHANGE])).reduce(f64::max)
}

/// The first value of a loop, the time up to which its points are closer together than nodes, and the largest
/// change until then, relative too unless the first value is 0; null where there is none.
fn change(table: &Table, column: usize) -> Value {
    let first = table.column_at(column).next().unwrap_or(f64::NAN);
    let resolved = || table.rows.iter().take_while(|row| row[column].is_finite());
    let change = resolved().map(|row| (row[column] - first).abs()).reduce(f64::max);
    json!({
        INITIAL: first,
        "resolved_until": resolved().last().map(|row| row[0]),
        CHANGE: change,
        RELATIVE_CHANGE: change.filter(|_| first != 0.0).map(|change| change / first.abs()),
    })
}
