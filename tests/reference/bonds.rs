//! Bonds, angles and exclusions on the device: against the float64 reference, against their own energies, and for what has to
//! be exact.

use mesoscope::engine::{Engine, EngineError};
use mesoscope::families::Instability;
use mesoscope::plan::{Options, Traversal};
use mesoscope::scene::Checked;
use mesoscope::state::State;
use serde_json::{Value, json};

use crate::support::{
    COTTER_REICH, Device, GROOT_WARREN, INTEGRATORS, Implementation, Measured, PREDICTED, SPLITTING, STAGED,
    SideBySide, engine, observables, same_energies, start,
};

fn read(document: &Value) -> Checked {
    crate::support::scene(&document.to_string())
}

/// Chains of ten beads of two species in solvent, with bonds, in a box of some edges.
fn polymers(edges: &[f64], interactions: &Value) -> Value {
    let volume: f64 = edges.iter().product();
    let chains = (0.1 * volume).round() as u64;
    json!({
        "title": "polymers",
        "seed": 7,
        "space": {"box": edges},
        "time": {"step": 0.01, "steps": 1},
        "temperature": 1.3,
        "particles": [
            {"species": "head", "count": 4 * chains, "mass": 2, "chain": {"beads": 4, "spacing": 0.8, "closed": true}},
            {"species": "solvent", "count": chains},
            {"species": "tail", "count": 6 * chains, "chain": {"beads": 6, "spacing": 0.7}},
        ],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

/// Both round impulses to integers, some 2⁻²⁴ of a thermal momentum; single precision adds an error of some 2⁻²³ of an impulse
/// of at most 2²³ units for each of a few dozen couplings of a particle. Noise alone is ten thousand times as large.
const UNITS: i64 = 100;

/// Lets the device and the reference take some steps; returns both.
fn step_alike(scene: Checked, what: &str) -> (Engine<'static>, Box<dyn Implementation>) {
    let (model, state) = start(&scene);
    let mut both = SideBySide::new(scene, model, &state, Options::default());
    both.steps(4, UNITS, what, |step, found, expected| {
        assert_eq!(found.bond_baths.len(), expected.bond_baths.len());
        for (bond, (a, b)) in found.bond_baths.iter().zip(&expected.bond_baths).enumerate() {
            let [a, b] = [a, b].map(|bits| f32::from_bits(*bits));
            assert!(
                (a - b).abs() <= 1e-4 * b.abs().max(1.0),
                "step {step}: bath {bond} is {a}, and {b} in the reference"
            );
        }
    });
    (both.device, both.reference)
}

pub fn agree(document: &Value) {
    agree_of(&read(document), &format!("{document:#}"));
}

fn agree_of(scene: &Checked, what: &str) {
    let (mut device, mut reference) = step_alike(scene.clone(), what);
    let measured = observables(&mut device, scene);
    let expected = reference.observe();
    same_energies(&measured, &expected, 0.0, what);
}

const BOXES: [&[f64]; 3] = [&[61.0], &[9.0, 7.0], &[5.0, 4.0, 4.5]];

fn everywhere(interactions: &Value) {
    for edges in BOXES {
        agree(&polymers(edges, interactions));
    }
}

#[test]
fn potentials_agree_with_the_reference() {
    let harmonic = json!({"type": "harmonic", "stiffness": 40, "length": 0.8});
    let spring = json!({"type": "harmonic", "stiffness": 4});
    let fene = json!({"type": "fene", "stiffness": 30, "extent": 1.5});
    let shifted = json!({"type": "fene", "stiffness": 30, "extent": 0.9, "length": 0.5});
    for potential in [&harmonic, &spring, &fene, &shifted] {
        everywhere(&json!([{"type": "bonds", "potential": potential}]));
    }
    everywhere(&json!([
        {"type": "bonds", "potential": harmonic, "species": ["tail"]},
        {"type": "bonds", "potential": shifted, "species": ["head"]},
    ]));
}

/// Bonds with a largest force, which those of chains exceed at the start.
#[test]
fn limited_bonds_agree_with_the_reference() {
    let harmonic = json!({"type": "harmonic", "stiffness": 40, "length": 0.2});
    let fene = json!({"type": "fene", "stiffness": 30, "extent": 0.5, "length": 0.1});
    for (potential, edges) in [(&harmonic, BOXES[1]), (&fene, BOXES[2])] {
        for integrator in [COTTER_REICH, SPLITTING] {
            let interactions = json!([
                {"type": "dpd", "repulsion": 25, "friction": 4.5}, {"type": "bonds", "potential": potential}]);
            let mut document = polymers(edges, &interactions);
            document["stages"] = json!([{"steps": 1, "push_off": 8}]);
            document["output"] = json!({"energies": {"every": 1}});
            document["integrator"] = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
            agree_of(&read(&document).of_stages()[0], &format!("{document:#}"));
        }
    }
}

#[test]
fn baths_of_bonds_agree_with_the_reference() {
    let harmonic = json!({"type": "harmonic", "stiffness": 40, "length": 0.8});
    everywhere(&json!([{"type": "bonds", "potential": harmonic, "friction": 4.5}]));
    everywhere(&json!([{"type": "bonds", "friction": 4.5, "bath": {"type": "white", "temperature": 0}}]));
    // Every scheme at every rate, and either in every box.
    for (row, scheme) in ["cotter-reich", "symmetric", "exponential"].into_iter().enumerate() {
        for (column, rate) in [0.1, 20.0, 150.0].into_iter().enumerate() {
            let bath = json!({"type": "memory", "rate": rate, "scheme": scheme, "temperature": 0.7});
            let interactions = json!([{"type": "bonds", "potential": harmonic, "friction": 4.5, "bath": bath}]);
            agree(&polymers(BOXES[(row + column) % 3], &interactions));
        }
    }
    let endless = json!({"type": "memory", "rate": 0, "coupling": 50});
    everywhere(&json!([
        {"type": "bonds", "potential": harmonic, "bath": endless, "species": ["tail"]},
        {"type": "bonds", "potential": harmonic, "friction": 3, "species": ["head"]},
    ]));
}

#[test]
fn angles_agree_with_the_reference() {
    let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.8}});
    everywhere(&json!([bonds, {"type": "angles", "stiffness": 6}]));
    everywhere(
        &json!([bonds, {"type": "angles", "stiffness": -3, "species": ["head"]}, {"type": "angles", "stiffness": 5}]),
    );
}

