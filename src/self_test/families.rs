//! One step of every family of models against the reference in double precision, and the sums that no step may change.

use super::Finding;
use crate::engine::{Engine, EngineError};
use crate::families::{self, KeptQuantity, Model};
use crate::families::{Checked, reference::Stepper};
use crate::gpu::{Gpu, GpuError, Requirements};
use crate::plan::{Hardware, Options, Plan};
use crate::run::{self, plan};
use crate::scene::{self};
use crate::state::State;
use serde::Deserialize;
use serde_json::{Map, Value};

/// A scene with its name in words.
#[derive(Deserialize)]
struct Case {
    name: String,
    /// The name of the scene that it changes.
    scene: String,
    /// Changes to that scene, by their paths.
    #[serde(default)]
    set: Map<String, Value>,
    /// Whether the plan for any adapter is run in addition to that of the adapter, where they differ.
    #[serde(default)]
    twice: bool,
}

/// Scenes by name, and cases of them.
#[derive(Deserialize)]
struct Checks {
    scenes: Value,
    cases: Vec<Case>,
}

const CHECKS: &str = r#"{
    "scenes": {
        "fluid": {
            "title": "check", "space": {"box": [6, 6, 6]}, "time": {"step": 0.04, "steps": 1}, "temperature": 1,
            "particles": [{"species": "A", "number_density": 2}, {"species": "B", "number_density": 1, "mass": 2.5}],
            "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5,
                "pairs": [{"between": ["A", "B"], "repulsion": 40, "friction": 9}]}],
            "output": {"energies": {"every": 1000}}
        },
        "chains": {
            "title": "check", "space": {"box": [6, 6, 6]}, "time": {"step": 0.02, "steps": 1}, "temperature": 1,
            "integrator": {"type": "cotter-reich"},
            "particles": [{"species": "A", "count": 600, "chain": {"beads": 3}}],
            "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5},
                {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 9}, "friction": 2,
                    "bath": {"type": "memory", "rate": 3}},
                {"type": "angles", "stiffness": 2}],
            "output": {"energies": {"every": 1000}}
        },
        "cells": {
            "title": "check", "space": {"box": [20, 20]}, "time": {"step": 0.02, "steps": 1}, "temperature": 1,
            "particles": [{"species": "A", "count": 400, "mass": 5, "placement": {"type": "lattice", "jitter": 0.25}}],
            "interactions": [{"type": "voronoi"}], "output": {"energies": {"every": 1000}}
        },
        "water": {
            "title": "check", "space": {"box": [6.283185307179586, 6.283185307179586]}, "time": {"step": 0.02, "steps": 1},
            "temperature": 0, "integrator": {"type": "gyro"},
            "particles": [{"species": "water", "count": 4096, "placement": {"type": "lattice"}, "velocities": {"type": "geostrophic"}}],
            "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.283185307179586,
                "rotation": 6.283185307179586, "smoothing": {"length": 0.8},
                "surface": [{"type": "wave", "periods": [1, 2], "amplitude": 0.05}]}],
            "output": {"energies": {"every": 1000}}
        }
    },
    "cases": [
        {"name": "pairs, splitting", "scene": "fluid", "twice": true},
        {"name": "pairs, Groot and Warren with Gaussian noise", "scene": "fluid",
            "set": {"integrator": {"type": "groot-warren"}, "noise": {"distribution": "gaussian"}}},
        {"name": "pairs, Groot and Warren with prediction", "scene": "fluid",
            "set": {"integrator": {"type": "groot-warren", "lambda": 0.65}}},
        {"name": "pairs, Cotter and Reich", "scene": "fluid",
            "set": {"integrator": {"type": "cotter-reich"}, "noise": {"generator": "threefry2x32-20"}}},
        {"name": "pairs with cutoffs of their own", "scene": "fluid",
            "set": {"interactions.0.pairs": [{"between": ["A", "B"], "cutoff": 1.3},
                {"between": ["B", "B"], "cutoff": 0.8, "weight_exponent": 1}]}},
        {"name": "pairs with a many-body repulsion", "scene": "fluid", "twice": true,
            "set": {"time.step": 0.01,
                "interactions": [{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25}}]}},
        {"name": "pairs with memory", "scene": "fluid", "twice": true,
            "set": {"integrator": {"type": "cotter-reich"},
                "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5, "bath": {"type": "memory", "rate": 5}}]}},
        {"name": "pairs and a body force", "scene": "fluid", "twice": true,
            "set": {"interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5},
                {"type": "body-force", "profile": "sinusoidal", "force": [1, 0.5, 0], "axis": "y"}]}},
        {"name": "pairs between walls", "scene": "fluid", "twice": true,
            "set": {"space.walls": {"z": {"lower_velocity": [-1, 0.5, 0], "upper_velocity": [1, 0, 0]}}}},
        {"name": "pairs beside frozen layers", "scene": "fluid", "twice": true,
            "set": {"space.walls": {"z": {"lower_velocity": [-1, 0.5, 0], "upper_velocity": [1, 0, 0]}},
                "particles": [{"species": "A", "number_density": 3},
                    {"species": "B", "number_density": 3,
                        "placement": {"type": "behind-walls", "axis": "z", "thickness": 1}}]}},
        {"name": "pairs in shear", "scene": "fluid", "twice": true, "set": {"space.shear": {"rate": 0.7, "gradient": "z"}}},
        {"name": "bonds and angles", "scene": "chains"},
        {"name": "coloured noise, Langevin bath and tethers", "scene": "fluid",
            "set": {"integrator": {"type": "cotter-reich"},
                "interactions": [{"type": "coloured-noise", "strength": 1, "time": 0.1}, {"type": "tether", "stiffness": 3},
                    {"type": "langevin", "friction": 2, "bath": {"type": "memory", "rate": 5}}]}},
        {"name": "Voronoi cells", "scene": "cells", "twice": true},
        {"name": "Voronoi cells with energy", "scene": "cells", "set": {"interactions.0.energy": {"conductivity": 1}}},
        {"name": "shallow water with a bath", "scene": "water", "twice": true,
            "set": {"interactions.0.bath": {"type": "memory", "epsilon": 1}}},
        {"name": "shallow water, other solver", "scene": "water",
            "set": {"interactions.0.smoothing.solver": {"type": "chebyshev", "tolerance": 1e-6},
                "integrator.type": "rotate"}}
    ]
}"#;

