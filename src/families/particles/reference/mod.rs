//! Particles with everything that acts on them, in float64.
//!
//! Every term forms its half kick, -dt/2 (∇V + ∇h s), once; it is applied twice, closing and opening: the scheme
//! (14)-(17) of Cotter and Reich, doi:10.1209/epl/i2003-00621-8, and its limit without memory (18)-(21).
//!
//! ```text
//! p(n+½) = p(n) - dt/2 [∇V + Σ ∇h s(n)]                                               (14)
//! r(n+1) = r(n) + dt p(n+½) / m                                                       (15)
//! s(n+1) = e s(n) + λₑ(1+e)/2 [h(r(n+1)) - h(r(n))] + √(kTλₑ(1-e²)) ξ                 (16)
//! p(n+1) = p(n+½) - dt/2 [∇V + Σ ∇h s(n+1)]                                           (17)
//! ```
//! Without memory e = 0 and λₑ = 2γ/dt. The state keeps r(n) and p(n-½), so that (16), (17), (14) and (15) make a step,
//! in this order. In a split step baths without memory relax momenta at p(n) instead: see `splitting.rs`. Impulses
//! between particles are rounded once and handed to all ends, so that nothing depends on their order.
//!
//! At step 0 the momenta are those of the report point, and baths with memory are as they are in the state: nothing is
//! closed. Baths without memory take the initial momenta for those that brought the particles there.

mod configuration;
pub(crate) mod end_of_step;
pub(crate) mod held;
mod motion;
mod observables;
pub(crate) mod pairs;
mod potential;
mod splitting;
mod stress;

pub(crate) use super::space::shear::reference::Images;
pub(crate) use configuration::Configuration;
pub(crate) use pairs::{Forces, Pair, close_pairs, dot, exchange, find_pairs, noise as noise_of_pair};
pub(crate) use potential::Potential;
pub use splitting::Relaxation;
pub use stress::Virial;
pub(crate) use stress::{AXES, Virials};

use super::space::shear::reference as shear;
use super::terms::body_forces;
use crate::families::reference::bath::BathSums;
use crate::families::reference::{Unstable, add, narrow, widen};
use crate::families::{Model, Observables};
use crate::state::{Reported, State};
use motion::Motion;
use pairs::MOST_UNITS;

/// The report point of a step: what terms find there.
pub(crate) struct Moment<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    pub motion: Motion,
    pub images: Images<'a>,
    /// The pairs within the cutoff, where no list has them.
    pub found: Vec<Pair>,
}

/// The half kicks of a step, as terms add them, and the baths after it.
pub(crate) struct Kicks {
    /// Impulses that end the step before and begin the next alike.
    pub both: Vec<[i64; 3]>,
    /// Impulses that end the step before.
    pub closing: Vec<[i64; 3]>,
    /// Impulses that begin the next.
    pub opening: Vec<[i64; 3]>,
    /// The baths at the report point; positions and momenta are left empty.
    pub baths: State,
    pub bath_sums: BathSums,
    pub virials: Virials,
    /// The reason why there is no next step.
    pub failure: Option<Unstable>,
}

impl Kicks {
    fn new(model: &Model, state: &State) -> Self {
        let none = || vec![[0; 3]; state.len()];
        Self {
            both: none(),
            closing: none(),
            opening: none(),
            baths: State::default(),
            bath_sums: BathSums::default(),
            virials: Virials::new(model, state),
            failure: None,
        }
    }

    /// Adds an impulse to that of one particle, rounded half to even to whole units.
    pub(crate) fn push(&mut self, model: &Model, particle: usize, impulse: [f64; 3]) {
        round(&mut self.both[particle], impulse, model.units.momentum);
    }

    /// Adds the impulses and virials of forces that push a pair apart.
    pub(crate) fn push_apart(&mut self, model: &Model, pair: &Pair, conservative: f64, frictional: f64) {
        let force = conservative + frictional;
        let impulse = pair.direction().map(|component| 0.5 * model.time_step * force * component);
        exchange(&mut self.both, pair, impulse, model.units.momentum);
        self.virials.add(pair, conservative, frictional);
    }
}

