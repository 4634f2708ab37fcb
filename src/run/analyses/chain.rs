//! What a run of harmonic chains measures and writes.

use super::{Conclusion, Descriptor, Drawn, Gathered, Part, Sampling, Setting};
use crate::families::{ChainTrios, Checked, Likeness, Strand, TimeAxis};
use crate::measure::harmonic_chain::{MemoryKernel, NormalModes, Pulse, ThermalSeries, equilibrium, half_pulses};
use crate::measure::statistics::Estimate;
use crate::plot::{
    Chart, chain_correlation_chart, chain_equilibrium_chart, chain_memory_chart, chain_profile_chart, chain_pulse_chart,
};
use crate::scene::Scene;
use crate::state::Reported;
use crate::table::Table;
use serde_json::{Map, Value, json};

const REDUCED_TIME: &str = "reduced_time";
const REDUCED_FRICTION: &str = "reduced_friction";

/// Pulses, correlations and variances of harmonic chains.
pub(super) struct Chain;

/// The place of the pulses among the parts; three parts of each chain in equilibrium follow.
const PULSES: usize = 1;

impl Descriptor for Chain {
    fn asked(&self, scene: &Checked) -> Option<Sampling> {
        let every = scene.output.chain.as_ref()?.every;
        Some(Sampling { every, ..Sampling::default() })
    }

    fn takes_states(&self) -> bool {
        true
    }

    /// Samples; of each the step, energies and displacements of the chains with a pulse; and what is kept of each chain
    /// in equilibrium.
    fn parts(&self, scene: &Checked) -> Vec<Part> {
        let Some(trios) = ChainTrios::from_scene(scene) else { return Vec::new() };
        let clusters = trios.thermal.clusters;
        let thermal = [Part::series(clusters), Part::sums(clusters.saturating_sub(1)), Part::series(2)];
        let pulse = [Part::sums(1), Part::series(pulse_width(&trios))];
        pulse.into_iter().chain(std::iter::repeat_n(thermal, 3).flatten()).collect()
    }

    fn numbers_of_state(&self, Setting { scene, .. }: &Setting<'_>, state: &Reported) -> Option<Vec<f64>> {
        let trios = ChainTrios::from_scene(scene)?;
        let [pulse, thermal] = trios.strands();
        let clusters = |number: usize, strand: &Strand| {
            let (displacements, momenta) = strand.motion(&state.positions, &state.momenta, &scene.model().units);
            match Likeness::ALL[number] {
                Likeness::Micro => trios.pulse.coarse_grained(&displacements, &momenta),
                _ => (displacements, momenta),
            }
        };
        let resolved = trios.pulse.frictionless();
        let samples = [0, 1, 2].map(|number| clusters(number, &pulse[number]));
        let mut numbers = vec![1.0, state.step as f64];
        numbers.extend(samples.iter().map(|(displacements, momenta)| resolved.energy(displacements, momenta)));
        numbers.extend(samples.iter().flat_map(|(displacements, _)| displacements));
        for (number, strand) in thermal.iter().enumerate() {
            let (displacements, momenta) = clusters(number, strand);
            numbers.extend(ThermalSeries::numbers_of(&displacements, &momenta));
        }
        Some(numbers)
    }

    fn conclude(&self, Setting { scene, .. }: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion> {
        let model = scene.model();
        let trios = ChainTrios::from_scene(scene)?;
        let pulses = gathered.part(PULSES).chunks_exact(pulse_width(&trios));
        let thermal = [0, 1, 2].map(|chain| {
            let [momenta, separations, history] = [0, 1, 2].map(|part| gathered.part(PULSES + 1 + 3 * chain + part));
            ThermalSeries::from_parts(momenta, separations, history.as_chunks().0)
        });
        let interval = scene.output.chain.as_ref()?.every as f64 * model.time_step;
        let pulses = pulses.map(|numbers| PulseSample::new(numbers, &trios, model.time)).collect();
        let chains = Chains { trios: &trios, interval, pulses, thermal };
        let kernels = chains.kernels();
        let pulse = chains.pulse();
        let result = chains.results(&pulse, &kernels);
        let (correlation, memory) = (chains.correlation(), memory(&kernels));
        let tables = vec![chains.profiles(), pulse, correlation, memory, chains.equilibrium()];
        Some(Conclusion { tables, result: Ok(result), warnings: Vec::new() })
    }

    fn chart(&self, drawn: &Drawn<'_>) -> Chart {
        let [pulse, memory, equilibrium] = subtitles(drawn.scene);
        let (title, table) = (drawn.title(), drawn.table);
        match drawn.place {
            0 => chain_profile_chart(title, &pulse, table),
            1 => chain_pulse_chart(title, &pulse, table),
            2 => chain_correlation_chart(title, &equilibrium, table),
            3 => chain_memory_chart(title, &memory, table),
            _ => chain_equilibrium_chart(title, &equilibrium, table),
        }
    }

    fn finds(&self, _: &Checked) -> Vec<&'static str> {
        vec![REDUCED_TIME, REDUCED_FRICTION]
    }
}

