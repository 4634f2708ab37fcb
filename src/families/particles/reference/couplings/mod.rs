//! All couplings and baths at once: pairs, coordinates, bonds, angles, tethers and coloured noise, each with the bath the
//! scene gives it, by the scheme (14)-(17) of Cotter and Reich, doi:10.1209/epl/i2003-00621-8, and its limit without
//! memory (18)-(21).
//!
//! ```text
//! p(n+½) = p(n) - dt/2 [∇V + Σ ∇h s(n)]                                               (14)
//! r(n+1) = r(n) + dt p(n+½) / m                                                       (15)
//! s(n+1) = e s(n) + λₑ(1+e)/2 [h(r(n+1)) - h(r(n))] + √(kTλₑ(1-e²)) ξ                 (16)
//! p(n+1) = p(n+½) - dt/2 [∇V + Σ ∇h s(n+1)]                                           (17)
//! ```
//! Without memory e = 0 and λₑ = 2γ/dt. The state keeps r(n) and p(n-½), so that (16), (17), (14) and (15) make a step, in
//! this order. Every coupling forms its half kick, -dt/2 (∇V + ∇h s), once; it is applied twice, closing and opening.
//! Impulses of couplings between particles are rounded once and handed to all ends, so that nothing depends on their order.
//!
//! At step 0 the momenta are those of the report point, and baths with memory are as they are in the state: nothing is
//! closed. Baths without memory take the initial momenta for those that brought the particles there.

mod angles;
pub(super) mod bonds;
mod coloured_noise;
pub(super) mod observables;
mod pair_list;
pub(super) mod pairs;
mod position_baths;
mod tethers;

use crate::families::Model;
use crate::families::Observables;
use crate::families::particles::reference::motion::Motion;
use crate::families::particles::reference::stress::{Virial, Virials};
use crate::families::particles::reference::{body_force, end_of_step, held};
use crate::families::reference::bath::BathSums;
use crate::families::reference::{Unstable, add, narrow, widen};
use crate::state::{Reported, State};

/// A model of couplings and baths and its state, stepped on the CPU: the reference of every scene whose model
/// [is coupled](crate::families::Particles::are_coupled).
///
/// With the integrator `groot-warren` baths without memory see velocities, as they do in
/// [`Reference`](super::Reference); with every other one they see the discrete gradient of `cotter-reich`. Baths with
/// memory are the same in both.
///
/// ```
/// use mesoscope::{families::Model, families::reference::CouplingsReference, scene};
///
/// let scene = scene::load("gle-oscillator", &["particles.0.count=20".to_owned()])?;
/// let model = Model::new(&scene);
/// assert!(model.particles().are_coupled && !model.conserves_momentum());
/// let start = mesoscope::families::initial_state(&scene, &model);
/// let mut reference = CouplingsReference::new(model, start.clone());
/// reference.run(10)?;
/// assert_ne!(reference.state().total_momentum(), start.total_momentum());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct CouplingsReference {
    model: Model,
    state: State,
    masses: Vec<f64>,
}

/// What a step finds at its report point.
struct Evaluation {
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

crate::families::reference::stepper!(CouplingsReference);

impl CouplingsReference {
    /// A reference run from a state whose species are indices into those of the model.
    #[must_use]
    pub fn new(model: Model, state: State) -> Self {
        let masses = state.species.iter().map(|&species| model.species[species as usize].mass).collect();
        Self { model, state, masses }
    }

    /// The state between steps: r(n) and p(n-½), as the GPU keeps it. Bath variables are those of the step before, s(n-1),
    /// but at step 0, where they are s(0).
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
        let Evaluation { momenta, opening, baths, .. } = self.evaluate()?;
        let account = body_force::account(&self.model, &self.state, &self.masses);
        end_of_step::end(&self.model, &self.masses, &mut self.state, momenta, &opening, 1)?;
        self.state.account = account;
        self.state.pair_baths = baths.pair_baths;
        self.state.anchors = baths.anchors;
        self.state.position_baths = baths.position_baths;
        self.state.bond_baths = baths.bond_baths;
        self.state.holds = baths.holds;
        Ok(())
    }

    /// Measures at the report point of the current step, without changing the state.
    ///
    /// # Errors
    /// [`Unstable::Bond`] for a bond that is too long.
    pub fn observe(&self) -> Result<Observables, Unstable> {
        Ok(observables::observe(self, &self.evaluate()?))
    }

