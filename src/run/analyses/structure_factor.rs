//! The static structure factor.

use super::species_pairs::{SPECIES, SpeciesPairs, names, pair_in_words, printed_peaks, results_of};
use super::{Conclusion, Descriptor, Drawn, Gathered, NO_SAMPLE, Part, Planner, Sampling, Setting, species_of};
use crate::engine::Sample;
use crate::families::{Checked, Model};
use crate::measure::blocks::BlockSums;
use crate::measure::peak::peak;
use crate::measure::statistics::Estimate;
use crate::measure::wave_vectors::{wave_number, wave_vectors};
use crate::numbers::grouped;
use crate::plan::recording::{SAMPLE_ROWS, record_histogram};
use crate::plan::serial_memory::TURNS;
use crate::plan::{Contents, Plan, Sampler};
use crate::plot::{Chart, Panel, Series};
use crate::scene::{self, AnalysisId};
use crate::shaders::analyses::OfWave;
use crate::shaders::{Array, Choices, Constant, Entry};
use crate::table::Table;
use serde_json::{Value, json};

/// Columns of the table, and names in the result.
const WAVE_NUMBER: &str = "wave_number";
const VALUE: &str = "structure_factor";
const OF_CHARGE: &str = "charge_structure_factor";
const VECTORS: &str = "vectors";
const PEAK_WAVE_NUMBER: &str = "peak_wave_number";
const PEAK_HEIGHT: &str = "peak_height";
/// True in the result of charges.
const CHARGES: &str = "charges";

/// The unit of amplitudes.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// The static structure factor.
pub(super) struct StructureFactor;

