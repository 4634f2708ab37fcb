//! What the tests share: scenes in a line, an opened adapter, and the two implementations behind one face.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod bytes;

use std::sync::OnceLock;

use mesoscope::engine::Engine;
use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
use mesoscope::measure::Observables;
use mesoscope::model::Model;
use mesoscope::plan::{self, Hardware, Options, Traversal};
use mesoscope::reference::{CouplingsReference, Reference, ShallowWaterReference, VoronoiReference};
use mesoscope::scene::{self, Scene};
use mesoscope::self_test::{Function, errors_of_functions};
use mesoscope::state::State;

/// Which adapter the tests take: the one named by `MESOSCOPE_ADAPTER`, or the best.
pub fn adapter() -> AdapterChoice {
    AdapterChoice::parse(std::env::var("MESOSCOPE_ADAPTER").ok().as_deref())
}

/// What they ask of it. With `MESOSCOPE_PLAN=gpu` nothing is used that only some adapters have: plans are the ones for any GPU, on
/// software adapters too.
pub fn requirements() -> Requirements {
    let portable = match std::env::var("MESOSCOPE_PLAN").as_deref() {
        Err(_) => false,
        Ok("gpu") => true,
        Ok(other) => panic!("MESOSCOPE_PLAN is `{other}`: the one plan that can be asked for is `gpu`"),
    };
    Requirements { portable, ..Requirements::default() }
}

/// The adapter of the tests.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| Gpu::open(&adapter(), requirements()).expect("an adapter"))
}

/// Pairs of a particle in the standard fluid, or some more.
const PAIRS: i64 = 25;
/// Units in the last place by which the impulse of a pair may be off, and so units of momentum: it is at most 2²³ of them or so.
const PLACES: i64 = 4;

/// Units of momentum by which a step of the standard fluid may differ from the reference. Where weights are powers, the impulses of
/// pairs are as wrong as these are on the adapter.
pub fn units_of_a_step(powers: bool) -> i64 {
    static OF_POWERS: OnceLock<i64> = OnceLock::new();
    let of_powers = || {
        let errors = errors_of_functions(gpu()).expect("a kernel");
        let power = errors.iter().find(|error| error.function == Function::Power).expect("all functions");
        assert!(power.of_allowed <= 1.0, "{power:?}");
        power.last_places.ceil() as i64
    };
    PAIRS * (PLACES + if powers { *OF_POWERS.get_or_init(of_powers) } else { 0 })
}

/// What plans may use of it.
pub fn hardware() -> Hardware {
    Hardware::from(gpu())
}