/// Columns of each chain begin with these, in the order of [`Likeness::ALL`].
const NAMES: [&str; 3] = ["micro", "dpd", "frictionless"];

/// Columns of all chains after some others.
fn columns(first: &[&str], of_each: &[&str]) -> Vec<String> {
    let each = NAMES.iter().flat_map(|name| of_each.iter().map(move |quantity| format!("{name}_{quantity}")));
    first.iter().map(|name| (*name).to_owned()).chain(each).collect()
}

/// Largest reduced time of the momentum autocorrelation.
const LONGEST_LAG: f64 = 5.0;

/// Pulses are shown at this many times from the start to the end, both included.
const PROFILES: usize = 4;

/// Largest number of beads in a cluster whose memory is computed, in a second or two.
const LARGEST_CLUSTER: usize = 256;

/// One sample of the three chains with a pulse.
struct PulseSample<'a> {
    time: f64,
    /// τ = ω₀t/n.
    reduced_time: f64,
    /// Energies of the clusters, resolved motion only.
    energies: &'a [f64],
    /// Displacements of the clusters.
    displacements: Vec<&'a [f64]>,
}

impl<'a> PulseSample<'a> {
    fn new(numbers: &'a [f64], trios: &ChainTrios, time: TimeAxis) -> Self {
        let time = time.at_sample(numbers[0]);
        Self {
            time,
            reduced_time: time / trios.pulse.cluster_time(),
            energies: &numbers[1..4],
            displacements: numbers[4..].chunks_exact(trios.pulse.clusters).collect(),
        }
    }
}

/// Numbers of a sample of a pulse.
fn pulse_width(trios: &ChainTrios) -> usize {
    4 + 3 * trios.pulse.clusters
}

/// Samples of all chains.
struct Chains<'a> {
    trios: &'a ChainTrios,
    /// The time between two of them.
    interval: f64,
    pulses: Vec<PulseSample<'a>>,
    thermal: [ThermalSeries; 3],
}