#[test]
fn bonds_in_a_fluid_agree_with_the_reference() {
    let potential = json!({"type": "harmonic", "stiffness": 40, "length": 0.8});
    let white = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let mut memory = white.clone();
    memory["bath"] = json!({"type": "memory", "rate": 10});
    // Either fluid in every box, and with bonds that exclude and that do not.
    for (row, dpd) in [white, memory].into_iter().enumerate() {
        for (column, edges) in BOXES.into_iter().enumerate() {
            let exclude = (row + column) % 2 == 1;
            let interactions = json!([
                dpd,
                {"type": "bonds", "potential": potential, "friction": 2, "exclude_repulsion": exclude},
                {"type": "angles", "stiffness": 3},
            ]);
            agree(&polymers(edges, &interactions));
        }
    }
}

/// Bonds and angles without baths, in the steps of every integrator of pairs.
#[test]
fn bonds_beside_pairs_agree_with_the_reference() {
    let harmonic = json!({"type": "harmonic", "stiffness": 40, "length": 0.8});
    let fene = json!({"type": "fene", "stiffness": 30, "extent": 1.5});
    for integrator in [
        json!({"type": "splitting"}),
        json!({"type": "splitting", "relaxation": "two-stages"}),
        json!({"type": "groot-warren", "lambda": 0.65}),
        json!({"type": "groot-warren", "lambda": 0.5}),
        json!({"type": "cotter-reich"}),
    ] {
        for edges in &BOXES[1..] {
            let mut document = polymers(
                edges,
                &json!([
                    {"type": "dpd", "repulsion": 25, "friction": 4.5,
                        "pairs": [{"between": ["head", "tail"], "repulsion": 40, "friction": 2}]},
                    {"type": "bonds", "potential": harmonic, "species": ["tail"]},
                    {"type": "bonds", "potential": fene, "species": ["head"], "exclude_repulsion": true},
                    {"type": "bonds", "pairs": [[0, 1], [1, 2], [0, 2]], "exclude_repulsion": true},
                    {"type": "angles", "stiffness": 5, "species": ["tail"]},
                ]),
            );
            document["integrator"] = integrator.clone();
            agree(&document);
        }
    }
}