/// Cells of a mesh in eights, on small meshes too, where the adapter has subgroups for it.
pub fn in_eights() -> Options {
    Options { traversal: hardware().takes_eights().then_some(Traversal::Clusters), ..Options::default() }
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

/// A small scene of shallow water with changes, given as `path=value`.
pub fn water(changes: &[&str]) -> Scene {
    let text = r#"{
        "title": "test", "space": {"box": [6.283185307179586, 6.283185307179586]},
        "time": {"step": 0.02, "steps": 1}, "temperature": 0.0,
        "particles": [{"species": "water", "count": 4096, "placement": {"type": "lattice"},
            "velocities": {"type": "geostrophic"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.283185307179586,
            "rotation": 6.283185307179586, "smoothing": {"length": 0.8},
            "surface": [{"type": "wave", "periods": [1, 2], "amplitude": 0.05}]}]
    }"#;
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", text, &changes) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// Water at rest on a mesh of 16² nodes with the parameters of Cotter and Reich, with other values merged in.
pub fn still_water(changes: &[&str]) -> Scene {
    let text = r#"{
        "title": "test", "space": {"box": [6.283185307179586, 6.283185307179586]}, "time": {"step": 0.01, "steps": 1},
        "temperature": 0, "output": {"energies": {"every": 1}},
        "particles": [{"species": "water", "count": 1024, "placement": {"type": "lattice"},
            "velocities": {"type": "rest"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.283185307179586,
            "rotation": 6.283185307179586, "smoothing": {"length": 1.5707963267948966}}]
    }"#;
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", text, &changes) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// The built-in shear flow, with other values merged in.
pub fn shear_flow(changes: &[&str]) -> Scene {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::load("shallow-water", &changes) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// Cells of unit mean volume and five molecules each, on a jittered lattice, with changes given as `path=value`.
pub fn cells(count: u32, changes: &[&str]) -> Scene {
    let edge = f64::from(count.max(1)).sqrt();
    let text = format!(
        r#"{{
        "title": "test", "space": {{"box": [{edge}, {edge}]}}, "time": {{"step": 0.02, "steps": 1}}, "temperature": 1.0,
        "particles": [{{"species": "A", "count": {count}, "mass": 5, "placement": {{"type": "lattice", "jitter": 0.25}}}}],
        "interactions": [{{"type": "voronoi"}}], "output": {{"energies": {{"every": 1}}}}
    }}"#
    );
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", &text, &changes) {
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
    let plan = plan::plan(&model, scene.time.equilibration, &scene.output, hardware(), options);
    Engine::new(gpu(), plan, state).expect("an engine")
}

/// A reference for a scene.
pub fn reference(scene: &Scene, state: &State) -> Reference {
    Reference::new(Model::new(scene), state.clone())
}

/// A reference for a scene of shallow water.
pub fn water_reference(scene: &Scene) -> ShallowWaterReference {
    let (model, state) = start(scene);
    ShallowWaterReference::new(model, state).expect("a scene of shallow water")
}

/// Independent oscillators: particles tied to where they start, with a bath on every coordinate.
pub fn oscillators(changes: &[&str]) -> Scene {
    let text = r#"{
        "title": "test", "space": {"box": [50, 50, 50]}, "time": {"step": 0.1, "steps": 1}, "temperature": 1.5,
        "particles": [{"species": "A", "count": 1000, "mass": 2}],
        "interactions": [{"type": "langevin", "bath": {"type": "memory", "rate": 1, "coupling": 20}},
            {"type": "tether", "stiffness": 10}],
        "output": {"energies": {"every": 1000000}}
    }"#;
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", text, &changes) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// A standard Gaussian number for each pair of counters, apart from all that a run draws.
pub fn deviate(seed: u64, counters: [u32; 2]) -> f64 {
    let key = mesoscope::noise::seed_key(seed, u32::MAX);
    mesoscope::noise::gaussian(mesoscope::noise::words(scene::Generator::Threefry2x32, key, counters))
}

/// That the predicted momenta of two implementations are the same, but for some whose shift, kept in few bits, lies just
/// between two of them.
pub fn predictions_agree(found: &State, expected: &State) {
    let shifts = |state: &State| -> Vec<[i64; 3]> {
        let pairs = state.predicted.iter().zip(&state.momenta);
        pairs
            .map(|(seen, momentum)| std::array::from_fn(|axis| i64::from(seen[axis]) - i64::from(momentum[axis])))
            .collect()
    };
    let (found, expected) = (shifts(found), shifts(expected));
    assert_eq!(found.len(), expected.len());
    for (particle, (a, b)) in found.iter().zip(&expected).enumerate() {
        let largest = b.iter().map(|units| units.abs()).max().unwrap();
        let difference = a.iter().zip(b).map(|(a, b)| (a - b).abs()).max().unwrap();
        assert!(difference <= largest / 15 + 100, "particle {particle}: shifts {a:?} and {b:?}");
    }
    let differing = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
    assert!(differing * 20 <= found.len(), "{differing} of {} shifts differ", found.len());
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

/// A run of either implementation, as far as the physics can see it.
pub trait Implementation {
    /// Its name in messages.
    fn name(&self) -> &'static str;
    /// Advances by a number of steps.
    fn step(&mut self, steps: u64);
    /// Advances by a number of steps, and says whether the run was stable.
    fn attempt(&mut self, steps: u64) -> bool;
    /// Observables of the current step; on the device only of steps that `output.energies.every` divides.
    fn observe(&mut self) -> Observables;
    /// The particles at the current step with full-step momenta.
    fn reported(&mut self) -> State;
    /// The state to continue from; only before the current step is observed or reported.
    fn state(&mut self) -> State;
    /// Observables after every `every` steps, `samples` times.
    fn series(&mut self, every: u64, samples: u64) -> Vec<Observables> {
        (0..samples)
            .map(|_| {
                self.step(every);
                self.observe()
            })
            .collect()
    }
}

/// Every reference has the same face.
macro_rules! reference {
    ($($reference:ty),*) => {
        $(impl Implementation for $reference {
            fn name(&self) -> &'static str {
                "reference"
            }

            fn step(&mut self, steps: u64) {
                self.run(steps).unwrap();
            }

            fn attempt(&mut self, steps: u64) -> bool {
                self.run(steps).is_ok()
            }

            fn observe(&mut self) -> Observables {
                <$reference>::observe(self).unwrap()
            }

            fn reported(&mut self) -> State {
                self.reported_state().unwrap()
            }

            fn state(&mut self) -> State {
                <$reference>::state(self).clone()
            }
        })*
    };
}

reference!(Reference, CouplingsReference, ShallowWaterReference, VoronoiReference);

/// An engine with what is needed to read its samples.
pub struct Device {
    engine: Engine<'static>,
    model: Model,
    /// The last row that was sampled.
    last: Option<Observables>,
}

impl Device {
    /// The first steps of a scene on the device.
    pub fn new(scene: &Scene) -> Self {
        Self::with(scene, Options::default())
    }

    /// The same with options.
    pub fn with(scene: &Scene, options: Options) -> Self {
        Self::from_state(scene, &start(scene).1, options)
    }

    /// A scene on the device from a state of its own.
    pub fn from_state(scene: &Scene, state: &State, options: Options) -> Self {
        Self { engine: engine(scene, state, options), model: Model::new(scene), last: None }
    }

    fn samples(&mut self) -> Vec<Observables> {
        let samples = self.engine.finish().expect("samples");
        let plan = self.engine.plan();
        let energies = samples.iter().filter(|sample| sample.sampler == 0);
        let rows: Vec<Observables> =
            energies.map(|sample| mesoscope::measure::observables_of(sample, plan, &self.model)).collect();
        self.last = rows.last().copied().or(self.last);
        rows
    }
}

/// Steps in one submission.
const BATCH: u64 = 50;

impl Implementation for Device {
    fn name(&self) -> &'static str {
        "device"
    }

    fn step(&mut self, steps: u64) {
        self.engine.advance(steps, BATCH).unwrap();
    }

    fn attempt(&mut self, steps: u64) -> bool {
        self.engine.advance(steps, BATCH).is_ok() && self.engine.state().is_ok()
    }

    fn observe(&mut self) -> Observables {
        let step = self.engine.step();
        self.samples();
        self.last.filter(|row| row.step == step).expect("a step that is sampled")
    }

    fn reported(&mut self) -> State {
        self.engine.reported().unwrap()
    }

    fn state(&mut self) -> State {
        self.engine.state().unwrap()
    }

    /// All at once, so that the device does not wait for the host.
    fn series(&mut self, every: u64, samples: u64) -> Vec<Observables> {
        let first = self.engine.step();
        self.step(every * samples);
        let mut found = self.samples();
        found.retain(|sample| sample.step > first && (sample.step - first).is_multiple_of(every));
        assert_eq!(found.len() as u64, samples, "every sampled step is a multiple of `output.energies.every`");
        found
    }
}

/// A mean and its standard error.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    pub mean: f64,
    pub error: f64,
}

