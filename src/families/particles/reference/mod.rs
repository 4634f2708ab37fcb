//! Pairs without memory, with bonds, angles and baths of particles where steps are split, and all couplings and baths,
//! in float64.

mod body_force;
mod couplings;
mod densities;
mod end_of_step;
mod held;
mod leapfrog;
mod motion;
mod observables;
pub(crate) mod pairs;
mod potential;
mod relaxation;
mod shear;
mod splitting;
mod stress;
mod walls;

pub use couplings::CouplingsReference;
pub use splitting::Relaxation;
pub use stress::Virial;

use crate::document::Integrator;
use crate::families::Model;
use crate::families::Observables;
use crate::families::reference::{Unstable, add, narrow};
use crate::state::{Reported, State};
use pairs::Pair;
use shear::Images;
use stress::Virials;

/// What an integrator finds at the report point of a step.
struct Report {
    /// p(n), in integer units.
    momenta: Vec<[i64; 3]>,
    /// The opening kick that follows.
    kick: Vec<[i64; 3]>,
    /// Those of all forces of the step between particles.
    virials: Virials,
}

/// A model of pairs and its state, stepped on the CPU. Bonds and angles are part of its split steps; of other steps with them
/// [`CouplingsReference`] is the reference.
///
/// ```
/// use mesoscope::{families::Model, families::reference::Reference, scene};
///
/// let small = ["space.box=[4,4,4]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let model = Model::new(&scene);
/// let start = mesoscope::families::initial_state(&scene, &model);
/// let mut reference = Reference::new(model, start.clone());
/// reference.run(20)?;
/// assert_eq!(reference.state().step, 20);
/// assert_eq!(reference.state().total_momentum(), start.total_momentum());
/// assert!(reference.observe()?.pressure() > 15.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Reference {
    model: Model,
    state: State,
    masses: Vec<f64>,
    relaxation: Relaxation,
}

crate::families::reference::stepper!(Reference);

impl Reference {
    /// A reference run from a state whose species are indices into those of the model.
    #[must_use]
    pub fn new(model: Model, state: State) -> Self {
        let two = model.particles().relaxes_in_two_stages(&model);
        Self::with_relaxation(model, state, if two { Relaxation::TwoStages } else { Relaxation::MeanField })
    }

    /// The same with another rule for the O step of the integrator `splitting`.
    #[must_use]
    pub fn with_relaxation(model: Model, state: State, relaxation: Relaxation) -> Self {
        let masses = state.species.iter().map(|&species| model.species[species as usize].mass).collect();
        Self { model, state, masses, relaxation }
    }

    /// The state between steps: r(n) and p(n-½), as the GPU keeps it.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// [`Unstable`] when a momentum or a drift does not fit the integer state or a bond is too long, and the state is then
    /// left as it was.
    pub fn step(&mut self) -> Result<(), Unstable> {
        let Report { momenta, kick, .. } = self.report(&self.pairs())?;
        let parts = self.parts_of_drift();
        let account = body_force::account(&self.model, &self.state, &self.masses);
        end_of_step::end(&self.model, &self.masses, &mut self.state, momenta, &kick, parts)?;
        self.state.account = account;
        Ok(())
    }

    /// Measures at the report point of the current step, without changing the state: the motion at r(n), p(n), and the
    /// configuration there too, but for a split step at [`Self::state_between_forces`].
    ///
    /// # Errors
    /// [`Unstable`] as [`Self::step`].
    pub fn observe(&self) -> Result<Observables, Unstable> {
        let report = self.report(&self.pairs())?;
        Ok(if self.model.particles().splits(&self.model) {
            observables::observe(self, &self.state_between_forces()?, 1, &report)
        } else {
            observables::observe(self, &self.state, 0, &report)
        })
    }