#[test]
fn both_generators_agree_with_the_reference() {
    let mut document = polymers(BOXES[2], &json!([{"type": "bonds", "friction": 4.5}]));
    document["noise"] = json!({"generator": "threefry2x32-20"});
    agree(&document);
}

#[test]
fn chains_between_fixed_ends_agree_with_the_reference() {
    for edges in BOXES {
        let middle = |x: f64| edges.iter().map(|edge| 0.5 * edge + x).collect::<Vec<f64>>();
        let listed = |positions: Vec<Vec<f64>>| json!({"type": "listed", "positions": positions});
        agree(&json!({
            "title": "held", "space": {"box": edges}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
            "particles": [
                {"species": "wall", "fixed": true, "placement": listed(vec![middle(-0.8), middle(0.9)])},
                {"species": "bead", "placement": listed(vec![middle(-0.2), middle(0.3)])},
            ],
            "interactions": [
                {"type": "bonds", "pairs": [[0, 2], [2, 3], [3, 1]], "friction": 3,
                    "potential": {"type": "harmonic", "stiffness": 60, "length": 0.5}},
                {"type": "angles", "triples": [[0, 2, 3], [2, 3, 1]], "stiffness": 2},
            ],
            "output": {"energies": {"every": 1}},
        }));
    }
}

/// A fluid in a box whose fixed particles are obstacles.
fn porous(edges: &[f64], integrator: &str, interactions: &Value) -> Value {
    let volume: f64 = edges.iter().product();
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    json!({
        "title": "porous", "space": {"box": edges}, "time": {"step": 0.02, "steps": 1}, "temperature": 1,
        "integrator": integrator,
        "particles": [
            {"species": "wall", "fixed": true, "count": (0.5 * volume) as u64, "placement": {"type": "lattice"}},
            {"species": "fluid", "count": (2.5 * volume) as u64, "mass": 1.5},
        ],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

/// What does not move has no predicted momentum either.
#[test]
fn a_fluid_beside_fixed_particles_agrees_with_the_reference() {
    let fluid = json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}]);
    for edges in BOXES {
        for &integrator in INTEGRATORS {
            let splits = integrator == SPLITTING || integrator == STAGED;
            if edges.len() > 1 || !splits {
                agree(&porous(edges, integrator, &fluid));
            }
        }
    }
    let attracting =
        json!([{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25, "cutoff": 0.75}}]);
    let bathed = json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}, {"type": "langevin", "friction": 2}]);
    // One bond to a fixed particle, one between two of them.
    let bonded = json!([
        {"type": "dpd", "repulsion": 25, "friction": 4.5},
        {"type": "bonds", "pairs": [[0, 1], [1, 20]], "friction": 3, "potential": {"type": "harmonic", "stiffness": 1}},
        {"type": "bonds", "pairs": [[2, 21]], "exclude_repulsion": true}]);
    let smooth = json!([{"type": "dpd", "repulsion": 25, "friction": 0}, {"type": "langevin", "friction": 2}]);
    let mut everything = bonded.clone();
    everything[0] = attracting[0].clone();
    everything[2] = json!({"type": "tether", "stiffness": 5});
    everything.as_array_mut().unwrap().push(bathed[1].clone());
    for interactions in [&attracting, &bathed, &bonded, &smooth, &everything] {
        for integrator in [SPLITTING, STAGED] {
            agree(&porous(BOXES[2], integrator, interactions));
        }
    }
    for integrator in [GROOT_WARREN, COTTER_REICH] {
        agree(&porous(BOXES[1], integrator, &attracting));
    }
    // What acts on single particles in steps that are not split, beside local densities and bonds.
    let noise = json!({"type": "coloured-noise", "strength": 20, "time": 0.1});
    let remembering = json!({"type": "langevin", "friction": 2, "bath": {"type": "memory", "rate": 3}});
    let tether = json!({"type": "tether", "stiffness": 5});
    let bond = json!({"type": "bonds", "pairs": [[0, 1], [2, 20]], "potential": {"type": "harmonic", "stiffness": 1}});
    for (integrator, others) in [
        (COTTER_REICH, vec![&remembering, &noise]),
        (COTTER_REICH, vec![&remembering, &tether]),
        (COTTER_REICH, vec![&bathed[1], &bond]),
        (PREDICTED, vec![&noise, &tether]),
    ] {
        let mut interactions = attracting.clone();
        interactions.as_array_mut().unwrap().extend(others.into_iter().cloned());
        agree(&porous(BOXES[2], integrator, &interactions));
        interactions[0] = json!({"type": "dpd", "repulsion": 25, "friction": 4.5, "pairs": [
            {"between": ["wall", "fluid"], "cutoff": 0.8}]});
        agree(&porous(BOXES[1], integrator, &interactions));
    }
}

