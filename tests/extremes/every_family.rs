//! The same extremes for every family: each is right within a tolerance, or refused before it starts with the reason.
//!
//! Right means: the device takes the steps of the float64 reference from the same state with the same random words; what the
//! family conserves is the same integer as at the start; and all that is measured is what the reference measures of the state.

use mesoscope::engine::Engine;
use mesoscope::families::Model;
use mesoscope::families::reference::{Reference, ShallowWaterReference, VoronoiReference};
use mesoscope::gpu::{Gpu, Requirements};
use mesoscope::measure::Observables;
use mesoscope::plan::{Options, Plan, Storage};
use mesoscope::scene::{self, Checked, SceneError};
use mesoscope::state::State;
use serde_json::{Value, json};
use std::time::Instant;

use crate::support::{
    Implementation, adapter, engine, hardware, largest_difference, reference_of_particles, series, start, totals,
};

/// A family of scenes, and of the particles of one family those with kernels of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Pairs that relax, the default.
    Splitting,
    /// The same in two stages, under a shear.
    Sheared,
    /// The same with forces that depend on densities.
    ManyBody,
    /// Between walls, one of which moves, pushed by a force.
    Walled,
    /// Chains whose particles and bonds have baths that steps are split for.
    Melt,
    /// Pairs that see predicted momenta.
    GrootWarren,
    /// Pairs with memory.
    Memory,
    /// Chains with bonds and angles.
    Chains,
    /// Tethers in baths with memory.
    Oscillators,
    ColouredNoise,
    HarmonicChain,
    ShallowWater,
    Voronoi,
    VoronoiEnergy,
}

use Kind::{
    Chains, ColouredNoise, GrootWarren, HarmonicChain, ManyBody, Melt, Memory, Oscillators, ShallowWater, Sheared,
    Splitting, Voronoi, VoronoiEnergy, Walled,
};

const EVERY: [Kind; 14] = [
    Splitting,
    Sheared,
    ManyBody,
    Walled,
    Melt,
    GrootWarren,
    Memory,
    Chains,
    Oscillators,
    ColouredNoise,
    HarmonicChain,
    ShallowWater,
    Voronoi,
    VoronoiEnergy,
];