/// Steps after which sums are looked at again.
const STEPS: u64 = 20;
/// What a difference of one step may be of what the step has changed. Drivers whose functions are nearly exact are off by 5e-6 at
/// most, those whose functions err as much as WGSL lets them by 1e-5, as `tests/extremes/edge_of_error.rs` finds by playing one; a wrong
/// number, or one that is lost, is off by parts of one.
const TOLERANCE: f64 = 1e-4;
/// Changes of fewer units than that say little: they are rounded.
const FEWEST_UNITS: f64 = 1e5;

/// Checks every family; `contracts` says whether the driver contracts products and sums.
pub(super) fn check(gpu: &Gpu, contracts: bool, report: &mut dyn FnMut(Finding)) {
    match checks() {
        Err(error) => report(Finding::new("families", false, error)),
        Ok(cases) => {
            for (case, scene) in &cases {
                let found = against_the_reference(gpu, case, scene, contracts);
                report(found.unwrap_or_else(|found| Finding::new(case.name.as_str(), false, found)));
            }
        }
    }
}

/// What comes of a check on a device that meets the requirements of plans, on this one if it does; a note where the adapter allows none.
fn where_possible(
    gpu: &Gpu,
    check: &str,
    plans: &[&Plan],
    on: impl FnOnce(&Gpu) -> Result<String, String>,
) -> Result<Finding, String> {
    let largest_buffer = plans.iter().map(|plan| plan.largest_buffer()).max().unwrap_or(0);
    let storage_buffers = plans.iter().map(|plan| plan.storage_buffers).max().unwrap_or(0);
    let requirements = Requirements { largest_buffer, storage_buffers, ..Requirements::default() };
    let found = if gpu.meets(requirements) {
        on(gpu)
    } else {
        match gpu.reopen(requirements) {
            Ok(wider) => on(&wider),
            Err(error @ GpuError::TooSmall { .. }) => {
                return Ok(Finding::noted(check, format!("not possible here: {error}")));
            }
            Err(error) => Err(error.to_string()),
        }
    };
    Ok(Finding::new(check, true, found?))
}

/// All cases with their scenes.
fn checks() -> Result<Vec<(Case, Checked)>, String> {
    let Checks { scenes, cases } = serde_json::from_str(CHECKS).map_err(|error| error.to_string())?;
    let with_scene = |case: Case| {
        let changes: Vec<String> = case.set.iter().map(|(path, value)| format!("{path}={value}")).collect();
        let scene = scene::parse("check", &scenes[&case.scene].to_string(), &changes);
        Ok((case, scene.map_err(|error| error.to_string())?))
    };
    cases.into_iter().map(with_scene).collect()
}

/// The state after one step of the reference.
fn reference_step(model: &Model, start: &State) -> Result<State, String> {
    let mut reference = reference_of(model, start)?;
    advance(&mut *reference, 1)?;
    Ok(reference.state().clone())
}