/// The same without memory, in split steps.
fn split_melt() -> Value {
    polymers(
        BOXES[2],
        &json!([
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "fene", "stiffness": 30, "extent": 1.5}},
            {"type": "angles", "stiffness": 3},
        ]),
    )
}

fn melt() -> Value {
    polymers(
        BOXES[2],
        &json!([
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "fene", "stiffness": 30, "extent": 1.5}, "friction": 3,
                "bath": {"type": "memory", "rate": 15}, "exclude_repulsion": true},
            {"type": "angles", "stiffness": 3},
        ]),
    )
}

#[test]
fn momentum_never_moves() {
    let split = BOXES[1..].iter().map(|edges| (split_melt(), *edges));
    for (mut document, edges) in BOXES.iter().map(|edges| (melt(), *edges)).chain(split) {
        document["space"]["box"] = json!(edges);
        let scene = read(&document);
        let (_, state) = start(&scene);
        let mut device = engine(&scene, &state, Options::default());
        device.advance(300, 50).unwrap();
        let after = device.state().unwrap();
        assert_ne!(after.positions, state.positions);
        assert_eq!(after.total_momentum(), state.total_momentum(), "{edges:?}");
    }
}

fn after(scene: &Checked, options: Options, order: impl Fn(usize) -> usize, batch: u64) -> State {
    let (_, state) = start(scene);
    let mut device = engine(scene, &state, options);
    let stored: Vec<usize> = (0..state.len()).map(order).collect();
    device.upload_in_order(&state, &stored).unwrap();
    device.advance(60, batch).unwrap();
    device.state().unwrap()
}

#[test]
fn the_same_bits_whatever_the_order() {
    for mut document in [melt(), split_melt()] {
        let scene = read(&document);
        let count = start(&scene).1.len();
        let plain = after(&scene, Options::default(), |id| id, 60);
        assert_eq!(plain, after(&scene, Options::default(), |id| id, 7), "batches");
        assert_eq!(plain, after(&scene, Options::default(), |id| count - 1 - id, 60), "storage order");
        let narrow = Options { workgroup_size: Some(16), ..Options::default() };
        assert_eq!(plain, after(&scene, narrow, |id| id, 60), "workgroups");
        if start(&scene).0.particles().splits() {
            let rows = Options { traversal: Some(Traversal::Rows), ..Options::default() };
            assert_eq!(plain, after(&scene, rows, |id| id, 60), "traversals");
        }
        // From the middle on.
        let (model, state) = start(&scene);
        let mut first = engine(&scene, &state, Options::default());
        first.advance(23, 23).unwrap();
        let middle = first.state().unwrap();
        assert!(!model.has_memory() || middle.bond_baths.iter().any(|bits| *bits != 0));
        let mut second = engine(&scene, &middle, Options::default());
        second.advance(37, 37).unwrap();
        assert_eq!(plain, second.state().unwrap(), "restart");
        // Whether anybody looks.
        document["output"]["energies"]["every"] = json!(1000);
        assert_eq!(plain, after(&read(&document), Options::default(), |id| id, 60), "reports");
    }
}