impl Kind {
    /// A small scene of this kind.
    fn document(self) -> Value {
        let fluid = |integrator: Value, bath: Value| {
            json!({
                "space": {"box": [5, 5, 5]}, "time": {"step": 0.01}, "temperature": 1, "integrator": integrator,
                "particles": [{"species": "A", "count": 375}],
                "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5, "bath": bath}],
            })
        };
        let cells = |mass: f64, voronoi: Value| {
            json!({
                "space": {"box": [12, 12]}, "time": {"step": 0.005}, "temperature": 1,
                "particles": [{"species": "A", "count": 144, "mass": mass, "placement": {"type": "lattice", "jitter": 0.25}}],
                "interactions": [voronoi],
            })
        };
        let white = json!({"type": "white"});
        let mut document = match self {
            Splitting => fluid(json!({"type": "splitting"}), white),
            GrootWarren => fluid(json!({"type": "groot-warren", "lambda": 0.65}), white),
            Memory => fluid(json!({"type": "cotter-reich"}), json!({"type": "memory", "rate": 5})),
            Sheared => {
                let mut document = fluid(json!({"type": "splitting", "relaxation": "two-stages"}), white);
                document["space"]["shear"] = json!({"rate": 0.5, "flow": "x", "gradient": "y"});
                document
            }
            ManyBody => {
                let mut document = fluid(json!({"type": "splitting"}), white);
                document["interactions"][0]["repulsion"] = json!(-40);
                document["interactions"][0]["many_body"] = json!({"repulsion": 25, "cutoff": 0.75});
                document
            }
            Walled => {
                let mut document = fluid(json!({"type": "splitting"}), white);
                document["space"]["walls"] = json!({"z": {"reflection": "bounce-back", "upper_velocity": [1, 0, 0]}});
                let push = json!({"type": "body-force", "profile": "uniform", "force": [0, 0.5, 0]});
                document["interactions"].as_array_mut().unwrap().push(push);
                document
            }
            Melt => {
                let mut document = Chains.document();
                document["interactions"][1]["friction"] = json!(2);
                document["interactions"].as_array_mut().unwrap().push(json!({"type": "langevin", "friction": 1}));
                document
            }
            Chains => json!({
                "space": {"box": [5, 5, 5]}, "time": {"step": 0.01}, "temperature": 1,
                "particles": [{"species": "A", "count": 360, "chain": {"beads": 12, "spacing": 0.8}}],
                "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5},
                    {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}}, {"type": "angles", "stiffness": 2}],
            }),
            Oscillators => json!({
                "space": {"box": [50, 50, 50]}, "time": {"step": 0.05}, "temperature": 1,
                "particles": [{"species": "A", "count": 300, "mass": 2}],
                "interactions": [{"type": "langevin", "friction": 1, "bath": {"type": "memory", "rate": 3}},
                    {"type": "tether", "stiffness": 10}],
            }),
            ColouredNoise => json!({
                "space": {"box": [12, 12]}, "time": {"step": 0.01}, "temperature": 1,
                "particles": [{"species": "A", "count": 144}],
                "interactions": [{"type": "dpd", "friction": 0.5, "bath": {"type": "white", "temperature": 0}},
                    {"type": "coloured-noise", "process": "kangaroo", "strength": 1, "time": 0.05}],
            }),
            HarmonicChain => json!({
                "space": {"box": [512]}, "time": {"step": 0.1}, "temperature": 1, "particles": [],
                "interactions": [{"type": "harmonic-chain", "cluster_size": 4, "stiffness": 1, "spacing": 16,
                    "pulse": {"clusters": 20, "width": 2, "amplitude": 8}, "equilibrium": {"clusters": 32}}],
            }),
            ShallowWater => json!({
                "space": {"box": [6.25, 6.25]}, "time": {"step": 0.01}, "temperature": 4e-4,
                "particles": [{"species": "water", "count": 1024, "placement": {"type": "lattice"},
                    "velocities": {"type": "geostrophic"}}],
                "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.25, "rotation": 6.25,
                    "smoothing": {"length": 0.8}, "surface": [{"type": "wave", "periods": [1, 2], "amplitude": 0.05}],
                    "bath": {"type": "memory", "epsilon": 1}}],
            }),
            Voronoi => cells(5.0, json!({"type": "voronoi", "viscosity": 1})),
            VoronoiEnergy => cells(
                1.0,
                json!({"type": "voronoi", "viscosity": 1, "molecular_mass": 0.01, "energy": {"conductivity": 1}}),
            ),
        };
        document["title"] = json!("extreme");
        document["seed"] = json!(3);
        document["time"]["steps"] = json!(1);
        document["output"] = json!({"energies": {"every": 1}});
        document
    }

    /// Units of momentum by which a step may differ from the reference. Single precision is off by some 2⁻²³ of an impulse of 2²³
    /// units for each of a few dozen couplings of a particle, and by more where rates of relaxation are rounded to 2⁻¹⁶, where
    /// depths are formed on a mesh, and where friction is solved for to a tolerance.
    fn units(self) -> i64 {
        match self {
            GrootWarren | Memory | Oscillators | HarmonicChain => 100,
            ShallowWater => 5000,
            // Noise without strength leaves pairs, whose steps are split.
            Splitting | Sheared | ManyBody | Walled | Melt | Chains | ColouredNoise | Voronoi | VoronoiEnergy => 1000,
        }
    }

    fn reference(self, model: &Model, state: &State) -> Box<dyn Implementation> {
        let (model, state) = (model.clone(), state.clone());
        match self {
            Splitting | GrootWarren => Box::new(Reference::new(model, state)),
            Memory | Chains | Oscillators | ColouredNoise | HarmonicChain | Sheared | ManyBody | Walled | Melt => {
                reference_of_particles(model, state)
            }
            ShallowWater => Box::new(ShallowWaterReference::new(model, state).unwrap()),
            Voronoi | VoronoiEnergy => Box::new(VoronoiReference::new(model, state).unwrap()),
        }
    }

    /// A scene of this kind with changes, or why it is refused.
    fn scene(self, changes: &[String]) -> Result<Checked, SceneError> {
        let scene = scene::parse("extreme", &self.document().to_string(), changes)?;
        let plan = mesoscope::run::plan(&scene, hardware(), Options::default());
        mesoscope::plan::check_precision(&scene, &plan)?;
        Ok(scene)
    }
}

/// Numbers that a scene has to be right with, or words of the refusal.
enum Outcome {
    Right,
    /// What is conserved is, and all that is measured is finite, where the reference goes another way: it parts coincident cells in
    /// double precision.
    Sound,
    Refused(&'static str),
}

use Outcome::{Refused, Right, Sound};

/// All that is not as it should be.
struct Problems {
    found: Vec<String>,
    /// Whether every scene takes steps, and not every second.
    all: bool,
    /// Scenes that were to take steps.
    scenes: usize,
}

impl Problems {
    fn new() -> Self {
        Self { found: Vec::new(), all: true, scenes: 0 }
    }

    fn push(&mut self, problem: String) {
        self.found.push(problem);
    }