impl Descriptor for StructureFactor {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let asked = scene.output.structure_factor.as_ref()?;
        let detail =
            Some(format!("up to {} wave vectors in each of {} bins", asked.vectors, grouped(asked.bins.into())));
        Some(Sampling { detail, ..Sampling::after_equilibration(scene, asked.every) })
    }

    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let Some(asked) = &planner.output.structure_factor else { return };
        let model = planner.model;
        let vectors = wave_vectors(edges(model), asked.range, asked.bins, asked.vectors).concat();
        let sets = Sets::of(asked, model);
        let waves: Vec<[i32; 4]> = vectors
            .iter()
            .flat_map(|[x, y, z]| sets.species.iter().map(move |species| [*x, *y, *z, *species]))
            .collect();
        let parts = planner.plan.particles.div_ceil(planner.options.workgroup() * TURNS).max(1);
        let (groups, entries) = (waves.len() as u64 * parts, 2 * waves.len() as u64 * parts);
        let sums = [(Array::PartialSums, Array::DensityWaves)];
        let entry = Entry::SumDensityWaves;
        let choices = Choices::new().with_if(sets.are_of_species, OfWave::Species);
        let Some(kernel) = planner.kernel_of_particles("structure_factor", entry, &choices, groups, &sums) else {
            return;
        };
        let constants = vec![(Constant::WaveParts, parts as f64), (Constant::Quantities, 2.0)];
        let count = planner.plan.add_kernel(kernel.with(constants));
        let rows = vec![(Array::Histogram, Array::DensityWaves), (Array::Samples, Array::DensityWaveSamples)];
        let record = planner.plan.add_kernel(record_histogram(entries).renamed(rows));
        let bytes = bytemuck::cast_slice(&waves).to_vec();
        planner.plan.add_buffer_with(Array::WaveVectors, bytes.len() as u64, Contents::Bytes(bytes));
        planner.plan.add_buffer(Array::DensityWaves, 8 * entries);
        // About a mebibyte, or sixteen rows.
        let capacity = ((1 << 17) / (1 + entries)).clamp(16, SAMPLE_ROWS);
        let id = AnalysisId::StructureFactor;
        let plain = planner.sampler(id, asked.every, Array::DensityWaveSamples, entries as usize, capacity);
        planner.plan.samplers.push(Sampler { kernels: vec![count, record], ..plain });
    }

    fn parts(&self, scene: &Checked) -> Vec<Part> {
        let asked = scene.output.structure_factor.iter();
        asked
            .map(|asked| asked.bins as usize * Sets::of(asked, scene.model()).curves.len())
            .map(|values| Part::Blocks(BlockSums::with_most(values, 64)))
            .collect()
    }

    /// The mean over the wave vectors of each bin, of one curve after the other.
    fn numbers_of_sample(&self, Setting { scene, plan }: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let asked = scene.output.structure_factor.as_ref()?;
        let (sets, bins) = (Sets::of(asked, scene.model()), Bins::of(asked, scene.model(), plan)?);
        let width = sets.species.len();
        let parts = (sample.sums.len() / (2 * width * bins.places.len()).max(1)).max(1);
        let amplitudes: Vec<[f64; 2]> = sample
            .sums
            .chunks_exact(2 * parts)
            .map(|sums| [0, 1].map(|part| sums.iter().skip(part).step_by(2).sum::<i64>() as f64 * UNIT))
            .collect();
        let mut row = Vec::with_capacity(bins.vectors.len() * sets.curves.len());
        for curve in &sets.curves {
            let mut of_bins = vec![0.0; bins.vectors.len()];
            for (amplitudes, bin) in amplitudes.chunks_exact(width).zip(&bins.places) {
                of_bins[*bin] += curve.product(amplitudes);
            }
            row.extend(of_bins.iter().zip(&bins.vectors).map(|(sum, vectors)| sum / f64::from((*vectors).max(1))));
        }
        Some(row)
    }

    fn conclude(&self, Setting { scene, plan }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let asked = scene.output.structure_factor.as_ref()?;
        let (sets, bins, blocks) = (Sets::of(asked, model), Bins::of(asked, model, plan)?, gathered.blocks()?);
        let count = bins.vectors.len();
        // Without particles there is no curve, and nothing to draw.
        let has_curves = !sets.curves.is_empty();
        let filled: Vec<usize> = (0..count).filter(|bin| has_curves && bins.vectors[*bin] > 0).collect();
        let curves = || sets.curves.iter().enumerate();
        let suffix = |place: usize| sets.pairs.suffix(sets.curves[place].place);
        let columns = curves().flat_map(|(place, _)| {
            let name = format!("{}{}", sets.value, suffix(place));
            [name.clone(), format!("{name}_error")]
        });
        let names = [WAVE_NUMBER, VECTORS].map(str::to_owned).into_iter().chain(columns);
        let rows = filled.iter().map(|&bin| {
            let cells = curves().flat_map(|(place, _)| {
                blocks.mean(|row| row[place * count + bin]).map_or([f64::NAN; 2], Estimate::cells)
            });
            [bins.wave_numbers[bin], f64::from(bins.vectors[bin])].into_iter().chain(cells).collect()
        });
        let table = Table::new(names, rows.collect());
        let result = if blocks.samples() == 0 {
            Err(NO_SAMPLE.to_owned())
        } else if !has_curves {
            Err("there are no particles".to_owned())
        } else {
            let found = curves().map(|(place, curve)| {
                let rows = |means: &[f64]| -> Vec<[f64; 2]> {
                    filled.iter().map(|&bin| [bins.wave_numbers[bin], means[place * count + bin]]).collect()
                };
                let [wave_number, height] =
                    [0, 1].map(|part| blocks.jackknife(|means| Some(peak(&rows(means))?[part])));
                let mut found =
                    json!({ "samples": blocks.samples(), PEAK_WAVE_NUMBER: wave_number, PEAK_HEIGHT: height });
                if let Some(pair) = sets.pairs.names(curve.place, model) {
                    found[SPECIES] = json!(pair);
                }
                if asked.charges {
                    found[CHARGES] = json!(true);
                }
                found
            });
            Ok(sets.pairs.result(found.collect()))
        };
        Some(Conclusion::new(table, result))
    }

    fn species_of(&self, scene: &Checked, numbers: &[usize]) -> Vec<String> {
        species_of(scene, numbers)
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let wave_numbers = drawn.column(WAVE_NUMBER);
        let columns = drawn.table.columns.iter().filter(|name| name.contains(VALUE) && !name.ends_with("_error"));
        let is_of_charge = is_of_charge(drawn.result);
        let symbol = if is_of_charge { "S_{ZZ}(q)" } else { "S(q)" };
        let curve = |(column, result): (&String, &Value)| {
            let points = wave_numbers.iter().zip(drawn.column(column)).map(|(q, value)| [*q, value]).collect();
            let name = pair_in_words(names(result)).unwrap_or_else(|| symbol.to_owned());
            Series::line(&name, points).with_band(drawn.column(&format!("{column}_error"))).with_ink(drawn.ink(result))
        };
        let of_charge = if is_of_charge { " of charge" } else { "" };
        let mut panel = Panel::new("Wave number q (1/length unit)", &format!("Structure factor{of_charge} {symbol}"));
        panel.x.range = wave_numbers.last().map(|last| [0.0, *last]);
        panel.series = columns.zip(results_of(drawn.result)).map(curve).collect();
        let panel = panel.with_reference(if is_of_charge { "charges at random places" } else { "ideal gas" }, 1.0);
        Chart { title: drawn.title().to_owned(), panels: vec![panel], ..Chart::default() }
    }

    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let symbol = if is_of_charge(result) { "S_ZZ(q)" } else { "S(q)" };
        printed_peaks(result, symbol, [PEAK_HEIGHT, PEAK_WAVE_NUMBER])
    }

    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let asked = scene.output.structure_factor.as_ref();
        let pairs = asked.map(|asked| SpeciesPairs::of(asked.species.as_ref(), scene.model()));
        pairs.filter(|pairs| !pairs.are_all()).map_or_else(Vec::new, |_| vec![PEAK_WAVE_NUMBER, PEAK_HEIGHT])
    }
}

fn is_of_charge(result: &Value) -> bool {
    result[CHARGES].is_boolean()
}