/// Particles at rest in some places; the impulse of the first half kick is -dt/2 ∇V.
fn still(positions: &[Vec<f64>], interactions: &Value) -> (Engine<'static>, Checked) {
    let scene = read(&json!({
        "title": "still", "space": {"box": vec![8.0; positions[0].len()]}, "time": {"step": 0.01, "steps": 1}, "temperature": 0,
        "particles": [{"species": "bead", "placement": {"type": "listed", "positions": positions},
            "velocities": {"type": "rest"}}],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    }));
    let (_, state) = start(&scene);
    (engine(&scene, &state, Options::default()), scene)
}

/// Energies are reported with 24 bits: a difference over 0.02 of energies of a few is good to 1e-4, and its truncation, a
/// third derivative of a hundred at most times 1e-4/6, to 2e-3.
#[test]
fn forces_are_the_slopes_of_the_reported_energy() {
    let corners: [&[f64]; 4] = [&[4.0, 4.0, 4.0], &[4.6, 4.5, 4.1], &[4.9, 5.2, 3.6], &[4.2, 5.3, 3.9]];
    let angles = json!([{"type": "angles", "triples": [[0, 1, 2], [3, 2, 1]], "stiffness": 3}]);
    let harmonic = json!([{"type": "bonds", "pairs": [[0, 1], [2, 1], [3, 0]],
        "potential": {"type": "harmonic", "stiffness": 7, "length": 0.9}}]);
    let fene = json!([{"type": "bonds", "pairs": [[0, 1], [2, 1], [3, 0]],
        "potential": {"type": "fene", "stiffness": 7, "extent": 1.6}}]);
    for (name, interactions) in [("angles", angles), ("harmonic", harmonic), ("fene", fene)] {
        for dimension in [2, 3] {
            let places: Vec<Vec<f64>> = corners.iter().map(|corner| corner[..dimension].to_vec()).collect();
            let (mut device, scene) = still(&places, &interactions);
            let (model, state) = start(&scene);
            device.advance(1, 1).unwrap();
            let kicked = device.state().unwrap();
            for particle in 0..4 {
                for axis in 0..dimension {
                    let mut energy = |shift: f64| {
                        let mut moved = state.clone();
                        let units = (shift / model.units.lengths[axis] * 4_294_967_296.0) as i32;
                        let position = &mut moved.positions[particle][axis];
                        *position = position.wrapping_add_signed(units);
                        device.upload(&moved).unwrap();
                        observables(&mut device, &scene).potential_energy
                    };
                    let slope = (energy(0.01) - energy(-0.01)) / 0.02;
                    let force = model.units.momentum(kicked.momenta[particle])[axis] / (0.5 * scene.time.step);
                    let what = format!("{name}, {dimension} dimensions, particle {particle}, axis {axis}");
                    assert!((force + slope).abs() < 3e-3 * slope.abs().max(1.0), "{what}: {force} and {}", -slope);
                }
            }
        }
    }
}

