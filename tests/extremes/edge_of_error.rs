//! Built-in functions that err as much as WGSL lets them: a run is right, or ends with an error. It never goes wrong in silence.

use mesoscope::engine::Engine;
use mesoscope::gpu::Gpu;
use mesoscope::measure::observables_of;
use mesoscope::plan::{Hardware, Options};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use mesoscope::self_test::{self, Verdict};
use mesoscope::state::State;

use crate::support::compiler::{Compiler, Deviation, Functions};
use crate::support::{
    COTTER_REICH, GROOT_WARREN, MIXTURE, SPLITTING, cells, fluid, largest_difference, oscillators, start,
    units_of_a_step,
};

const GAUSSIAN: &str = r#"noise={"distribution":"gaussian"}"#;
/// Particles at random places are at equilibrium where nothing repels them.
const FREE: &str = "interactions.0.repulsion=0";
const REPORTS: &str = "output.energies.every=20";
const DEVIATIONS: [Deviation; 3] = [Deviation::Up, Deviation::Down, Deviation::Either];

/// A scene at rest in its bath from the start, its steps, its temperature, and how far a mean over the second half of its
/// reports may be off: five standard deviations and what the time step makes.
struct Case {
    name: &'static str,
    scene: Checked,
    steps: u64,
    temperature: f64,
    tolerance: f64,
}

fn cases() -> Vec<Case> {
    let gas = r#"{
        "title": "test", "space": {"box": [40, 40]}, "time": {"step": 0.05, "steps": 1}, "temperature": 1.0,
        "particles": [{"species": "A", "count": 4000}],
        "interactions": [{"type": "langevin", "friction": 4}], "output": {"energies": {"every": 20}}
    }"#;
    let polymers = r#"{
        "title": "test", "space": {"box": [9, 9, 9]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1.0,
        "particles": [{"species": "A", "count": 2000, "chain": {"beads": 5, "spacing": 0.7}}],
        "interactions": [{"type": "bonds", "potential": {"type": "fene", "stiffness": 30, "extent": 1.5}, "friction": 9},
            {"type": "langevin", "friction": 4}],
        "output": {"energies": {"every": 20}}
    }"#;
    let case = |name, scene, steps, temperature, tolerance| Case { name, scene, steps, temperature, tolerance };
    vec![
        case("oscillators", oscillators(&[REPORTS]), 2000, 1.5, 0.08),
        case("langevin gas", scene::parse("test", gas, &[]).unwrap(), 400, 1.0, 0.06),
        case("polymers", scene::parse("test", polymers, &[]).unwrap(), 400, 1.0, 0.1),
        case("groot-warren", fluid(&[GROOT_WARREN, GAUSSIAN, FREE, REPORTS]), 1200, 1.0, 0.06),
        case("splitting", fluid(&[SPLITTING, GAUSSIAN, FREE, REPORTS]), 400, 1.0, 0.06),
        case(
            "memory",
            fluid(&[
                COTTER_REICH,
                r#"interactions.0.bath={"type":"memory","rate":5}"#,
                "time.step=0.01",
                FREE,
                REPORTS,
            ]),
            400,
            1.0,
            0.08,
        ),
        case("cells", cells(400, &[REPORTS]), 400, 1.0, 0.2),
    ]
}

fn engine<'a>(gpu: &'a Gpu, scene: &Checked, state: &State) -> Engine<'a> {
    let plan = run::plan(scene, Hardware::from(gpu), Options::default());
    Engine::new(gpu, plan, state).unwrap()
}

/// The mean temperature over the second half.
fn temperature(gpu: &Gpu, case: &Case) -> f64 {
    let (model, state) = start(&case.scene);
    let mut engine = engine(gpu, &case.scene, &state);
    let ended = engine.advance(case.steps, 50).and_then(|()| engine.finish());
    let samples = ended.unwrap_or_else(|error| panic!("{}: {error}", case.name));
    let rows: Vec<f64> = samples
        .iter()
        .filter(|sample| sample.sampler == 0 && sample.step > case.steps / 2)
        .map(|sample| observables_of(sample, engine.plan(), &model).kinetic_temperature())
        .collect();
    rows.iter().sum::<f64>() / rows.len() as f64
}

/// Runs every case: none ends with an error, and each has the temperature that it should have.
fn temperatures_are_right(which: Functions, deviations: &[Deviation]) {
    for &deviation in deviations {
        let gpu = Compiler::Erring(which, deviation).gpu();
        for case in cases() {
            let found = temperature(&gpu, &case);
            println!("{which:?} {deviation:?}, {}: temperature {found}", case.name);
            let off = (found / case.temperature - 1.0).abs();
            // Also where it is not a number.
            assert!(off < case.tolerance, "{which:?} {deviation:?}, {}: temperature {found}", case.name);
        }
    }
}

#[test]
fn logarithms_at_the_edge_of_their_error() {
    temperatures_are_right(Functions::Logarithms, &[Deviation::Up]);
}

#[test]
fn all_functions_at_the_edge_of_their_error() {
    temperatures_are_right(Functions::All, &[Deviation::Up]);
}

#[test]
#[ignore = "minutes: run by `make validate`"]
fn every_function_at_the_edge_of_its_error() {
    for which in [
        Functions::Logarithms,
        Functions::Trigonometric,
        Functions::Exponentials,
        Functions::Roots,
        Functions::Quotients,
        Functions::All,
    ] {
        temperatures_are_right(which, &DEVIATIONS);
    }
}

/// What the comparisons with the reference allow holds whatever the driver makes of functions.
#[test]
fn steps_are_those_of_the_reference_at_the_edge_of_error() {
    const POWERS: &str = "interactions.0.weight_exponent=1";
    for deviation in [Deviation::Up, Deviation::Either] {
        let gpu = Compiler::Erring(Functions::All, deviation).gpu();
        for changes in [
            &[SPLITTING][..],
            &[SPLITTING, MIXTURE, GAUSSIAN],
            &[GROOT_WARREN, GAUSSIAN],
            &[COTTER_REICH, MIXTURE],
            &[GROOT_WARREN, POWERS],
        ] {
            let scene = fluid(changes);
            let (_, state) = start(&scene);
            let mut device = engine(&gpu, &scene, &state);
            let mut reference = crate::support::reference(&scene, &state);
            for step in 1..=2 {
                device.advance(1, 1).unwrap();
                reference.step().unwrap();
                let found = device.state().unwrap();
                let (momentum, _) = largest_difference(&found, reference.state());
                println!("{deviation:?} {changes:?}, step {step}: {momentum} units");
                let allowed = units_of_a_step(changes.contains(&POWERS));
                assert!(momentum <= allowed * step, "{deviation:?} {changes:?}: {momentum} units after step {step}");
                assert_eq!(found.total_momentum(), state.total_momentum(), "{deviation:?} {changes:?}");
            }
        }
    }
}

/// The tolerance of the self-test is what such functions make, and more.
#[test]
#[ignore = "minutes"]
fn the_self_test_passes_at_every_edge_of_error() {
    for deviation in DEVIATIONS {
        let gpu = Compiler::Erring(Functions::All, deviation).gpu();
        let mut failed = Vec::new();
        self_test::run(&gpu, &mut |finding| {
            println!("{deviation:?} {}: {}", finding.check, finding.found);
            if finding.verdict == Verdict::Failed {
                failed.push(finding);
            }
        })
        .unwrap();
        assert!(failed.is_empty(), "{deviation:?}: {failed:?}");
    }
}