    /// Positions and momenta of the motion at the report point of the current step, r(n) and p(n): full-step momenta,
    /// for a split step those after the relaxation.
    ///
    /// # Errors
    /// [`Unstable`] when a momentum does not fit the integer state or a bond is too long.
    pub fn reported_state(&self) -> Result<Reported, Unstable> {
        let mut momenta = self.report(&self.pairs())?.momenta;
        held::hold(&self.model, &self.state, &mut momenta);
        let momenta = narrow(&momenta, self.state.step)?;
        Ok(Reported { momenta, ..self.state.clone().into() })
    }

    /// The share of each particle of the virials at the report point, for the stress.
    ///
    /// # Errors
    /// [`Unstable`] when a bond is too long.
    pub fn virials(&self) -> Result<Vec<Virial>, Unstable> {
        Ok(self.report(&self.pairs())?.virials.each)
    }

    /// The state half a drift after the report point of the current step: r(n) + dt/2 p(n+½)/m and p(n+½).
    ///
    /// There the symmetric step A(½) B(½) O B(½) A(½) of the integrator `splitting` begins and ends. Its positions are
    /// distributed more accurately there than where the forces are evaluated: for a harmonic oscillator under strong
    /// friction exactly, against 1 / (1 - K dt²/4m) times too wide.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn state_between_forces(&self) -> Result<State, Unstable> {
        let Report { mut momenta, kick, .. } = self.report(&self.pairs())?;
        add(&mut momenta, &kick);
        held::hold(&self.model, &self.state, &mut momenta);
        let momenta = narrow(&momenta, self.state.step)?;
        let mut state = State { predicted: Vec::new(), ..self.state.clone() };
        end_of_step::move_on(&self.model, &self.masses, &mut state, &momenta, 1, 2)?;
        Ok(state)
    }

    /// Counts of unordered pairs in `bins` equal bins of distance up to `range`, which is at most half the shortest
    /// box edge.
    ///
    /// ```
    /// # use mesoscope::{families::Model, families::reference::Reference, scene, state::State};
    /// # let scene = scene::load("dpd-fluid", &[])?;
    /// # let model = Model::new(&scene);
    /// // Three particles in a row, 0.6 and 1.8 apart.
    /// let positions = [0.0, 0.6, 2.4].map(|x| model.units.fraction([x, 0.0, 0.0])).to_vec();
    /// let state = State { positions, momenta: vec![[0; 3]; 3], species: vec![0; 3], ..State::default() };
    /// let reference = Reference::new(model, state);
    /// assert_eq!(reference.radial_distribution(3.0, 6), [0, 1, 0, 1, 1, 0]);
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn radial_distribution(&self, range: f64, bins: usize) -> Vec<u64> {
        observables::radial_distribution(self, range, bins)
    }

    fn pairs(&self) -> Vec<Pair> {
        let Some(force) = self.model.particles().pair_force.as_ref() else { return Vec::new() };
        pairs::find_pairs(&Images::of_step(&self.model, self.state.step), &self.state.positions, force.cutoff)
    }

    fn report(&self, found: &[Pair]) -> Result<Report, Unstable> {
        match self.model.integrator {
            Integrator::GrootWarren { .. } | Integrator::CotterReich {} => Ok(leapfrog::report(self, found)),
            Integrator::Splitting { .. } | Integrator::Gyro {} | Integrator::Rotate {} | Integrator::Euler {} => {
                splitting::report(self, found)
            }
        }
    }

    /// A split step drifts in two equal halves, between which a report may fall.
    fn parts_of_drift(&self) -> i64 {
        if self.model.particles().splits(&self.model) { 2 } else { 1 }
    }

    /// vᵢ - vⱼ of a pair, of j's image.
    fn relative_velocity(&self, momenta: &[[i64; 3]], pair: &Pair) -> [f64; 3] {
        let scale_i = self.model.units.momentum / self.masses[pair.first];
        let scale_j = self.model.units.momentum / self.masses[pair.second];
        let (momentum_i, mut momentum_j) = (momenta[pair.first], momenta[pair.second]);
        momentum_j[0] += shear::jump(&self.model, self.state.species[pair.second], pair.boxes_up);
        std::array::from_fn(|axis| momentum_i[axis] as f64 * scale_i - momentum_j[axis] as f64 * scale_j)
    }
}