/// Many dimers on a line, each a harmonic oscillator of reduced mass ½ with a bath along its bond:
/// ⟨q²⟩ = (kT/K)(4 - B)/(4 - B - W), Cotter and Reich's family of schemes, at B + W = 2 and 3. `physics` has the other schemes.
#[test]
fn dimers_spread_as_the_scheme_says() {
    let (step, stiffness, mass) = (0.1_f64, 50.0_f64, 0.5_f64);
    let w = stiffness * step * step / mass;
    for (b, bath) in
        [(1.0, json!({"type": "white"})), (2.0, json!({"type": "memory", "rate": 3, "scheme": "exponential"}))]
    {
        let rate = bath["rate"].as_f64().unwrap_or(0.0);
        let coupling = b * mass / (step * step);
        let friction = match bath["scheme"].as_str() {
            Some(_) => coupling * (0.5 * rate * step) / (0.5 * rate * step).tanh() / rate,
            None => 0.5 * coupling * step,
        };
        let scene = read(&json!({
            "title": "dimers", "seed": 5, "space": {"box": [500]}, "time": {"step": step, "steps": 1}, "temperature": 1,
            "particles": [{"species": "bead", "count": 8192, "chain": {"beads": 2, "spacing": 20}}],
            "interactions": [{"type": "bonds", "friction": friction, "bath": bath,
                "potential": {"type": "harmonic", "stiffness": stiffness, "length": 20}}],
            "output": {"energies": {"every": 10}},
        }));
        let mut device = Device::new(&scene);
        device.step(200);
        let series = device.series(10, 70);
        let dimers = 4096.0;
        let spread: Vec<f64> = series.iter().map(|row| 2.0 * row.potential_energy / stiffness / dimers).collect();
        let expected = (4.0 - b) / (4.0 - b - w) / stiffness;
        let heat: Vec<f64> = series.iter().map(mesoscope::measure::Observables::kinetic_temperature).collect();
        // A mean square of 4096 independent numbers has an error of 2 %, and 70 samples make it a seventh of that: the factor 1.5 or 2
        // over 1/K is 150 of them.
        Measured::of(&spread).assert(&format!("q² with {bath}"), expected, 0.0, 0.005 * expected);
        // Of the two momenta of a dimer the common one stays as it was drawn: an error of √(1/8192) for it alone.
        Measured::of(&heat).assert(&format!("kT with {bath}"), 1.0, 4.0 * (1.0_f64 / 8192.0).sqrt(), 0.005);
    }
}

#[test]
fn a_bond_that_is_torn_ends_the_run() {
    let interactions = json!([{"type": "bonds", "pairs": [[2, 3], [0, 1]],
        "potential": {"type": "fene", "stiffness": 1, "extent": 1}}]);
    let places = json!([[1.0, 1.0, 1.0], [1.9, 1.0, 1.0], [5.0, 5.0, 5.0], [5.5, 5.0, 5.0]]);
    let speeds = json!([[0, 0, 0], [20, 0, 0], [0, 0, 0], [0, 0, 0]]);
    let scene = read(&json!({
        "title": "torn", "space": {"box": [8, 8, 8]}, "time": {"step": 0.01, "steps": 10}, "temperature": 0,
        "particles": [{"species": "bead", "placement": {"type": "listed", "positions": places},
            "velocities": {"type": "listed", "velocities": speeds}}],
        "interactions": interactions,
    }));
    let (model, state) = start(&scene);
    let mut device = engine(&scene, &state, Options::default());
    device.advance(10, 10).unwrap();
    let Err(EngineError::Unstable(failure)) = device.finish() else { panic!("the bond holds") };
    let Instability { step, quantity, .. } = Instability::new(&failure, device.plan(), &model);
    assert_eq!(quantity, "bond 1 is stretched beyond the extent of its potential");
    assert_eq!(step, 1);
}

#[test]
fn bonded_pairs_are_spared_their_repulsion() {
    // Three in a row, half a cutoff apart: V = a/2 · ½² for each pair that touches, and the ends just do not.
    let places = json!([[1.0, 1.0, 1.0], [1.5, 1.0, 1.0], [2.0, 1.0, 1.0]]);
    for (exclude, touching) in [(false, 2.0), (true, 1.0)] {
        let scene = read(&json!({
            "title": "spared", "space": {"box": [8, 8, 8]}, "time": {"step": 0.01, "steps": 1}, "temperature": 0,
            "particles": [{"species": "bead", "placement": {"type": "listed", "positions": places},
                "velocities": {"type": "rest"}}],
            "interactions": [
                {"type": "dpd", "repulsion": 24},
                {"type": "bonds", "pairs": [[2, 1]], "exclude_repulsion": exclude,
                    "potential": {"type": "harmonic", "stiffness": 8}},
            ],
            "output": {"energies": {"every": 1}},
        }));
        let (_, state) = start(&scene);
        let mut device = engine(&scene, &state, Options::default());
        let energy = observables(&mut device, &scene).potential_energy;
        assert!((energy - (1.0 + 3.0 * touching)).abs() < 1e-5, "{energy} with {touching}");
    }
}