    /// Whether the turn of the next scene is in the long tests alone.
    fn skip(&mut self) -> bool {
        self.scenes += 1;
        // Of two scenes of a kind the first, of the next kind the second.
        !self.all && matches!(self.scenes % 4, 2 | 3)
    }
}

/// A check, with its problem if it has one.
fn check(problems: &mut Problems, holds: bool, problem: impl FnOnce() -> String) {
    if !holds {
        problems.push(problem());
    }
}

/// What comes of a scene of a kind with changes.
fn expect(problems: &mut Problems, kind: Kind, changes: &[String], outcome: Outcome) {
    let what = format!("{kind:?} {changes:?}");
    match (kind.scene(changes), outcome) {
        (Ok(_), Right | Sound) if problems.skip() => {}
        (Ok(scene), Right) => {
            let (_, state) = start(&scene);
            let mut device = device(&scene, &state);
            compare(problems, kind, &scene, &mut device, &state, &what);
        }
        (Ok(scene), Sound) => sound(problems, &scene, &what),
        (Err(refusal), Refused(words)) => {
            let refusal = refusal.to_string();
            check(problems, refusal.contains(words), || format!("{what}: {refusal}"));
        }
        (Ok(_), Refused(words)) => problems.push(format!("{what} is not refused: {words}")),
        (Err(refusal), Right | Sound) => problems.push(format!("{what}: {refusal}")),
    }
}

/// Some steps without a failure, and what has to hold after any.
fn sound(problems: &mut Problems, scene: &Checked, what: &str) {
    let (model, state) = start(scene);
    let mut device = device(scene, &state);
    match device.advance(10, 10).and_then(|()| device.state()) {
        Ok(found) => conserved(problems, &model, &found, &state, what),
        Err(error) => return problems.push(format!("{what}: {error}")),
    }
    let finite = |row: &Observables| row.kinetic_energy.is_finite() && row.total_energy().is_finite();
    check(problems, series(&mut device, scene).iter().all(finite), || format!("{what}: not a number"));
}

/// A device with room for a crowd, which a run makes when there is one.
fn device(scene: &Checked, state: &State) -> Engine<'static> {
    engine(scene, state, Options { list_growth: 6, storage: Some(Storage::Sorted), ..Options::default() })
}

const STEPS: u64 = 3;

/// Compares steps of a device, to which a state has been uploaded, with those of the reference.
fn compare(problems: &mut Problems, kind: Kind, scene: &Checked, device: &mut Engine<'_>, state: &State, what: &str) {
    let model = scene.model();
    let mut reference = kind.reference(model, state);
    let lightest = model.species.iter().map(|species| species.mass).fold(f64::INFINITY, f64::min).min(1.0);
    let drift = model.time_step * model.units.momentum / lightest / model.units.shortest_length() * 2_f64.powi(32);
    let mut found = state.clone();
    for step in 1..=STEPS as i64 {
        if !reference.attempt(1) {
            return problems.push(format!("{what}: the reference ends at step {step}"));
        }
        found = match device.advance(1, 1).and_then(|()| device.state()) {
            Ok(found) => found,
            Err(error) => return problems.push(format!("{what}: {error}")),
        };
        let (momentum, position) = largest_difference(&found, &reference.state());
        println!("{what}, step {step}: {momentum} units of momentum, {position} of position");
        let allowed = kind.units() * step;
        let moved = allowed + (allowed as f64 * step as f64 * drift) as i64;
        check(problems, momentum <= allowed, || format!("{what}: {momentum} units of momentum after step {step}"));
        check(problems, position <= moved, || format!("{what}: {position} units of position after step {step}"));
        conserved(problems, model, &found, state, what);
    }
    match series(device, scene).pop() {
        Some(row) => {
            let resolved = model.units.momentum.powi(2) / lightest * 1e3 + f64::MIN_POSITIVE;
            measured_alike(problems, &row, &kind.reference(model, &found).observe(), resolved, what);
        }
        None => problems.push(format!("{what}: no sample")),
    }
}

/// What a family conserves is the same integer.
fn conserved(problems: &mut Problems, model: &Model, found: &State, before: &State, what: &str) {
    // With what forces have added and boundaries and walls have taken.
    let particles = model.particles();
    let is_booked = particles.shear.is_some() || !particles.walls.is_empty();
    let exchanged = [before, found].map(State::exchanged_momentum);
    check(problems, !(model.conserves_momentum() || is_booked) || exchanged[0] == exchanged[1], || {
        format!("{what}: momentum {:?}, {:?} before", exchanged[1], exchanged[0])
    });
    let [before, after] = [totals(before), totals(found)];
    check(problems, (before.1, before.2) == (after.1, after.2), || format!("{what}: mass or energy changed"));
}