impl Chains<'_> {
    /// Displacements of clusters at a few times, in units of the height of the pulse.
    fn profiles(&self) -> Table {
        let last = self.pulses.len().saturating_sub(1);
        let mut rows = Vec::new();
        let mut shown: Vec<usize> = (0..PROFILES).map(|place| place * last / (PROFILES - 1)).collect();
        shown.dedup();
        for sample in shown.into_iter().filter_map(|index| self.pulses.get(index)) {
            for cluster in 0..self.trios.pulse.clusters {
                let mut row = vec![sample.reduced_time, cluster as f64];
                row.extend(sample.displacements.iter().map(|values| values[cluster] / self.trios.amplitude));
                rows.push(row);
            }
        }
        let names = ["tau", "cluster"].into_iter().chain(NAMES);
        Table::new(names, rows)
    }

    /// Peak, variance and energy of the pulses, the mean of both halves, with what is exact at the same times.
    fn pulse(&self) -> Table {
        let of_each = ["peak", "exact_peak", "variance", "exact_variance", "energy", "exact_energy"];
        let columns = columns(&["time", "tau"], &of_each);
        let shape = Pulse { amplitude: self.trios.amplitude, width: self.trios.width };
        let exact = ExactPulse::new(self.trios, shape);
        let describe = |displacements: &[f64]| {
            let [left, right] = half_pulses(displacements);
            let amplitude = self.trios.amplitude;
            [0.5 * (left.peak + right.peak) / amplitude, 0.5 * (left.variance + right.variance)]
        };
        let first = self.pulses.first().map_or(&[f64::NAN; 3][..], |sample| sample.energies);
        let row = |sample: &PulseSample| {
            let mut row = vec![sample.time, sample.reduced_time];
            for number in 0..3 {
                let (displacements, energy) = exact.at(number, sample.time);
                let [[peak, variance], [exact_peak, exact_variance]] =
                    [sample.displacements[number], &displacements].map(describe);
                row.extend([peak, exact_peak, variance, exact_variance]);
                row.extend([sample.energies[number] / first[number], energy]);
            }
            row
        };
        // The exact motion costs more than the samples do.
        let every = self.pulses.len().div_ceil(LARGEST_PULSE_TABLE).max(1);
        let last = self.pulses.len().saturating_sub(1);
        let shown = self.pulses.iter().enumerate().filter(|(index, _)| index.is_multiple_of(every) || *index == last);
        Table::new(columns, shown.map(|(_, sample)| row(sample)).collect())
    }

    /// ⟨P(0)P(t)⟩/nmkT of each chain, with what is exact, and the limit max(0, 1 - τ) of large clusters of beads.
    fn correlation(&self) -> Table {
        let interval = self.interval;
        let unit = self.trios.thermal.cluster_time();
        let samples = self.thermal[0].history.len();
        // At least as many origins as lags, where the run is that short.
        let lags = ((LONGEST_LAG * unit / interval) as usize + 1).min(samples.div_ceil(2));
        let times: Vec<f64> = (0..lags).map(|lag| lag as f64 * interval).collect();
        let of_each = ["correlation", "correlation_error", "exact_correlation"];
        let columns = columns(&["tau", "limit"], &of_each);
        let mut rows: Vec<Vec<f64>> =
            times.iter().map(|time| vec![time / unit, (1.0 - time / unit).max(0.0)]).collect();
        let scale = equilibrium::momentum_variance(&self.trios.thermal, self.trios.temperature);
        for (number, strand) in self.trios.strands()[1].iter().enumerate() {
            let size = if number == 0 { self.trios.thermal.cluster_size } else { 1 };
            let exact = NormalModes::new(strand.chain).momentum_autocorrelation(size, &times);
            let found = self.thermal[number].momentum_correlation(lags);
            for ((row, exact), found) in rows.iter_mut().zip(exact).zip(found) {
                row.extend([found.value / scale, found.error.unwrap_or(f64::NAN) / scale, exact]);
            }
        }
        // Without heat there is nothing to correlate.
        rows.retain(|row| row.len() == columns.len());
        Table::new(columns, rows)
    }

    /// Variances of each chain over time, relative to nmkT and to nkT/κ, with what is exact.
    fn equilibrium(&self) -> Table {
        let of_each = ["momentum_variance", "separation_variance", "exact_separation_variance"];
        let columns = columns(&["tau"], &of_each);
        let row = |(index, sample): (usize, &PulseSample)| {
            let mut row = vec![sample.reduced_time];
            for number in 0..3 {
                let [momentum, separation] = self.thermal[number].history.get(index).copied().unwrap_or([f64::NAN; 2]);
                let [momentum_scale, separation_scale] = self.scales();
                row.extend([momentum / momentum_scale, separation / separation_scale]);
                row.push(self.exact_separation(number) / separation_scale);
            }
            row
        };
        Table::new(columns, self.pulses.iter().enumerate().map(row).collect())
    }

    /// nmkT and nkT/κ.
    fn scales(&self) -> [f64; 2] {
        let momentum = equilibrium::momentum_variance(&self.trios.thermal, self.trios.temperature);
        [momentum, self.trios.temperature / self.trios.thermal.frictionless().stiffness]
    }

    fn exact_separation(&self, number: usize) -> f64 {
        let trio = &self.trios.thermal;
        match Likeness::ALL[number] {
            Likeness::Micro => equilibrium::cluster_separation_variance(trio, self.trios.temperature),
            _ => equilibrium::separation_variance(&trio.frictionless(), self.trios.temperature),
        }
    }

    /// The memory of clusters as large as those of the scene and larger, in fours.
    fn kernels(&self) -> Vec<MemoryKernel> {
        let sizes = std::iter::successors(Some(self.trios.pulse.cluster_size), |size| Some(4 * size));
        sizes.take_while(|size| *size <= LARGEST_CLUSTER).map(MemoryKernel::new).collect()
    }

    fn results(&self, pulse: &Table, kernels: &[MemoryKernel]) -> Value {
        let value = |name: &str| pulse.column(name).and_then(|column| column.last().copied());
        let scales = self.scales();
        let mut chains = Map::new();
        for (number, name) in NAMES.into_iter().enumerate() {
            let estimates = self.thermal[number].estimates();
            let scaled = |found: Option<Estimate>, scale: f64, exact: f64| {
                let mut scaled =
                    found.map_or_else(|| json!({ "value": null }), |found| json!(found.times(1.0 / scale)));
                scaled["exact"] = json!(exact / scale);
                scaled
            };
            let last = |quantity: &str| {
                let [found, exact] = ["", "exact_"].map(|kind| value(&format!("{name}_{kind}{quantity}")));
                json!({ "value": found, "exact": exact })
            };
            let result = json!({
                "momentum_variance_over_nmkT": scaled(estimates.momentum_variance, scales[0], scales[0]),
                "separation_variance_times_stiffness_over_nkT":
                    scaled(estimates.separation_variance, scales[1], self.exact_separation(number)),
                "pulse_peak": last("peak"),
                "pulse_variance": last("variance"),
                "pulse_energy": last("energy"),
            });
            chains.insert(name.to_owned(), result);
        }
        let plateaus = kernels.iter().filter_map(|kernel| Some((kernel.cluster_size.to_string(), kernel.plateau()?)));
        let plateaus: Map<String, Value> = plateaus.map(|(size, plateau)| (size, json!(plateau.friction))).collect();
        json!({
            REDUCED_TIME: value("tau"),
            REDUCED_FRICTION: self.trios.pulse.reduced_friction,
            "plateau_friction_by_cluster_size": plateaus,
            "chains": chains,
        })
    }
}

