//! What is promised to the last bit holds on any compiler: with products and sums contracted wherever WGSL allows it, in every
//! kernel of every family and on the plans of graphics cards and of software adapters.

use mesoscope::engine::Engine;
use mesoscope::families::shallow_water::WaterLayout;
use mesoscope::families::voronoi::CellLayout;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options, Traversal};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use mesoscope::shaders::Array;
use mesoscope::state::State;

use crate::support::compiler::{Compiler, Contraction, can_contract};
use crate::support::{
    COTTER_REICH, ENERGY, GROOT_WARREN, INTEGRATORS, MIXTURE, MIXTURE_FORCE, PREDICTED, SPLITTING, cells, fluid, start,
    totals, water,
};

const STEPS: u64 = 50;
const EVERY: u64 = 10;
const REPORTS: &str = "output.energies.every=10";
const TWO_DIMENSIONS: &str = "space.box=[12,9]";
const MEMORY: &str = r#"interactions.0.bath={"type":"memory","rate":5}"#;
/// Pairs with cutoffs and exponents of their own.
const OWN_COEFFICIENTS: &str = r#"interactions.0.pairs=[{"between":["A","B"],"cutoff":0.8,"weight_exponent":1},
    {"between":["B","B"],"cutoff":1.3,"friction":9}]"#;
/// Attraction, and a repulsion that grows with the density.
const LIQUID: &str = r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}]"#;
const GAUSSIAN: &str = r#"noise={"distribution":"gaussian"}"#;

/// A scene, and whether its pairs are listed.
struct Case {
    name: String,
    scene: Checked,
    listed: bool,
}

fn fluids() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |changes: &[&str], listed: bool| {
        let scene = fluid(&[changes, &["space.box=[4,4,4]", REPORTS], changes].concat());
        cases.push(Case { name: format!("{} listed={listed}", changes.join(" ")), scene, listed });
    };
    for integrator in INTEGRATORS {
        add(&[integrator], false);
        add(&[integrator, MIXTURE, MIXTURE_FORCE, TWO_DIMENSIONS], false);
    }
    add(&[SPLITTING, TWO_DIMENSIONS, "interactions.0.weight_exponent=0.3", GAUSSIAN], false);
    add(&[GROOT_WARREN, MIXTURE, MIXTURE_FORCE, GAUSSIAN], true);
    for (integrator, listed) in [(SPLITTING, false), (COTTER_REICH, false), (COTTER_REICH, true)] {
        add(&[integrator, MIXTURE, OWN_COEFFICIENTS], listed);
    }
    add(&[COTTER_REICH, TWO_DIMENSIONS], true);
    add(&[COTTER_REICH, MEMORY, "time.step=0.02"], false);
    add(
        &[
            r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","profile":"sinusoidal","force":[1,2,0],"axis":"y"}]"#,
        ],
        false,
    );
    add(
        &[
            COTTER_REICH,
            r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","profile":"opposed","force":[1,2,0],"axis":"z"}]"#,
        ],
        true,
    );
    add(&[COTTER_REICH, MIXTURE, MIXTURE_FORCE, MEMORY, "time.step=0.02", TWO_DIMENSIONS], false);
    for integrator in [SPLITTING, COTTER_REICH] {
        add(&[integrator, MIXTURE, LIQUID, "time.step=0.01"], false);
    }
    for integrator in [SPLITTING, PREDICTED] {
        add(&[integrator, r#"space.walls={"z":{"upper_velocity":[1,-0.3,0]}}"#], false);
        add(&[integrator, MIXTURE, r#"space.shear={"rate":0.8,"gradient":"z"}"#], false);
    }
    cases
}

/// Closed and open chains with every coupling that keeps momentum.
const CHAINS: &str = r#"{
        "title": "chains", "seed": 7, "space": {"box": [6, 5, 5]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1.3,
        "particles": [
            {"species": "head", "count": 40, "mass": 2, "chain": {"beads": 4, "spacing": 0.8, "closed": true}},
            {"species": "solvent", "count": 60},
            {"species": "tail", "count": 60, "chain": {"beads": 6, "spacing": 0.7}}],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5, "bath": {"type": "memory", "rate": 5}},
            {"type": "bonds", "potential": {"type": "fene", "stiffness": 30, "extent": 1.5}, "friction": 4.5,
                "bath": {"type": "memory", "rate": 20}},
            {"type": "angles", "stiffness": 6}],
        "output": {"energies": {"every": 10}}
    }"#;

fn chains() -> Case {
    Case { name: "chains".to_owned(), scene: scene::parse("test", CHAINS, &[]).unwrap(), listed: false }
}

/// The same without memory: bonds and angles beside pairs, in the steps of every integrator.
fn chains_beside_pairs() -> Vec<Case> {
    INTEGRATORS
        .iter()
        .map(|integrator| {
            let changes = [
                *integrator,
                r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
                    {"type":"bonds","potential":{"type":"fene","stiffness":30,"extent":1.5},"exclude_repulsion":true},{"type":"angles","stiffness":6}]"#,
            ];
            let changes: Vec<String> = changes.into_iter().map(str::to_owned).collect();
            let scene = scene::parse("test", CHAINS, &changes).unwrap();
            Case { name: format!("chains {integrator}"), scene, listed: false }
        })
        .collect()
}