/// Energies on the device are those of the reference of the same state.
fn measured_alike(problems: &mut Problems, found: &Observables, expected: &Observables, resolved: f64, what: &str) {
    check(problems, found.particles == expected.particles, || format!("{what}: {} particles", found.particles));
    // A momentum of less than a unit may be there or not.
    let scale = expected.kinetic_energy.abs() + expected.potential_energy.abs() + resolved;
    for (name, a, b) in [
        ("kinetic energy", found.kinetic_energy, expected.kinetic_energy),
        ("potential energy", found.potential_energy, expected.potential_energy),
    ] {
        check(problems, (a - b).abs() <= 1e-3 * scale, || format!("{what}, {name}: {a}, {b} in the reference"));
    }
    let forces = expected.gradient_squared / expected.laplacian;
    if forces.is_finite() && forces > 0.0 {
        let ratio = found.gradient_squared / found.laplacian / forces;
        check(problems, (ratio - 1.0).abs() < 1e-2, || {
            format!("{what}: {ratio} of the configurational temperature {forces}")
        });
    }
}

/// That all was as it should be.
#[track_caller]
fn settle(problems: &Problems) {
    assert!(problems.found.is_empty(), "{}", problems.found.join("\n"));
}

fn strings(changes: &[&str]) -> Vec<String> {
    changes.iter().map(|change| (*change).to_owned()).collect()
}

macro_rules! walks {
    ($($name:ident),*) => {
        /// Half of the scenes, some of every kind.
        mod some {
            use super::{Problems, settle};

            $(
                #[test]
                fn $name() {
                    let mut problems = Problems { all: false, ..Problems::new() };
                    super::$name(&mut problems);
                    settle(&problems);
                }
            )*
        }

        mod all {
            use super::{Problems, settle};

            $(
                #[test]
                #[ignore = "minutes"]
                fn $name() {
                    let mut problems = Problems::new();
                    super::$name(&mut problems);
                    settle(&problems);
                }
            )*
        }
    };
}

walks!(
    no_particles_and_a_few,
    from_absolute_zero_to_great_heat_all_integers_are_the_same,
    cold_and_hot_beside_the_same_forces,
    densities_of_a_hundredth_and_of_a_hundred,
    boxes_from_two_cutoffs_to_a_million_and_of_a_thousand_to_one,
    frictions_and_rates_from_none_to_enormous
);

// ---- Particles

fn no_particles_and_a_few(problems: &mut Problems) {
    for kind in EVERY {
        for count in 0..=3 {
            let number = format!("particles.0.count={count}");
            let (changes, outcome) = match (kind, count) {
                (Chains | Melt, 1 | 2) => (vec![number], Refused("a multiple of 12, the beads of a chain")),
                (Chains | Melt, 3) => (vec![number, "particles.0.chain.beads=3".to_owned()], Right),
                (HarmonicChain, _) => {
                    let clusters = |part: &str| format!("interactions.0.{part}.clusters={count}");
                    let outcome = if count < 2 { Refused("a whole number from 2 to 65536") } else { Right };
                    (vec![clusters("pulse"), clusters("equilibrium")], outcome)
                }
                _ => (vec![number], Right),
            };
            expect(problems, kind, &changes, outcome);
        }
    }
}

/// Bytes of a buffer, or the numbers of particles, end before the particles that a scene can ask for.
#[test]
fn more_particles_than_an_adapter_holds_are_refused() {
    for kind in EVERY {
        let mut changes = strings(&["space.box=[8e4,8e4]", "particles.0.count=3999999996"]);
        match kind {
            Splitting | Sheared | ManyBody | Walled | Melt | GrootWarren | Memory | Chains | Oscillators => {
                "space.box=[2000,2000,2000]".clone_into(&mut changes[0]);
                changes.extend((kind == Sheared).then(|| "space.shear.rate=0.001".to_owned()));
            }
            HarmonicChain => {
                changes = ["pulse", "equilibrium"].map(|part| format!("interactions.0.{part}.clusters=65536")).to_vec();
                changes.extend(strings(&["space.box=[1e9]", "interactions.0.cluster_size=256"]));
            }
            _ => {}
        }
        let refusal = match kind.scene(&changes) {
            Err(refusal) => refusal.to_string(),
            Ok(scene) => match mesoscope::run::adapter_for(&scene, &adapter()) {
                Err(refusal) => refusal.to_string(),
                // Chains end with what a scene can ask for, which some adapters hold.
                Ok(_) if kind == HarmonicChain => continue,
                Ok(_) => panic!("{kind:?}: {changes:?}"),
            },
        };
        println!("{kind:?}: {refusal}");
        let reasons = [
            "allows at most",
            "at most 268435456 cells",
            "at most 4294967295",
            "at most 134,217,728; or `cotter-reich`",
        ];
        assert!(reasons.iter().any(|reason| refusal.contains(reason)), "{kind:?}: {refusal}");
    }
}