/// The table of a pulse has about this many rows at most.
const LARGEST_PULSE_TABLE: usize = 80;

/// The exact motion of a pulse.
struct ExactPulse<'a> {
    trios: &'a ChainTrios,
    modes: [NormalModes; 3],
    starts: [Vec<f64>; 3],
    energy: f64,
}

impl<'a> ExactPulse<'a> {
    fn new(trios: &'a ChainTrios, shape: Pulse) -> Self {
        let chain = &trios.pulse;
        let beads = shape.displacements(chain);
        let (clusters, still) = chain.coarse_grained(&beads, &vec![0.0; beads.len()]);
        let modes = [chain.micro(), chain.dissipative(), chain.frictionless()].map(NormalModes::new);
        let energy = chain.frictionless().energy(&clusters, &still);
        Self { trios, modes, starts: [beads, clusters.clone(), clusters], energy }
    }

    /// Displacements of the clusters, and their energy relative to the first.
    fn at(&self, number: usize, time: f64) -> (Vec<f64>, f64) {
        let start = &self.starts[number];
        let (mut displacements, mut momenta) = self.modes[number].evolved(start, &vec![0.0; start.len()], time);
        let chain = &self.trios.pulse;
        if number == 0 {
            (displacements, momenta) = chain.coarse_grained(&displacements, &momenta);
        }
        let energy = chain.frictionless().energy(&displacements, &momenta) / self.energy;
        (displacements, energy)
    }
}

/// Running integrals against ω₀t, in equal ratios of time, and the plateau of the largest clusters.
fn memory(kernels: &[MemoryKernel]) -> Table {
    const POINTS: usize = 600;
    let mut columns = vec!["time".to_owned()];
    columns.extend(kernels.iter().map(|kernel| format!("running_friction_{}", kernel.cluster_size)));
    let plateau = kernels.last().and_then(|kernel| Some((kernel.cluster_size, kernel.plateau()?)));
    if let Some((size, _)) = plateau {
        columns.push(format!("plateau_{size}"));
    }
    let longest = kernels.last().map_or(1.0, |kernel| kernel.cluster_size as f64);
    let first = 0.1_f64;
    let ratio = (longest / first).powf(1.0 / POINTS as f64);
    let times = std::iter::once(0.0).chain((0..=POINTS).map(|point| first * ratio.powi(point as i32)));
    let row = |time: f64| {
        let mut row = vec![time];
        row.extend(kernels.iter().map(|kernel| kernel.running_friction(time)));
        if let Some((_, plateau)) = plateau {
            let within = time <= plateau.range[1];
            row.push(if within { plateau.friction + plateau.slope * time } else { f64::NAN });
        }
        row
    };
    Table::new(columns, times.map(row).collect())
}

/// The conditions under which the numbers of pulses, of the memory and of equilibrium were found, for their plots.
fn subtitles(scene: &Scene) -> [String; 3] {
    let Some(trios) = ChainTrios::from_scene(scene) else { return Default::default() };
    let ChainTrios { pulse, width, thermal, temperature, .. } = trios;
    let (size, friction) = (pulse.cluster_size, pulse.reduced_friction);
    [
        format!(
            "{} clusters of {size} beads, Gaussian pulse of width {width} clusters at rest, kT = 0, γ* = {friction}",
            pulse.clusters
        ),
        "exact, of clusters of n beads whose centres are held; the plateau lasts while ω_{0}t is far below n"
            .to_owned(),
        format!("{} clusters of {size} beads, kT = {temperature}, γ* = {friction}", thermal.clusters),
    ]
}