fn reference_of(model: &Model, start: &State) -> Result<Box<dyn Stepper>, String> {
    let missing = || "the reference does not support this scene".to_owned();
    model.physics().reference(model, start).ok_or_else(missing)
}

fn advance(reference: &mut dyn Stepper, steps: u64) -> Result<(), String> {
    (0..steps).try_for_each(|_| reference.step()).map_err(|error| format!("the reference: {error}"))
}

/// What a step changes of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
enum Quantity {
    Momenta,
    Positions,
    Masses,
    Energies,
}

impl Quantity {
    const ALL: [Self; 4] = [Self::Momenta, Self::Positions, Self::Masses, Self::Energies];

    /// All of a state, in integer units.
    fn of(self, state: &State) -> Vec<i64> {
        match self {
            Self::Momenta => state.momenta.iter().flatten().map(|units| i64::from(*units)).collect(),
            Self::Positions => state.positions.iter().flatten().map(|units| i64::from(*units)).collect(),
            Self::Masses => state.masses.iter().map(|units| i64::from(*units)).collect(),
            Self::Energies => state.energies.iter().map(|units| i64::from(*units)).collect(),
        }
    }

    /// The largest difference between two states, of positions the short way round.
    fn largest_difference(self, one: &State, other: &State) -> f64 {
        let difference = |(a, b): (i64, i64)| match self {
            Self::Positions => f64::from((a as u32).wrapping_sub(b as u32) as i32).abs(),
            Self::Momenta | Self::Masses | Self::Energies => (a - b).abs() as f64,
        };
        self.of(one).into_iter().zip(self.of(other)).map(difference).fold(0.0, f64::max)
    }
}

/// The largest difference of two states after a step, as a part of the largest change of the step, and of what.
fn deviation(start: &State, found: &State, expected: &State) -> (f64, Quantity) {
    let mut worst = (0.0, Quantity::Momenta);
    for quantity in Quantity::ALL {
        let change = quantity.largest_difference(expected, start).max(FEWEST_UNITS);
        let part = quantity.largest_difference(found, expected) / change;
        if part > worst.0 {
            worst = (part, quantity);
        }
    }
    worst
}

/// How far a scene is from its float64 reference after one step, and after so many: the largest difference, as a part of the largest change
/// since the start.
///
/// # Errors
/// Why there are no such steps, in words.
pub fn distances_from_reference(gpu: &Gpu, scene: &Checked, steps: u64) -> Result<[f64; 2], String> {
    let start = families::initial_state(scene);
    let words = |error: EngineError| error.to_string();
    let plan = plan(scene, Hardware::from(gpu), Options::default());
    let mut device = Engine::new(gpu, plan.without_reports(), &start).map_err(words)?;
    let mut reference = reference_of(scene.model(), &start)?;
    let mut distance_after = |steps: u64| {
        device.advance(steps, steps.max(1)).map_err(words)?;
        advance(&mut *reference, steps)?;
        Ok::<_, String>(deviation(&start, &device.state().map_err(words)?, reference.state()).0)
    };
    let first = distance_after(1)?;
    Ok([first, if steps > 1 { distance_after(steps - 1)? } else { first }])
}

/// What was found, or what is wrong.
fn against_the_reference(gpu: &Gpu, case: &Case, scene: &Checked, contracts: bool) -> Result<Finding, String> {
    let plan = |hardware| plan(scene, hardware, Options::default());
    let (own, portable) = (plan(Hardware::from(gpu)), plan(Hardware::default()));
    let portable = (case.twice && portable != own).then_some(portable);
    let plans: Vec<&Plan> = portable.iter().chain([&own]).collect();
    where_possible(gpu, &case.name, &plans, |gpu| compare(gpu, scene, &own, portable.as_ref(), contracts))
}