/// The largest number of particles that fits, and one step of it.
#[test]
#[ignore = "minutes, and gigabytes"]
fn as_many_particles_as_an_adapter_holds_take_a_step() {
    let mut problems = Problems::new();
    for kind in EVERY {
        let scene_of = |count: u64| {
            let edge = |dimension: i32| (count.max(64) as f64 / 3.0).powf(1.0 / f64::from(dimension)).max(5.0);
            let changes = match kind {
                Splitting | Sheared | ManyBody | Walled | Melt | GrootWarren | Memory | Chains | Oscillators => {
                    vec![format!("space.box=[{0},{0},{0}]", edge(3)), format!("particles.0.count={}", count / 12 * 12)]
                }
                HarmonicChain => {
                    let clusters = (count / 5).clamp(2, 65_536);
                    let part = |part: &str| format!("interactions.0.{part}.clusters={clusters}");
                    vec![part("pulse"), part("equilibrium"), "space.box=[1e6]".to_owned()]
                }
                ShallowWater => vec![format!("particles.0.count={count}")],
                ColouredNoise | Voronoi | VoronoiEnergy => {
                    vec![format!("space.box=[{0},{0}]", edge(2)), format!("particles.0.count={count}")]
                }
            };
            kind.scene(&[changes, vec!["time.step=0.0001".to_owned()]].concat()).unwrap()
        };
        // Particles at random crowd here and there, and fill their lists.
        let list_growth = u32::from(matches!(kind, Memory | Chains | Melt | ColouredNoise));
        let options = Options { list_growth, storage: Some(Storage::Sorted), ..Options::default() };
        let plan_of = |count: u64| {
            let scene = scene_of(count);
            mesoscope::run::plan(&scene, hardware(), options)
        };
        let open = |plan: &Plan| {
            let (largest_buffer, storage_buffers) = (plan.largest_buffer(), plan.storage_buffers);
            Gpu::open(&adapter(), Requirements { largest_buffer, storage_buffers, ..Requirements::default() })
        };
        // No more than the memory of a machine takes at some hundred bytes each.
        let (mut most, mut beyond) = (64, 1 << 23);
        while beyond - most > most / 64 {
            let middle = u64::midpoint(most, beyond);
            if open(&plan_of(middle)).is_ok() { most = middle } else { beyond = middle }
        }
        let scene = scene_of(most);
        let (model, state) = start(&scene);
        let plan = plan_of(most);
        let gpu = open(&plan).unwrap();
        let mut device = Engine::new(&gpu, plan, &state).unwrap();
        device.advance(1, 1).unwrap();
        let found = device.state().unwrap();
        println!("{kind:?}: {} particles", state.len());
        conserved(&mut problems, &model, &found, &state, &format!("{kind:?}"));
        assert_eq!((found.step, found.len()), (1, state.len()));
    }
    settle(&problems);
}

// ---- Temperatures

/// What goes with which power of the unit of velocity where energies change their unit, and lengths and masses do not.
const POWERS: [(&str, i32); 13] = [
    ("force", 2),
    ("upper_velocity", 1),
    ("repulsion", 2),
    ("friction", 1),
    ("stiffness", 2),
    ("strength", 4),
    ("time", -1),
    ("rate", 1),
    ("coupling", 2),
    ("wave_speed", 1),
    ("rotation", 1),
    ("viscosity", 1),
    ("conductivity", 1),
];

/// A scene in other units of velocity.
fn in_units_of_velocity(kind: Kind, unit: f64) -> Value {
    fn walk(value: &mut Value, scale: &dyn Fn(&str) -> Option<f64>) {
        match value {
            Value::Array(list) => list.iter_mut().for_each(|value| walk(value, scale)),
            Value::Object(object) => {
                for (key, value) in object.iter_mut() {
                    let scaled = |value: &Value, factor: f64| value.as_f64().map(|number| json!(number * factor));
                    match (value.as_array(), scale(key)) {
                        (None, Some(factor)) if value.is_number() => *value = scaled(value, factor).unwrap(),
                        (Some(list), Some(factor)) => {
                            *value = list.iter().map(|component| scaled(component, factor).unwrap()).collect();
                        }
                        _ => walk(value, scale),
                    }
                }
            }
            _ => {}
        }
    }
    let mut document = kind.document();
    let power = |key: &str| POWERS.iter().find(|(name, _)| *name == key).map(|(_, power)| unit.powi(*power));
    // The friction of harmonic chains is that of a cluster, √(mκ) in units of its own.
    let scale = |key: &str| if kind == HarmonicChain && key == "friction" { None } else { power(key) };
    walk(&mut document["interactions"], &scale);
    walk(&mut document["space"], &scale);
    for (place, power) in [("/temperature", 2), ("/time/step", -1)] {
        let value = document.pointer_mut(place).unwrap();
        *value = json!(value.as_f64().unwrap() * unit.powi(power));
    }
    document
}