/// The edges of the box that positions are periodic along.
fn edges(model: &Model) -> [Option<f64>; 3] {
    let is_walled = |axis: usize| model.particles().walls.iter().any(|walls| walls.axis == axis);
    std::array::from_fn(|axis| (axis < model.units.dimension && !is_walled(axis)).then(|| model.units.lengths[axis]))
}

/// The density of particles that a wave of a species has, or of all; and the pairs of these whose products are taken.
struct Sets {
    pairs: SpeciesPairs,
    /// The column.
    value: &'static str,
    /// Species by their numbers; one that stands for all where waves are of none.
    species: Vec<i32>,
    are_of_species: bool,
    curves: Vec<Curve>,
}

/// The product of two densities.
struct Curve {
    /// Its place among the pairs of species.
    place: usize,
    /// Places among the species of the two densities, and what a particle counts there.
    of: [Vec<(usize, f64)>; 2],
    /// `√(N_a N_b)`, where particles do not count as one with the squares of what they count.
    particles: f64,
}

impl Curve {
    /// `Re ρ_a ρ_b*` over `√(N_a N_b)`.
    fn product(&self, amplitudes: &[[f64; 2]]) -> f64 {
        let density = |places: &[(usize, f64)], part: usize| -> f64 {
            places.iter().map(|(place, weight)| weight * amplitudes[*place][part]).sum()
        };
        [0, 1].map(|part| density(&self.of[0], part) * density(&self.of[1], part)).iter().sum::<f64>() / self.particles
    }
}

impl Sets {
    fn of(asked: &scene::StructureFactor, model: &Model) -> Self {
        let pairs = SpeciesPairs::of(asked.species.as_ref(), model);
        let count =
            |number: usize| model.species.get(number).filter(|found| !found.frozen).map_or(0, |found| found.count);
        let counts = |number: &usize| count(*number) > 0 && !(asked.charges && model.species[*number].charge == 0.0);
        let free: Vec<usize> = (0..model.species.len()).filter(counts).collect();
        let numbers = match pairs {
            SpeciesPairs::Between(pair) => {
                let mut numbers = pair.to_vec();
                numbers.dedup();
                numbers
            }
            SpeciesPairs::Alike | SpeciesPairs::All(_) => free.clone(),
        };
        // Frozen particles have no part in the density of all.
        let is_whole = pairs == SpeciesPairs::Alike && !asked.charges && model.frozen_particles() == 0;
        let place = |number: usize| {
            let place = numbers.iter().position(|known| *known == number);
            place.map(|place| (place, 1.0)).into_iter().collect::<Vec<_>>()
        };
        let curves: Vec<Curve> = if pairs == SpeciesPairs::Alike {
            let weight = |number: usize| if asked.charges { model.species[number].charge } else { 1.0 };
            let all: Vec<(usize, f64)> = if is_whole {
                vec![(0, 1.0)]
            } else {
                numbers.iter().enumerate().map(|(place, number)| (place, weight(*number))).collect()
            };
            let particles = free.iter().map(|number| weight(*number).powi(2) * count(*number) as f64).sum();
            vec![Curve { place: 0, of: [all.clone(), all], particles }]
        } else {
            let pair = |(index, [a, b]): (usize, [usize; 2])| Curve {
                place: index,
                of: [place(a), place(b)],
                particles: (count(a) as f64 * count(b) as f64).sqrt(),
            };
            pairs.species().into_iter().enumerate().map(pair).collect()
        };
        let species = if is_whole { vec![0] } else { numbers.iter().map(|number| *number as i32).collect() };
        Self {
            pairs,
            value: if asked.charges { OF_CHARGE } else { VALUE },
            species,
            are_of_species: !is_whole,
            curves: curves.into_iter().filter(|curve| curve.particles > 0.0).collect(),
        }
    }
}

/// The wave vectors of a plan by bins.
struct Bins {
    /// The bin of each wave vector.
    places: Vec<usize>,
    /// Wave vectors of each bin, and the mean of their wave numbers.
    vectors: Vec<u32>,
    wave_numbers: Vec<f64>,
}

impl Bins {
    fn of(asked: &scene::StructureFactor, model: &Model, plan: &Plan) -> Option<Self> {
        let table = plan.buffers.iter().find(|buffer| buffer.array == Array::WaveVectors)?;
        let bytes = table.contents.bytes()?;
        let waves: Vec<[i32; 4]> = bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
        let width = asked.range / f64::from(asked.bins);
        let (mut places, mut vectors, mut sums) =
            (Vec::new(), vec![0; asked.bins as usize], vec![0.0; asked.bins as usize]);
        for waves in waves.chunk_by(|a, b| a[..3] == b[..3]) {
            let wave_number = wave_number([waves[0][0], waves[0][1], waves[0][2]], edges(model));
            let bin = (wave_number / width) as usize;
            places.push(bin);
            vectors[bin] += 1;
            sums[bin] += wave_number;
        }
        let wave_numbers = sums.iter().zip(&vectors).map(|(sum, vectors)| sum / f64::from(*vectors)).collect();
        Some(Self { places, vectors, wave_numbers })
    }
}
