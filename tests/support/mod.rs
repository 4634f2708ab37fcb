//! What the tests share: scenes in a line, an opened adapter, and the two implementations behind one face.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::sync::OnceLock;

use mesoscope::engine::Engine;
use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
use mesoscope::measure::Observables;
use mesoscope::model::Model;
use mesoscope::plan::{self, Hardware, Options};
use mesoscope::reference::Reference;
use mesoscope::scene::{self, Scene};
use mesoscope::state::State;

/// The adapter of the tests: the one named by MESOSCOPE_ADAPTER, or the best.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        let name = std::env::var("MESOSCOPE_ADAPTER").ok();
        Gpu::open(&AdapterChoice::parse(name.as_deref()), Requirements::default()).expect("an adapter")
    })
}

/// A scene from its JSON text.
pub fn scene(text: &str) -> Scene {
    match scene::parse("test", text, &[]) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// The standard fluid of density 3 with other values merged in, given as `path=value`.
pub fn fluid(changes: &[&str]) -> Scene {
    let text = r#"{
        "title": "test", "space": {"box": [5, 5, 5]}, "time": {"step": 0.04, "steps": 1}, "temperature": 1.0,
        "particles": [{"species": "A", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}]
    }"#;
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", text, &changes) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// A scene's model and initial state.
pub fn start(scene: &Scene) -> (Model, State) {
    let model = Model::new(scene);
    let state = scene::placement::initial_state(scene, &model);
    (model, state)
}

/// An engine for a scene, with options.
pub fn engine(scene: &Scene, state: &State, options: Options) -> Engine<'static> {
    let model = Model::new(scene);
    let hardware = Hardware { subgroup_size: gpu().subgroup_size() };
    let plan = plan::plan(&model, scene.time.equilibration, &scene.output, hardware, options);
    Engine::new(gpu(), plan, state).expect("an engine")
}

/// A reference for a scene.
pub fn reference(scene: &Scene, state: &State) -> Reference {
    Reference::new(Model::new(scene), state.clone())
}

/// The largest difference of any momentum or position, in integer units.
pub fn largest_difference(a: &State, b: &State) -> (i64, i64) {
    assert_eq!(a.len(), b.len());
    let mut momentum = 0;
    let mut position = 0;
    for id in 0..a.len() {
        for axis in 0..3 {
            momentum = momentum.max((i64::from(a.momenta[id][axis]) - i64::from(b.momenta[id][axis])).abs());
            let shift = a.positions[id][axis].wrapping_sub(b.positions[id][axis]) as i32;
            position = position.max(i64::from(shift).abs());
        }
    }
    (momentum, position)
}

/// Observables of the last sample of an engine.
pub fn observables(engine: &mut Engine<'_>, scene: &Scene) -> Observables {
    let model = Model::new(scene);
    let samples = engine.finish().expect("samples");
    let last = samples.iter().rev().find(|sample| sample.sampler == 0).expect("a sample");
    mesoscope::measure::observables_of(last, engine.plan(), &model)
}

/// Splitting with relaxation of the pair velocities, the default.
pub const SPLITTING: &str = r#"integrator={"type":"splitting"}"#;
/// Groot and Warren's integrator with λ = ½, whose friction sees the momenta themselves.
pub const GROOT_WARREN: &str = r#"integrator={"type":"groot-warren"}"#;
/// The same with predicted momenta.
pub const PREDICTED: &str = r#"integrator={"type":"groot-warren","lambda":0.65}"#;
/// Cotter and Reich's limit scheme.
pub const COTTER_REICH: &str = r#"integrator={"type":"cotter-reich"}"#;
/// Every integrator, each variant that has kernels of its own.
pub const INTEGRATORS: &[&str] = &[SPLITTING, GROOT_WARREN, PREDICTED, COTTER_REICH];