/// kT of 2⁻⁴⁰ and of 2⁴⁰, 9·10⁻¹³ and 1.1·10¹² times that of the scene, with all else in proportion: the integers are those of
/// kT = 1, for whatever scales by powers of two does so in every digit.
fn from_absolute_zero_to_great_heat_all_integers_are_the_same(problems: &mut Problems) {
    for kind in EVERY {
        let run = |unit: f64| {
            let scene = scene::parse("heat", &in_units_of_velocity(kind, unit).to_string(), &[]).unwrap();
            let (model, state) = start(&scene);
            let mut device = device(&scene, &state);
            device.advance(10, 10).unwrap();
            let found = device.state().unwrap();
            (found.positions, found.momenta, found.masses, found.energies, model.units.momentum / unit)
        };
        let known = run(1.0);
        for power in [-20, 20] {
            if !problems.skip() {
                let alike = run(2_f64.powi(power)) == known;
                check(problems, alike, || format!("{kind:?}: velocities in units of 2^{power}"));
            }
        }
    }
}

/// In the cold, beside forces as they were, momenta have room for what forces do; where heat makes particles jump, the scene is
/// refused.
fn cold_and_hot_beside_the_same_forces(problems: &mut Problems) {
    for kind in EVERY {
        for temperature in ["0", "1e-12"] {
            expect(problems, kind, &strings(&[&format!("temperature={temperature}")]), Right);
        }
        let refusal = if kind == HarmonicChain { "so that no spring is inverted" } else { "thermal velocities of" };
        expect(problems, kind, &strings(&["temperature=1e12"]), Refused(refusal));
    }
}

// ---- Places

fn densities_of_a_hundredth_and_of_a_hundred(problems: &mut Problems) {
    let cube = |edge: f64| format!("space.box=[{edge},{edge},{edge}]");
    let square = |edge: f64| format!("space.box=[{edge},{edge}]");
    let dense = |count: u64, lengths: String| {
        vec![lengths, format!("particles.0.count={count}"), "time.step=0.0005".to_owned()]
    };
    for kind in EVERY {
        let (dilute, dense) = match kind {
            // Boundaries that shear have two cutoffs and a layer of one between them.
            Sheared => (cube(33.5), dense(1206, "space.box=[2,3,2]".to_owned())),
            Splitting | ManyBody | Walled | Melt | GrootWarren | Memory | Chains | Oscillators => {
                (cube(33.5), dense(804, cube(2.0)))
            }
            ColouredNoise => (square(120.0), dense(400, square(2.0))),
            // Beads that far apart; those that close could pass each other.
            HarmonicChain => {
                let spacing = |value: f64| format!("interactions.0.spacing={value}");
                expect(problems, kind, &[spacing(100.0), "space.box=[10000]".to_owned()], Right);
                expect(problems, kind, &[spacing(0.01)], Refused("so that no spring is inverted"));
                continue;
            }
            ShallowWater => (square(320.0), dense(1024, square(3.2))),
            Voronoi | VoronoiEnergy => (square(120.0), dense(144, square(1.2))),
        };
        expect(problems, kind, &[dilute], Right);
        expect(problems, kind, &dense, Right);
        if matches!(kind, Splitting | GrootWarren | Sheared | ManyBody | Walled | Memory | Chains | Melt) {
            let usual = [&dense[..], &["time.step=0.04".to_owned()]].concat();
            expect(problems, kind, &usual, Refused("oscillate"));
        }
    }
}