/// Adds an impulse in units of momentum, rounded half to even to whole ones.
pub(crate) fn round(sum: &mut [i64; 3], impulse: [f64; 3], unit: f64) {
    for axis in 0..3 {
        sum[axis] += (impulse[axis] / unit).round_ties_even().clamp(-MOST_UNITS, MOST_UNITS) as i64;
    }
}

/// What a step finds at its report point.
struct Report {
    /// p(n), in integer units.
    momenta: Vec<[i64; 3]>,
    /// The opening kick that follows.
    opening: Vec<[i64; 3]>,
    /// What the baths are at n, with a list renewed if it had to be; positions and momenta are left empty.
    baths: State,
    /// Of the baths with memory.
    bath_sums: BathSums,
    /// Those of all forces of the step between particles.
    virials: Virials,
}

/// A model of particles and its state, stepped on the CPU.
///
/// With the integrator `groot-warren` baths without memory see velocities; with `cotter-reich` they see the discrete
/// gradient over the last drift; with `splitting` they relax momenta by themselves. Baths with memory are the same in
/// all.
///
/// ```
/// use mesoscope::{families::reference::Reference, scene};
///
/// let small = ["space.box=[4,4,4]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let model = scene.model().clone();
/// let start = mesoscope::families::initial_state(&scene);
/// let mut reference = Reference::new(model, start.clone());
/// reference.run(20)?;
/// assert_eq!(reference.state().step, 20);
/// assert_eq!(reference.state().total_momentum(), start.total_momentum());
/// assert!(reference.observe()?.pressure() > 15.0);
///
/// // Oscillators in baths with memory, which exchange momentum with what is outside.
/// let scene = scene::load("gle-oscillator", &["particles.0.count=20".to_owned()])?;
/// let model = scene.model().clone();
/// assert!(model.has_memory() && !model.conserves_momentum());
/// let start = mesoscope::families::initial_state(&scene);
/// let mut reference = Reference::new(model, start.clone());
/// reference.run(10)?;
/// assert_ne!(reference.state().total_momentum(), start.total_momentum());
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
        let two = model.particles().relaxes_in_two_stages();
        Self::with_relaxation(model, state, if two { Relaxation::TwoStages } else { Relaxation::MeanField })
    }

    /// The same with another rule for the O step of the integrator `splitting`.
    #[must_use]
    pub fn with_relaxation(model: Model, state: State, relaxation: Relaxation) -> Self {
        let masses = state.species.iter().map(|&species| model.species[species as usize].mass).collect();
        Self { model, state, masses, relaxation }
    }

    /// The state between steps: r(n) and p(n-½), as the GPU keeps it. Bath variables are those of the step before,
    /// s(n-1), but at step 0, where they are s(0).
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
        let Report { momenta, opening, baths, .. } = self.report()?;
        let parts = if self.splits() { 2 } else { 1 };
        let account = body_forces::reference::account(&self.model, &self.state, &self.masses);
        end_of_step::end(&self.model, &self.masses, &mut self.state, momenta, &opening, parts)?;
        self.state.account = account;
        self.state.pair_baths = baths.pair_baths;
        self.state.anchors = baths.anchors;
        self.state.position_baths = baths.position_baths;
        self.state.bond_baths = baths.bond_baths;
        self.state.holds = baths.holds;
        Ok(())
    }

    /// Measures at the report point of the current step, without changing the state: the motion at r(n), p(n), and the
    /// configuration there too, but for a split step at [`Self::state_between_forces`].
    ///
    /// # Errors
    /// [`Unstable`] as [`Self::step`].
    pub fn observe(&self) -> Result<Observables, Unstable> {
        let report = self.report()?;
        Ok(if self.splits() {
            observables::observe(self, &self.state_between(&report)?, 1, &report)
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
        let mut momenta = self.report()?.momenta;
        held::hold(&self.model, &self.state, &mut momenta);
        let momenta = narrow(&momenta, self.state.step)?;
        Ok(Reported { momenta, ..self.state.clone().into() })
    }

    /// The share of each particle of the virials at the report point, for the stress.
    ///
    /// # Errors
    /// [`Unstable::Bond`] for a bond that is too long.
    pub fn virials(&self) -> Result<Vec<Virial>, Unstable> {
        Ok(self.report()?.virials.each)
    }

    /// The virials of the waves of charges at the report point, for the stress: xx, yy, zz, xy, xz, yz.
    ///
    /// # Errors
    /// [`Unstable::Bond`] for a bond that is too long.
    pub fn virials_of_waves(&self) -> Result<[f64; 6], Unstable> {
        Ok(self.report()?.virials.of_waves)
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
        self.state_between(&self.report()?)
    }

    fn state_between(&self, report: &Report) -> Result<State, Unstable> {
        let mut momenta = report.momenta.clone();
        add(&mut momenta, &report.opening);
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
    /// # use mesoscope::{families::reference::Reference, scene, state::State};
    /// # let scene = scene::load("dpd-fluid", &[])?;
    /// # let model = scene.model().clone();
    /// // Three particles in a row, 0.6 and 1.8 apart.
    /// let positions = [0.0, 0.6, 2.4].map(|x| model.units.fraction([x, 0.0, 0.0])).to_vec();
    /// let state = State { positions, momenta: vec![[0; 3]; 3], species: vec![0; 3], ..State::default() };
    /// let reference = Reference::new(model, state);
    /// assert_eq!(reference.radial_distribution(3.0, 6), [0, 1, 0, 1, 1, 0]);
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn radial_distribution(&self, range: f64, bins: usize) -> Vec<u64> {
        observables::radial_distribution(self, range, bins, None)
    }

    /// The same of pairs of two species, or within one, by their numbers.
    #[must_use]
    pub fn partial_radial_distribution(&self, range: f64, bins: usize, species: [usize; 2]) -> Vec<u64> {
        observables::radial_distribution(self, range, bins, Some(species))
    }

    /// Amplitude of the density of a species, by its number, or of all particles that are not frozen: Σ cos q·r and Σ sin q·r, for a wave
    /// vector of so many waves along each axis of the box.
    #[must_use]
    pub fn density_wave(&self, waves: [i32; 3], species: Option<usize>) -> [f64; 2] {
        observables::density_wave(self, waves, species)
    }

    /// Whether steps are split: they drift in two equal halves, between which a report may fall.
    fn splits(&self) -> bool {
        self.model.particles().splits()
    }

    /// Everything at the report point of the current step.
    fn report(&self) -> Result<Report, Unstable> {
        let (model, state) = (&self.model, &self.state);
        let particles = model.particles();
        let images = Images::of_step(model, state.step);
        // Pairs with memory are listed.
        let force = particles.pair_force.as_ref().filter(|force| !force.remembers());
        let found = force.map_or_else(Vec::new, |force| find_pairs(&images, &state.positions, force.cutoff));
        let moment = Moment { model, state, motion: Motion::of(model, state, &self.masses), images, found };
        let mut kicks = Kicks::new(model, state);
        for term in particles.terms() {
            term.kick(&moment, &mut kicks);
        }
        let Kicks { both, closing, mut opening, baths, bath_sums, mut virials, failure } = kicks;
        failure.map_or(Ok(()), Err)?;
        let mut momenta = widen(&state.momenta);
        let closes = model.clock(state.step) > 0;
        if closes {
            add(&mut momenta, &both);
        }
        add(&mut momenta, &closing);
        add(&mut opening, &both);
        if closes && self.splits() {
            splitting::relax(self, &moment.found, &mut momenta, &mut virials);
        }
        Ok(Report { momenta, opening, baths, bath_sums, virials })
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