/// The same on a device with room for the plans: that of the adapter, and the one for any adapter where it is to give the same.
fn compare(
    gpu: &Gpu,
    scene: &Checked,
    plan: &Plan,
    portable: Option<&Plan>,
    contracts: bool,
) -> Result<String, String> {
    let model = scene.model();
    let start = families::initial_state(scene);
    let words = |error: EngineError| error.to_string();
    let mut device = Engine::new(gpu, plan.clone(), &start).map_err(words)?;
    device.advance(1, 1).map_err(words)?;
    let (part, quantity) = deviation(&start, &device.state().map_err(words)?, &reference_step(model, &start)?);
    device.advance(STEPS - 1, STEPS).map_err(words)?;
    let last = device.state().map_err(words)?;
    let mut found = format!("a step is off by {part:.0e} of its change at most ({quantity})");
    if part > TOLERANCE {
        return Err(format!("{found}, more than {TOLERANCE:.0e}"));
    }
    let kept = |state: &State| model.physics().kept(model, state);
    for (before, after) in kept(&start).iter().zip(kept(&last)) {
        let (name, change) = (before.quantity.name(), after.total - before.total);
        if change != 0 {
            return Err(format!("{name}{} changes by {change} units in {STEPS} steps", before.direction));
        }
    }
    let names: Vec<String> = run::kept(model).into_iter().map(KeptQuantity::name).collect();
    if !names.is_empty() {
        found = format!("{found}; {} constant to the last bit", names.join(", "));
    }
    if let Some(portable) = portable {
        let mut portable = Engine::new(gpu, portable.clone(), &start).map_err(words)?;
        portable.advance(STEPS, STEPS).map_err(words)?;
        if portable.state().map_err(words)? != last {
            let difference = format!("the plan for any adapter gives other bits after {STEPS} steps");
            if !contracts {
                return Err(difference);
            }
            // Compilers may contract the same expression in one kernel and not in another.
            found = format!("{found}; {difference}");
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::super::Verdict;
    use super::*;
    use crate::gpu::AdapterChoice;

    /// What an adapter has no room for is not possible, which is no failure; what the device was not opened for is possible on another.
    #[test]
    fn a_check_runs_where_it_has_room() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
        let bound = |gpu: &Gpu| gpu.device().limits().max_storage_buffers_per_shader_stage;
        let offered = gpu.reopen(Requirements { storage_buffers: 9, ..Requirements::default() }).is_ok();
        let scene = checks()?.swap_remove(0).1;
        let plan = plan(&scene, Hardware::default(), Options::default());
        let with = |storage_buffers: u32| Plan { storage_buffers, ..plan.clone() };
        let check = |plan: &Plan| where_possible(&gpu, "a check", &[plan], |gpu| Ok(bound(gpu).to_string()));
        assert_eq!(check(&with(8))?, Finding::new("a check", true, "8"));
        assert!(!offered || check(&with(9))? == Finding::new("a check", true, "9"));
        let impossible = check(&with(u32::MAX))?;
        let expected = "storage buffers in a kernel, but this scene needs 4294967295";
        assert_eq!(impossible.verdict, Verdict::Noted);
        assert!(impossible.found.starts_with("not possible here: ") && impossible.found.ends_with(expected));
        Ok(())
    }

    /// A deviation is found where one number of one particle is wrong, and none where nothing is.
    #[test]
    fn a_wrong_number_is_seen() -> Result<(), String> {
        for (case, scene) in checks()? {
            let start = families::initial_state(&scene);
            let expected = reference_step(scene.model(), &start)?;
            assert_eq!(deviation(&start, &expected, &expected).0, 0.0);
            let change = |quantity: Quantity| quantity.largest_difference(&start, &expected);
            let mut wrong = expected.clone();
            wrong.momenta[0][0] += (0.01 * change(Quantity::Momenta)) as i32;
            let (part, quantity) = deviation(&start, &wrong, &expected);
            assert!(quantity == Quantity::Momenta && part > 5e-3, "{}: {part} of {quantity:?}", case.name);
            let mut wrong = expected.clone();
            wrong.positions[1][1] = wrong.positions[1][1].wrapping_add((0.01 * change(Quantity::Positions)) as u32);
            let (part, quantity) = deviation(&start, &wrong, &expected);
            assert!(quantity == Quantity::Positions && part > 5e-3, "{}: {part} of {quantity:?}", case.name);
        }
        Ok(())
    }

    #[test]
    fn what_a_model_keeps_is_known() -> Result<(), String> {
        for (case, scene) in checks()? {
            let expected: &[&str] = match case.name.as_str() {
                "coloured noise, Langevin bath and tethers" => &[],
                "pairs and a body force" => &["total momentum, excluding the impulse of body forces"],
                "pairs between walls" | "pairs beside frozen layers" => {
                    &["total momentum, including that absorbed by walls"]
                }
                "pairs in shear" => &["total momentum, including that lost at sheared boundaries"],
                "Voronoi cells" => &["mass", "total momentum"],
                "Voronoi cells with energy" => &["mass", "total momentum", "total energy"],
                name if name.starts_with("shallow water") => &["mass on the mesh"],
                _ => &["total momentum"],
            };
            let names: Vec<String> = run::kept(scene.model()).into_iter().map(KeptQuantity::name).collect();
            assert_eq!(names, expected, "{}", case.name);
        }
        Ok(())
    }
}
