//! The two implementations behind one face: the float64 reference and the device.

use mesoscope::engine::Engine;
use mesoscope::families::Model;
use mesoscope::families::reference::{Reference, ShallowWaterReference, VoronoiReference};
use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::state::{Reported, State};

use super::{engine, start};

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
    fn reported(&mut self) -> Reported;
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

            fn reported(&mut self) -> Reported {
                self.reported_state().unwrap()
            }

            fn state(&mut self) -> State {
                <$reference>::state(self).clone()
            }
        })*
    };
}

reference!(Reference, ShallowWaterReference, VoronoiReference);

/// The reference of particles.
pub fn reference_of_particles(model: Model, state: State) -> Box<dyn Implementation> {
    Box::new(Reference::new(model, state))
}

/// What the device and the reference observe of a scene of particles at the start and after some steps, by their names.
pub fn before_and_after(scene: &Checked, steps: u64) -> Vec<(&'static str, [Observables; 2])> {
    let (model, state) = start(scene);
    let implementations: [Box<dyn Implementation>; 2] =
        [Box::new(Device::new(scene)), reference_of_particles(model, state)];
    let observed = implementations.into_iter().map(|mut implementation| {
        let first = implementation.observe();
        implementation.step(steps);
        (implementation.name(), [first, implementation.observe()])
    });
    observed.collect()
}

/// An engine with what is needed to read its samples.
pub struct Device {
    engine: Engine<'static>,
    model: Model,
    /// The last row that was sampled.
    last: Option<Observables>,
}

impl Device {
    /// The first steps of a scene on the device.
    pub fn new(scene: &Checked) -> Self {
        Self::with(scene, Options::default())
    }

    /// The same with options.
    pub fn with(scene: &Checked, options: Options) -> Self {
        Self::from_state(scene, &start(scene).1, options)
    }

    /// A scene on the device from a state of its own.
    pub fn from_state(scene: &Checked, state: &State, options: Options) -> Self {
        Self { engine: engine(scene, state, options), model: scene.model().clone(), last: None }
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

    fn reported(&mut self) -> Reported {
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
