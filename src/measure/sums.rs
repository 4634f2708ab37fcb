//! From the integer sums of a report to observables in real units.

use super::{CellObservables, Observables};
use crate::engine::Sample;
use crate::families::{Model, ShallowWater, Voronoi};
use crate::plan::Plan;

/// The observables of one sample of the first sampler of a plan.
///
/// ```
/// use mesoscope::engine::Engine;
/// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
/// use mesoscope::plan::{Hardware, Options, plan};
/// use mesoscope::{measure::observables_of, families::Model, scene};
///
/// let small = ["space.box=[3,3,3]", r#"output={"energies":{"every":10}}"#].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let model = Model::new(&scene);
/// let start = families::initial_state(&scene, &model);
/// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
/// let plan = plan(&model, 0, &scene.output, Hardware::from(&gpu), Options::default());
/// let mut engine = Engine::new(&gpu, plan, &start)?;
/// engine.advance(20, 20)?;
/// let samples = engine.finish()?;
/// let observed: Vec<_> = samples.iter().map(|sample| observables_of(sample, engine.plan(), &model)).collect();
/// assert_eq!(observed.iter().map(|row| row.step).collect::<Vec<_>>(), [0, 10, 20]);
/// assert!(observed[0].kinetic_temperature() > 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn observables_of(sample: &Sample, plan: &Plan, model: &Model) -> Observables {
    let sum = |index: usize| sample.sums.get(index).map_or(f64::NAN, |sum| *sum as f64);
    let quanta = plan.quanta;
    if let Some(water) = model.shallow_water() {
        return shallow_water(sample.step, sum, plan, model, water);
    }
    if let Some(cells) = model.voronoi() {
        return voronoi(sample, sum, plan, model, cells);
    }
    // Energy, square and number of the baths come last, where there are any that remember.
    let remembering = sample.sums.len() > 9;
    Observables {
        step: sample.step,
        particles: plan.particles,
        mobile: model.mobile_particles(),
        dimension: model.units.dimension,
        volume: model.units.volume(),
        mass: model.species.iter().map(|species| species.mass * species.count as f64).sum(),
        kinetic_energy: sum(0) * quanta.energy,
        total_virial: sum(1) * quanta.pair_energy,
        momentum: [2, 3, 4].map(|index| sum(index) * model.units.momentum),
        potential_energy: sum(5) * quanta.pair_energy,
        conservative_virial: sum(6) * quanta.pair_energy,
        gradient_squared: sum(7) * quanta.force_squared,
        laplacian: sum(8) * quanta.curvature,
        about_centre_of_mass: model.measures_about_centre_of_mass(),
        bath_energy: if remembering { sum(9) * quanta.pair_energy } else { 0.0 },
        bath_square: if remembering { sum(10) * quanta.bath_squared / sum(11) } else { 0.0 },
        cells: None,
    }
}

fn shallow_water(
    step: u64,
    sum: impl Fn(usize) -> f64,
    plan: &Plan,
    model: &Model,
    water: &ShallowWater,
) -> Observables {
    let quanta = plan.quanta;
    let bath_squares = sum(4) * quanta.bath_squared;
    let energy_per_square = match &water.bath {
        Some(bath) if bath.continuous_coupling.is_finite() && bath.continuous_coupling > 0.0 => {
            0.5 * water.wave_speed.powi(2) / bath.continuous_coupling
        }
        _ => 0.0,
    };
    Observables {
        step,
        particles: water.carriers,
        mobile: water.carriers,
        dimension: 2,
        volume: model.units.volume(),
        mass: water.total_mass() as f64 * water.mass_unit,
        kinetic_energy: sum(0) * quanta.energy,
        momentum: [sum(1), sum(2), 0.0].map(|sum| sum * quanta.energy / water.wave_speed),
        potential_energy: sum(3) * quanta.pair_energy,
        bath_energy: energy_per_square * bath_squares,
        bath_square: bath_squares / water.nodes() as f64,
        cells: None,
        about_centre_of_mass: false,
        gradient_squared: 0.0,
        laplacian: 0.0,
        conservative_virial: f64::NAN,
        total_virial: f64::NAN,
    }
}

/// The residual of the solver of the friction is counted in these.
const RESIDUAL: f64 = 1.0 / (1_u64 << 40) as f64;

fn voronoi(sample: &Sample, sum: impl Fn(usize) -> f64, plan: &Plan, model: &Model, cells: &Voronoi) -> Observables {
    let whole = |index: usize| sample.sums.get(index).copied().unwrap_or(0);
    let quanta = plan.quanta;
    let mass_units = whole(3);
    let mass = mass_units as f64 * cells.mass_unit;
    // What one molecule has of both, as an ideal gas of two dimensions, and with it the product of pressure and volume.
    let (free_energy, internal_energy, internal_temperature) = if cells.keeps_energy() {
        // Kinetic and internal energy together are integers, whose sum says whether any is lost.
        let internal = whole(7) as f64 * cells.energy_unit - sum(0) * quanta.energy;
        (0.0, internal, sum(8) * quanta.energy / plan.particles as f64)
    } else {
        // Zero where there is no potential.
        (sum(6) * quanta.energy, mass / cells.molecular_mass * model.temperature, model.temperature)
    };
    Observables {
        step: sample.step,
        particles: plan.particles,
        mobile: plan.particles,
        dimension: 2,
        volume: model.units.volume(),
        mass,
        kinetic_energy: sum(0) * quanta.energy,
        momentum: [sum(1), sum(2), 0.0].map(|sum| sum * model.units.momentum),
        potential_energy: free_energy,
        conservative_virial: 2.0 * internal_energy,
        total_virial: f64::NAN,
        gradient_squared: 0.0,
        laplacian: 0.0,
        about_centre_of_mass: true,
        bath_energy: 0.0,
        bath_square: 0.0,
        cells: Some(CellObservables {
            volume: sum(4) * quanta.length_squared,
            // Every face has two sides.
            faces: whole(5) as u64 / 2,
            mass_units,
            internal_energy,
            internal_temperature,
            pressure: internal_energy / model.units.volume(),
            limited_exchanges: whole(9) as u64,
            iterations: whole(10) as u64,
            residual: whole(11) as f64 * RESIDUAL,
        }),
    }
}