#[test]
fn particles_in_one_place() {
    let mut problems = Problems::new();
    for kind in EVERY {
        let place = |dimension: usize| vec![vec![1.5; dimension]; 24];
        let listed = |places: Vec<Vec<f64>>| {
            vec![
                "particles.0.count=null".to_owned(),
                format!(r#"particles.0.placement={{"type":"listed","positions":{places:?}}}"#),
            ]
        };
        let changes = match kind {
            // What grows with the density of all of them takes a step that is so short.
            ManyBody => [listed(place(3)), strings(&["time.step=1e-4"])].concat(),
            Splitting | Sheared | Walled | Melt | GrootWarren | Memory | Chains | Oscillators => listed(place(3)),
            ColouredNoise | ShallowWater => listed(place(2)),
            Voronoi | VoronoiEnergy => {
                let apart = vec![vec![4.5, 4.5], vec![1.5, 7.5], vec![7.5, 1.5]];
                let changes = listed([place(2)[..4].to_vec(), apart].concat());
                let outcome = if kind == Voronoi { Sound } else { Refused("found cells 0 and 1 in one place") };
                expect(&mut problems, kind, &changes, outcome);
                continue;
            }
            // Chains place their own.
            HarmonicChain => continue,
        };
        expect(&mut problems, kind, &changes, Right);
    }
    settle(&problems);
}

fn boxes_from_two_cutoffs_to_a_million_and_of_a_thousand_to_one(problems: &mut Problems) {
    for kind in EVERY {
        let boxes: &[&str] = match kind {
            Sheared => &["[2,3,2]", "[1e6,1e6,1e6]", "[2000,3,2]", "[3,3000,3]"],
            Splitting | ManyBody | Walled | Melt | GrootWarren | Memory | Chains => {
                &["[2,2,2]", "[1e6,1e6,1e6]", "[2000,2,2]"]
            }
            Oscillators => &["[8,8,8]", "[1e6,1e6,1e6]", "[8000,8,8]"],
            ColouredNoise | Voronoi | VoronoiEnergy => &["[2,2]", "[1e6,1e6]", "[2000,2]"],
            HarmonicChain => &["[160]", "[1e6]"],
            ShallowWater => &["[4,4]", "[1e6,1e6]", "[4000,4]"],
        };
        for lengths in boxes {
            // The flow at a boundary stays below a cutoff a step.
            let shear = (kind == Sheared).then_some("space.shear.rate=1e-4");
            let changes = [format!("space.box={lengths}"), "time.step=0.0005".to_owned()];
            let changes: Vec<String> = changes.into_iter().chain(shear.map(str::to_owned)).collect();
            expect(problems, kind, &changes, Right);
        }
        let narrow = match kind {
            Splitting | Sheared | ManyBody | Walled | Melt | GrootWarren | Memory | Chains => "[1.99,5,5]",
            ColouredNoise => "[1.99,5]",
            HarmonicChain => "[100]",
            Oscillators => "[1e-6,5,5]",
            ShallowWater | Voronoi | VoronoiEnergy => "[1e-6,5]",
        };
        let words = match kind {
            HarmonicChain => "twice the longest spring",
            Oscillators | ShallowWater | Voronoi | VoronoiEnergy => "a millionth of the longest edge",
            _ => "two cutoffs",
        };
        expect(problems, kind, &strings(&[&format!("space.box={narrow}")]), Refused(words));
    }
}

// ---- Friction and memory

fn frictions_and_rates_from_none_to_enormous(problems: &mut Problems) {
    let friction = |place: usize| format!("interactions.{place}.friction");
    for kind in EVERY {
        // What is right from nothing on, with what is refused when it is enormous; and what is right even then.
        let (limited, unlimited) = match kind {
            Splitting | Sheared | ManyBody | Walled | GrootWarren => (vec![(friction(0), "times over")], vec![]),
            Melt => (vec![(friction(0), "times over")], vec![friction(1), friction(3)]),
            // Along bonds it relaxes exactly.
            Chains => (vec![(friction(0), "times over")], vec![friction(1)]),
            Memory | Oscillators => (vec![(friction(0), "B + W is ")], vec!["interactions.0.bath.rate".to_owned()]),
            ColouredNoise => {
                let strength = ("interactions.1.strength".to_owned(), "velocities of the random force");
                (vec![(friction(0), "B + W is "), strength], vec!["interactions.1.time".to_owned()])
            }
            HarmonicChain => (vec![(friction(0), "B + W is ")], vec![]),
            ShallowWater => (vec![], vec!["interactions.0.bath.epsilon".to_owned()]),
            Voronoi => (vec![("interactions.0.viscosity".to_owned(), "friction dt η/M is ")], vec![]),
            VoronoiEnergy => (
                vec![("interactions.0.viscosity".to_owned(), "friction dt η/M is ")],
                vec!["interactions.0.energy.conductivity".to_owned()],
            ),
        };
        for (key, words) in &limited {
            for value in ["0", "1e-12"] {
                expect(problems, kind, &[format!("{key}={value}")], Right);
            }
            expect(problems, kind, &[format!("{key}=1e30")], Refused(words));
        }
        for key in &unlimited {
            // A force that never holds, and a rate at which friction is no coupling.
            let none = match kind {
                ColouredNoise => Some("a number greater than zero"),
                Memory | Oscillators => Some("which at a rate of 0 is no coupling at all"),
                _ => None,
            };
            expect(problems, kind, &[format!("{key}=0")], none.map_or(Right, Refused));
            if kind != ColouredNoise {
                expect(problems, kind, &[format!("{key}=1e-12")], Right);
            }
            expect(problems, kind, &[format!("{key}=1e30")], Right);
        }
        if matches!(kind, Memory | Oscillators) {
            let endless = strings(&[
                "interactions.0.friction=0",
                "interactions.0.bath.rate=0",
                "interactions.0.bath.coupling=20",
            ]);
            expect(problems, kind, &endless, Right);
        }
    }
}

// ---- The clock

/// Steps are counted in two words: those before and after the first is full, and the last that there are.
#[test]
fn step_counters_just_below_the_ends_of_their_words() {
    let mut problems = Problems::new();
    for kind in EVERY {
        let scene = kind.scene(&[]).unwrap();
        let (_, state) = start(&scene);
        let mut device = device(&scene, &state);
        device.advance(2, 2).unwrap();
        let settled = device.state().unwrap();
        for first in [u64::from(u32::MAX) - 1, u64::MAX - STEPS] {
            let mut state = State { step: first, ..settled.clone() };
            // What a pair remembers is as old as before.
            for pair in &mut state.pair_baths {
                pair.stamp = pair.stamp.wrapping_add((first - settled.step) as u32);
            }
            device.upload(&state).unwrap();
            compare(&mut problems, kind, &scene, &mut device, &state, &format!("{kind:?} from step {first}"));
            assert_eq!(device.step(), first + STEPS);
        }
        assert!(device.advance(1, 1).is_err(), "there is no step after the last");
    }
    settle(&problems);
}

#[test]
fn laws_are_exact_after_a_thousand_steps() {
    let mut problems = Problems::new();
    for kind in EVERY {
        laws_are_exact(&mut problems, kind, 1000);
    }
    settle(&problems);
}

/// One test for each kind, so that they run side by side.
mod laws_are_exact_after_a_million_steps {
    use super::{Kind, Problems, laws_are_exact, settle};

    macro_rules! of_kinds {
        ($($name:ident: $kind:ident),*) => {
            $(
                #[test]
                #[ignore = "minutes"]
                fn $name() {
                    let mut problems = Problems::new();
                    laws_are_exact(&mut problems, Kind::$kind, 1_000_000);
                    settle(&problems);
                }
            )*
        };
    }

    of_kinds!(
        splitting: Splitting,
        sheared: Sheared,
        many_body: ManyBody,
        walled: Walled,
        melt: Melt,
        groot_warren: GrootWarren,
        memory: Memory,
        chains: Chains,
        oscillators: Oscillators,
        coloured_noise: ColouredNoise,
        harmonic_chain: HarmonicChain,
        shallow_water: ShallowWater,
        voronoi: Voronoi,
        voronoi_energy: VoronoiEnergy
    );
}

/// After so many steps of a few particles what is conserved is the same integer, and temperatures are those of the scene.
fn laws_are_exact(problems: &mut Problems, kind: Kind, steps: u64) {
    let few = match kind {
        Sheared => strings(&["particles.0.count=36", "space.box=[2,3,2]"]),
        Splitting | ManyBody | Walled | GrootWarren | Memory => strings(&["particles.0.count=24", "space.box=[2,2,2]"]),
        // Weaker springs reach half of this box, where they turn over and heat.
        Chains | Melt => {
            strings(&["particles.0.count=24", "space.box=[2,2,2]", "interactions.1.potential.stiffness=40"])
        }
        Oscillators | ColouredNoise => strings(&["particles.0.count=64"]),
        HarmonicChain => vec![],
        ShallowWater => strings(&["particles.0.count=256", "interactions.0.mesh=[8,8]"]),
        Voronoi | VoronoiEnergy => strings(&["particles.0.count=16", "space.box=[4,4]"]),
    };
    let scene = kind.scene(&[few, vec![format!("output.energies.every={}", steps / 1000)]].concat()).unwrap();
    let (model, state) = start(&scene);
    let mut device = device(&scene, &state);
    let began = Instant::now();
    device.advance(steps, 1000).unwrap();
    let found = device.state().unwrap_or_else(|error| panic!("{kind:?}: {error}"));
    assert_eq!(found.step, steps);
    conserved(problems, &model, &found, &state, &format!("{kind:?} after {steps} steps"));
    let rows = series(&mut device, &scene);
    assert!(rows.iter().all(|row| row.kinetic_energy.is_finite() && row.potential_energy.is_finite()), "{kind:?}");
    let late = &rows[rows.len() / 5..];
    let mean = late.iter().map(Observables::kinetic_temperature).sum::<f64>() / late.len() as f64;
    println!("{kind:?}: kT = {mean:.4} after {steps} steps in {:.0?}", began.elapsed());
    // What is driven, or far from equilibrium at the start, has no temperature of its own. Of the others the fewest have 30 degrees
    // of freedom: in 800 independent samples their mean is off by .009, in ten units of time by up to .1; the schemes add .01.
    let has_a_law = !matches!(kind, ColouredNoise | HarmonicChain | ShallowWater | Sheared | Walled);
    let tolerance = if steps >= 1_000_000 { 0.05 } else { 0.4 };
    check(problems, !has_a_law || (mean - 1.0).abs() < tolerance, || {
        format!("{kind:?}: kT = {mean} after {steps} steps")
    });
}
