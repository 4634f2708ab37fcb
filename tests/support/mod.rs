//! What the tests share: scenes in a line, an opened adapter, the two implementations behind one face, and the program.
//!
//! Every kind of test uses a part of it.
#![allow(dead_code, unused_imports)]

pub mod bytes;
pub mod compiler;
pub mod gsd;
pub mod mistakes;
pub mod plotter;
pub mod program;

mod comparison;
mod implementations;
mod scenes;
mod statistics;

use std::sync::{Mutex, OnceLock, PoisonError};

use mesoscope::engine::Engine;
use mesoscope::families::Model;
use mesoscope::families::reference::{Reference, ShallowWaterReference};
use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
use mesoscope::measure::Observables;
use mesoscope::plan::{Hardware, Options, Traversal};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use mesoscope::state::State;

pub use comparison::{
    SideBySide, largest_difference, predictions_agree, same_energies, same_observables, step_in_words, totals,
    units_of_a_step,
};
pub use implementations::{Device, Implementation, before_and_after, reference_of_particles};
pub use scenes::{
    COTTER_REICH, ENERGY, EVERY_STEP, GROOT_WARREN, GYRO, INTEGRATORS, MIXTURE, MIXTURE_FORCE, PREDICTED, ROTATE,
    SPLITTING, STAGED, WHITE, built_in, cells, changed, edited, fluid, oscillators, scene, shear_flow, still_water,
    water,
};
pub use statistics::{Measured, deviate, equilibrium, order};

/// Which adapter the tests take: the one named by `MESOSCOPE_ADAPTER`, or the best.
pub fn adapter() -> AdapterChoice {
    AdapterChoice::parse(std::env::var("MESOSCOPE_ADAPTER").ok().as_deref())
}

/// What they ask of it: as many storage buffers as the most demanding of plans binds, where the adapter has them.
pub fn requirements() -> Requirements {
    static MET: OnceLock<Requirements> = OnceLock::new();
    *MET.get_or_init(|| {
        let mut counts =
            (9..=12).rev().map(|storage_buffers| Requirements { storage_buffers, ..Requirements::default() });
        counts.find(|requirements| Gpu::open(&adapter(), *requirements).is_ok()).unwrap_or_default()
    })
}

/// A device that one test has at a time: software drivers compile the kernels of a device one after the other.
struct Lent(&'static Gpu);

/// Devices that no test has.
static FREE: Mutex<Vec<&'static Gpu>> = Mutex::new(Vec::new());

impl Drop for Lent {
    fn drop(&mut self) {
        FREE.lock().unwrap_or_else(PoisonError::into_inner).push(self.0);
    }
}

/// The adapter of the tests.
pub fn gpu() -> &'static Gpu {
    thread_local! {
        static LENT: Lent = {
            let free = FREE.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let open = || &*Box::leak(Box::new(Gpu::open(&adapter(), requirements()).expect("an adapter")));
            Lent(free.unwrap_or_else(open))
        };
    }
    LENT.with(|lent| lent.0)
}

/// What plans may use of it.
pub fn hardware() -> Hardware {
    Hardware::from(gpu())
}

/// Cells of a mesh in eights, on small meshes too, where the adapter has subgroups for it.
pub fn in_eights() -> Options {
    Options { traversal: hardware().takes_eights().then_some(Traversal::Clusters), ..Options::default() }
}

/// Every way to visit pairs that the adapter has.
pub fn traversals() -> Vec<Traversal> {
    let clusters = hardware().takes_eights().then_some(Traversal::Clusters);
    [Traversal::Rows, Traversal::Queue].into_iter().chain(clusters).collect()
}

/// A scene's model and initial state.
pub fn start(scene: &Checked) -> (Model, State) {
    (scene.model().clone(), mesoscope::families::initial_state(scene))
}

/// An engine for a scene, with options.
pub fn engine(scene: &Checked, state: &State, options: Options) -> Engine<'static> {
    let plan = run::plan(scene, hardware(), options);
    Engine::new(gpu(), plan, state).expect("an engine")
}

/// A reference for a scene.
pub fn reference(scene: &Checked, state: &State) -> Reference {
    Reference::new(scene.model().clone(), state.clone())
}

/// A reference for a scene of shallow water.
pub fn water_reference(scene: &Checked) -> ShallowWaterReference {
    let (model, state) = start(scene);
    ShallowWaterReference::new(model, state).expect("a scene of shallow water")
}

/// Observables of all samples of an engine that were not taken from it before.
pub fn series(engine: &mut Engine<'_>, scene: &Checked) -> Vec<Observables> {
    let model = scene.model();
    let samples = engine.finish().expect("samples");
    let rows = samples.iter().filter(|sample| sample.sampler == 0);
    rows.map(|row| mesoscope::measure::observables_of(row, engine.plan(), model)).collect()
}

/// Observables of the last sample of an engine.
pub fn observables(engine: &mut Engine<'_>, scene: &Checked) -> Observables {
    series(engine, scene).pop().expect("a sample")
}