    /// Positions and momenta at the report point of the current step, r(n) and p(n).
    ///
    /// # Errors
    /// [`Unstable`] when a momentum does not fit the integer state or a bond is too long.
    pub fn reported_state(&self) -> Result<Reported, Unstable> {
        let mut momenta = self.evaluate()?.momenta;
        held::hold(&self.model, &self.state, &mut momenta);
        let momenta = narrow(&momenta, self.state.step)?;
        Ok(Reported { momenta, ..self.state.clone().into() })
    }

    /// The share of each particle of the virials at the report point, for the stress.
    ///
    /// # Errors
    /// [`Unstable::Bond`] for a bond that is too long.
    pub fn virials(&self) -> Result<Vec<Virial>, Unstable> {
        Ok(self.evaluate()?.virials.each)
    }

    /// Everything at the report point of the current step.
    fn evaluate(&self) -> Result<Evaluation, Unstable> {
        let (model, state) = (&self.model, &self.state);
        let motion = Motion::of(model, state, &self.masses);
        let mut kick = vec![[0; 3]; state.len()];
        let mut bath_sums = BathSums::default();
        let mut baths = State::default();
        let mut virials = Virials::new(model, state);

        if let Some(force) = model.particles().pair_force.as_ref() {
            if force.remembers() {
                (baths.pair_baths, baths.anchors) = pair_list::renew(model, force, state);
            }
            let listed = &mut baths.pair_baths;
            pairs::kick((model, force), state, &motion, listed, &mut kick, &mut bath_sums, &mut virials);
        }
        if let Some(bonds) = model.particles().bonds.as_ref() {
            baths.bond_baths = bonds::kick(model, bonds, state, &motion, &mut kick, &mut bath_sums, &mut virials)?;
        }
        if let Some(angles) = model.particles().angles.as_ref() {
            angles::kick(model, angles, state, &mut kick, &mut virials);
        }
        if let Some(bath) = model.particles().position_bath.as_ref() {
            baths.position_baths = position_baths::kick(model, bath, state, &motion, &mut kick, &mut bath_sums);
        }
        if let Some(stiffness) = model.particles().tether {
            tethers::kick(model, stiffness, state, &mut kick);
        }
        body_force::kick(model, state, &mut kick);

        let mut momenta = widen(&state.momenta);
        let mut opening = kick.clone();
        if model.clock(state.step) > 0 {
            add(&mut momenta, &kick);
        }
        if let Some(noise) = model.particles().coloured_noise.as_ref() {
            let mut impulses = coloured_noise::advance(model, noise, state);
            held::exclude(model, state, &mut impulses.closing);
            held::exclude(model, state, &mut impulses.opening);
            add(&mut momenta, &impulses.closing);
            add(&mut opening, &impulses.opening);
            baths.holds = impulses.holds;
        }
        Ok(Evaluation { momenta, opening, baths, bath_sums, virials })
    }
}

/// Adds the half kicks of bonds, angles and tethers, without baths, and the virials of bonds and angles.
///
/// # Errors
/// [`Unstable::Bond`] for a bond that is too long.
pub(super) fn bonded_kicks(
    model: &Model,
    state: &State,
    masses: &[f64],
    kick: &mut [[i64; 3]],
    virials: &mut Virials,
) -> Result<(), Unstable> {
    if let Some(bonds) = model.particles().bonds.as_ref() {
        let motion = Motion::of(model, state, masses);
        bonds::kick(model, bonds, state, &motion, kick, &mut BathSums::default(), virials)?;
    }
    if let Some(angles) = model.particles().angles.as_ref() {
        angles::kick(model, angles, state, kick, virials);
    }
    if let Some(stiffness) = model.particles().tether {
        tethers::kick(model, stiffness, state, kick);
    }
    Ok(())
}

/// Adds an impulse to that of one particle, rounded half to even to whole units.
fn push(sum: &mut [i64; 3], impulse: [f64; 3], unit: f64) {
    for axis in 0..3 {
        sum[axis] +=
            (impulse[axis] / unit).round_ties_even().clamp(-super::pairs::MOST_UNITS, super::pairs::MOST_UNITS) as i64;
    }
}