fn voronoi() -> Vec<Case> {
    let mut cases = Vec::new();
    for form in ["gradient", "consistent", "paper"] {
        for (integrator, step) in [("splitting", "0.01"), ("euler", "0.001")] {
            for energy in [&[][..], &[ENERGY, "interactions.0.molecular_mass=0.1"]] {
                let changes = [
                    format!(r#"interactions.0.form="{form}""#),
                    format!(r#"integrator.type="{integrator}""#),
                    format!("time.step={step}"),
                ];
                let changes: Vec<&str> =
                    changes.iter().map(String::as_str).chain([REPORTS]).chain(energy.iter().copied()).collect();
                let name = format!("voronoi {form} {integrator} energy={}", !energy.is_empty());
                cases.push(Case { name, scene: cells(90, &changes), listed: false });
            }
        }
    }
    cases
}

fn meshes() -> Vec<Case> {
    let bath = r#"interactions.0.bath={"type":"memory","epsilon":1}"#;
    [vec![], vec!["interactions.0.spline_order=2", r#"integrator.type="rotate""#], vec!["temperature=4e-4", bath]]
        .into_iter()
        .map(|changes| Case {
            name: format!("water {}", changes.join(" ")),
            scene: water(&[&changes[..], &[REPORTS]].concat()),
            listed: false,
        })
        .collect()
}

/// What has to stay: momentum, and of cells mass and energy, in integer units.
fn conserved(state: &State) -> Vec<i64> {
    let (momentum, mass, energy) = totals(state);
    momentum.into_iter().chain([mass, energy]).collect()
}

/// Of the nodes of the mesh, in integer units.
fn mesh_mass(engine: &mut Engine<'_>) -> Vec<i64> {
    vec![engine.words(Array::NodeMasses).unwrap().into_iter().map(i64::from).sum()]
}

/// What does not stay in a case on a device.
fn losses(case: &Case, gpu: &Gpu, options: Options) -> Vec<String> {
    let options = Options { listed: case.listed, ..options };
    let (model, mut state) = start(&case.scene);
    let hardware = Hardware::from(gpu);
    let plan = run::plan(&case.scene, hardware, options);
    let mesh = plan.layout.of::<WaterLayout>().is_some();
    if !mesh {
        // A momentum that is not zero, so that its loss would show as well as its gain.
        state.momenta[0][0] += 123_457;
    }
    let mut engine = Engine::new(gpu, plan, &state).unwrap();
    // A node has 2²⁴ units on average.
    let expected = match model.shallow_water() {
        Some(water) => vec![(water.nodes() << 24) as i64],
        None => conserved(&state),
    };
    let mut lost = Vec::new();
    for _ in 0..STEPS / EVERY {
        engine.advance(EVERY, EVERY).unwrap();
        let found = if mesh { mesh_mass(&mut engine) } else { conserved(&engine.state().unwrap()) };
        if found != expected {
            lost.push(format!("step {}: {found:?}, not {expected:?}", engine.step()));
        }
    }
    if !mesh {
        assert_ne!(engine.state().unwrap().momenta, state.momenta, "{}: nothing moves", case.name);
        let first = if engine.plan().layout.of::<CellLayout>().is_some() { 1 } else { 2 };
        let momentum = &expected[..if first == 1 { 2 } else { 3 }];
        for sample in engine.finish().unwrap().iter().filter(|sample| sample.sampler == 0) {
            let mut found = sample.sums[first..first + momentum.len()].to_vec();
            if model.particles().body_forces.is_some() {
                // What they have added comes last.
                let from_body_forces = &sample.sums[sample.sums.len() - 4..];
                found.iter_mut().zip(from_body_forces).for_each(|(found, from_body_forces)| *found -= from_body_forces);
            }
            // So is what walls, or boundaries that shear, have absorbed, where there are no body forces.
            let walls = 2 * model.particles().walls.len() + usize::from(model.particles().shear.is_some());
            for taken in sample.sums[sample.sums.len() - 3 * walls..].chunks_exact(3) {
                found.iter_mut().zip(taken).for_each(|(found, taken)| *found += taken);
            }
            if found != momentum {
                lost.push(format!("report of step {}: {found:?}, not {momentum:?}", sample.step));
            }
        }
    }
    lost
}

/// The plan of graphics cards, and that of the adapter.
fn plans() -> [Options; 2] {
    let graphics = Options { serial_memory: Some(false), traversal: Some(Traversal::Rows), ..Options::default() };
    [graphics, Options::default()]
}

fn nothing_is_lost(cases: &[Case], devices: &[(Contraction, Options)]) {
    nothing_is_lost_where(cases, devices, |_, _| true);
}

/// The same of some of the cases on a device, chosen by the numbers of the device and of the case.
fn nothing_is_lost_where(cases: &[Case], devices: &[(Contraction, Options)], chosen: fn(usize, usize) -> bool) {
    let mut lost = Vec::new();
    for (device, &(contraction, options)) in devices.iter().enumerate() {
        let gpu = Compiler::Contracting(contraction).gpu();
        for (_, case) in cases.iter().enumerate().filter(|(number, _)| chosen(device, *number)) {
            if let Some(loss) = losses(case, &gpu, options).first() {
                lost.push(format!("{contraction:?}, serial {:?}, {}: {loss}", options.serial_memory, case.name));
            }
        }
    }
    assert!(lost.is_empty(), "{} of what is exact was lost:\n{}", lost.len(), lost.join("\n"));
}

/// Either plan once.
fn few() -> [(Contraction, Options); 2] {
    let [graphics, own] = plans();
    [(Contraction::Block, graphics), (Contraction::Random(1), own)]
}

/// Every integrator on either device: with one of its fluids on one, and with the other on the other.
#[test]
fn fluids_keep_their_momentum() {
    nothing_is_lost_where(&fluids(), &few(), |device, case| (device + case + case / 2).is_multiple_of(2));
}

/// The chains with memory on either device, those of an integrator on one.
#[test]
fn chains_keep_their_momentum() {
    let cases: Vec<Case> = std::iter::once(chains()).chain(chains_beside_pairs()).collect();
    nothing_is_lost_where(&cases, &few(), |device, case| case == 0 || (device + case).is_multiple_of(2));
}

#[test]
fn cells_keep_momentum_mass_and_energy() {
    let forms: Vec<Case> = voronoi().into_iter().filter(|case| case.name.contains("energy=true")).collect();
    nothing_is_lost_where(&forms, &few(), |device, case| (device + case).is_multiple_of(2));
}

#[test]
fn meshes_keep_their_mass() {
    nothing_is_lost_where(&meshes(), &few(), |device, case| case == 0 || (device + case).is_multiple_of(2));
}

#[test]
#[ignore = "minutes: run by `make validate`"]
fn nothing_is_lost_however_a_compiler_contracts() {
    let cases: Vec<Case> =
        fluids().into_iter().chain([chains()]).chain(chains_beside_pairs()).chain(voronoi()).chain(meshes()).collect();
    let seeds = (1..=8).map(Contraction::Random);
    let contractions: Vec<_> =
        [Contraction::First, Contraction::Second, Contraction::Block].into_iter().chain(seeds).collect();
    let devices: Vec<_> = contractions.iter().flat_map(|known| plans().map(|plan| (*known, plan))).collect();
    nothing_is_lost(&cases, &devices);
}

/// The rewriting itself: without contraction every byte stays, with it some do not.
#[test]
fn a_plain_compiler_changes_nothing_and_a_contracting_one_does() {
    let state_of = |compiler: Option<Compiler>| {
        let gpu = compiler.map(Compiler::gpu);
        let gpu = gpu.as_ref().unwrap_or_else(|| crate::support::gpu());
        let case = &fluids()[3];
        let (_, state) = start(&case.scene);
        let plan = run::plan(&case.scene, Hardware::from(gpu), Options::default());
        let mut engine = Engine::new(gpu, plan, &state).unwrap();
        engine.advance(20, 20).unwrap();
        engine.state().unwrap()
    };
    let plain = state_of(None);
    assert!(plain == state_of(Some(Compiler::Plain)));
    let contracting = Compiler::Contracting(Contraction::First);
    assert!(!can_contract(&contracting.gpu()) || plain != state_of(Some(contracting)), "contraction changes nothing");
}