impl Measured {
    /// The mean of a correlated series, with the error of the blocking method.
    pub fn of(series: &[f64]) -> Self {
        let estimate = mesoscope::measure::statistics::estimate(series).expect("a series");
        Self { mean: estimate.mean, error: estimate.standard_error.expect("more than one sample") }
    }

    /// The mean of independent numbers.
    pub fn of_independent(numbers: &[f64]) -> Self {
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        let variance = numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / (count - 1.0);
        Self { mean, error: (variance / count).sqrt() }
    }

    /// The ratio of two means; its error to first order is that of the mean of (a - ⟨a⟩b/⟨b⟩)/⟨b⟩.
    pub fn ratio(above: &[f64], below: &[f64]) -> Self {
        let mean_below = below.iter().sum::<f64>() / below.len() as f64;
        let ratio = above.iter().sum::<f64>() / below.iter().sum::<f64>();
        let deviations: Vec<f64> = above.iter().zip(below).map(|(a, b)| (a - ratio * b) / mean_below).collect();
        Self { mean: ratio, error: Self::of(&deviations).error }
    }

    /// The mean is `expected` within `allowance` and four standard errors, which are at most `largest_error` each, so
    /// that the comparison says something.
    #[track_caller]
    pub fn assert(self, what: &str, expected: f64, allowance: f64, largest_error: f64) {
        let Self { mean, error } = self;
        println!("{what}: {mean:.5} ± {error:.5}, expected {expected} ± {allowance}");
        assert!(error <= largest_error, "{what}: the standard error {error} is larger than {largest_error}");
        let tolerance = allowance + 4.0 * error;
        assert!((mean - expected).abs() <= tolerance, "{what}: {mean} ± {error}, expected {expected} ± {allowance}");
    }
}

/// Kinetic temperature, configurational temperature and pressure of conservative forces over a series.
pub fn equilibrium(series: &[Observables]) -> [Measured; 3] {
    let column = |value: fn(&Observables) -> f64| -> Vec<f64> { series.iter().map(value).collect() };
    [
        Measured::of(&column(Observables::kinetic_temperature)),
        Measured::ratio(&column(|row| row.gradient_squared), &column(|row| row.laplacian)),
        Measured::of(&column(Observables::conservative_pressure)),
    ]
}

/// Slope of a straight line through (log x, log y): the order of an error y in a step x.
pub fn order(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let logs = || points.iter().map(|(x, y)| (x.ln(), y.ln()));
    let [mean_x, mean_y] = [logs().map(|p| p.0).sum::<f64>() / count, logs().map(|p| p.1).sum::<f64>() / count];
    let covariance: f64 = logs().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / logs().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
}
