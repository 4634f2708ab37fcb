//! Rotating shallow water by the Hamiltonian particle-mesh method, with heat baths on the mesh: Cotter and Reich,
//! doi:10.1209/epl/i2003-00621-8, equations (24)-(26).
//!
//! Particles of fixed masses mᵢ carry the water. Their masses, spread over the nodes by B-splines ψ, are the depth,
//! and its smoothing by A = (1 - Λ²∇²)^-power drives them:
//!
//! ```text
//! h̃ₖₗ = Σ mᵢ ψₖₗ(Xᵢ),   h = A(h̃ - 1) + 1
//! dXᵢ = Vᵢ dt                                                      (24)
//! dVᵢ = f₀ (V_y, -V_x) dt - c₀² Σ (h + s)ₖₗ ∇ψₖₗ(Xᵢ) dt            (25)
//! dsₖₗ = -α sₖₗ dt + λ dh̃ₖₗ + √(2kTλα)/c₀ dWₖₗ                     (26)
//! ```
//! with λ = εΛ². Without the bath the energy is E = Σ ½ m V² + ½c₀² Σ (h̃ - 1)(h - 1), with it and without friction
//! and noise E + c₀²/(2λ) Σ s². The sign of the rotation is the usual one; the paper prints the other. Depth is
//! measured in mass a node.
//!
//! The bath is not Galilean invariant: what drives it is the change of the depth at a node, so that even a uniform flow,
//! which carries the granularity of its particles past the nodes, is slowed down.
//!
//! One step is, as (14)-(17) do for pairs,
//!
//! ```text
//! h̃(n), h(n) from X(n)
//! s(n) = e s(n-1) + λₑ (1+e)/2 [h̃(n) - h̃(n-1)] + √(kTλₑ(1-e²))/c₀ ξ     (16), (20) without memory
//! gyro:   V += K(n)   report point   V += K(n),  (X, V) = G(dt) (X, V)
//! rotate: V = R(½) (V + K(n))   report point   V = R(½) V + K(n),  X += dt V
//! ```
//! where K(n) is half a kick, and G the exact flow of a particle that only the rotation R bends. At step 0 the
//! velocities and bath variables given are those of the report point, and nothing is closed.

mod depth;
mod motion;
pub(crate) mod splines;

pub(crate) use depth::{Smoothing, mesh_splines};

use crate::families::Observables;
use crate::families::reference::{Unstable, bath, drift};
use crate::families::{Model, ShallowWater};
use crate::noise::{self, stream};
use crate::state::{Reported, State};
use depth::spread;
use motion::{Motion, half_kick};

/// What rounding may take from a depth of nothing.
const ROUNDING: f64 = 1e-9;
/// The largest velocity in units.
const MOST_VELOCITY: i64 = 1 << 30;

/// What is found at the report point of a step.
struct Report {
    /// h̃(n).
    masses: Vec<f64>,
    /// h(n) - 1.
    deviation: Vec<f64>,
    /// s(n).
    bath: Vec<f64>,
    /// V(n), in integer units.
    velocities: Vec<[i64; 2]>,
    /// The opening kick that follows.
    kicks: Vec<[i64; 2]>,
}

/// A model of shallow water and its state, stepped on the CPU.
///
/// Bath variables and masses of nodes are kept in float64; in the state they are rounded to what it can hold.
///
/// ```
/// use mesoscope::{families::reference::ShallowWaterReference, scene};
///
/// let small = ["interactions.0.mesh=[16,16]", "interactions.0.smoothing.length=0.8", "particles.0.count=1024"];
/// let scene = scene::load("shallow-water", &small.map(str::to_owned))?;
/// let model = scene.model().clone();
/// let start = mesoscope::families::initial_state(&scene);
/// let mut reference = ShallowWaterReference::new(model, start).ok_or("no shallow water")?;
/// let energy = reference.observe()?.total_energy();
/// reference.run(5)?;
/// assert!((reference.observe()?.total_energy() / energy - 1.0).abs() < 1e-4);
/// // The mean depth is one.
/// assert!((reference.depth().iter().sum::<f64>() - 256.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct ShallowWaterReference {
    model: Model,
    water: ShallowWater,
    state: State,
    smoothing: Smoothing,
    motion: Motion,
    /// h̃(n-1); empty at step 0.
    previous: Vec<f64>,
    /// s(n-1), but s(0) at step 0; empty without a bath.
    bath: Vec<f64>,
}

crate::families::reference::stepper!(ShallowWaterReference);

impl ShallowWaterReference {
    /// A reference run from a state; none for a model without shallow water, or a state without what the model needs:
    /// masses of the particles, and of a bath its variables and, beyond step 0, the masses of the nodes.
    #[must_use]
    pub fn new(model: Model, state: State) -> Option<Self> {
        let water = model.shallow_water().cloned()?;
        let nodes = water.nodes() as usize;
        let remembered = state.step == 0 || state.node_masses.len() == nodes;
        let fits = water.bath.is_none() || (state.node_bath.len() == nodes && remembered);
        if state.masses.len() != state.len() || !fits {
            return None;
        }
        let previous = state.node_masses.iter().map(|units| f64::from(*units) * water.mass_unit).collect();
        let bath = state.node_bath.iter().map(|bits| f64::from(f32::from_bits(*bits))).collect();
        let smoothing = Smoothing::new(&water, [model.units.lengths[0], model.units.lengths[1]]);
        let motion = Motion::new(&model, &water);
        Some(Self { model, water, state, smoothing, motion, previous, bath })
    }

    /// The state between steps: positions of step n, velocities before its closing kick, and of a bath the variables
    /// and the masses of nodes of step n - 1.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The mass h̃ on every node at the current positions, in units of depth; node (k, l) at k + l·nₓ.
    #[must_use]
    pub fn node_masses(&self) -> Vec<f64> {
        spread(&self.water, &self.state)
    }

    /// The smoothed depth h on every node at the current positions; node (k, l) at k + l·nₓ.
    #[must_use]
    pub fn depth(&self) -> Vec<f64> {
        let mean = self.mean_depth();
        self.deviation(&self.node_masses()).iter().map(|deviation| mean + deviation).collect()
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// [`Unstable`] when a velocity or a drift does not fit the integer state or there is no depth at a node; the state
    /// is then left as it was.
    pub fn step(&mut self) -> Result<(), Unstable> {
        let Report { masses, bath, velocities, kicks, .. } = self.report()?;
        let (mut paths, mut after) = (Vec::with_capacity(velocities.len()), Vec::with_capacity(velocities.len()));
        for (particle, (reported, kick)) in velocities.into_iter().zip(kicks).enumerate() {
            let before = if self.motion.gyrates { reported } else { self.motion.rotated(reported, 0.5) };
            let velocity = [before[0] + kick[0], before[1] + kick[1]];
            self.check_velocity(particle, velocity)?;
            paths.push(self.motion.path(velocity));
            after.push(if self.motion.gyrates { self.motion.rotated(velocity, 1.0) } else { velocity });
        }
        drift(&mut self.state, &paths)?;
        for (momentum, velocity) in self.state.momenta.iter_mut().zip(after) {
            for axis in 0..2 {
                momentum[axis] = velocity[axis] as i32;
            }
        }
        if self.water.bath.is_some() {
            let to_units = |mass: &f64| (mass / self.water.mass_unit).round_ties_even() as u32;
            self.state.node_masses = masses.iter().map(to_units).collect();
            self.state.node_bath = bath.iter().map(|variable| (*variable as f32).to_bits()).collect();
            self.previous = masses;
            self.bath = bath;
        }
        self.state.step = self.state.step.wrapping_add(1);
        Ok(())
    }

    /// Measures at the report point of the current step, without changing the state. There are no virials.
    ///
    /// # Errors
    /// [`Unstable`] when a velocity does not fit the integer state or there is no depth at a node.
    pub fn observe(&self) -> Result<Observables, Unstable> {
        let report = self.report()?;
        let (water, mean) = (&self.water, self.mean_depth());
        let speed_squared = water.wave_speed.powi(2);
        let mut observables = Observables {
            particles: water.carriers,
            mobile: water.carriers,
            conservative_virial: f64::NAN,
            total_virial: f64::NAN,
            about_centre_of_mass: false,
            ..Observables::zero(&self.model, &self.state)
        };
        for (velocity, units) in report.velocities.iter().zip(&self.state.masses) {
            let mass = f64::from(*units) * water.mass_unit;
            let velocity = velocity.map(|units| units as f64 * self.model.units.momentum);
            observables.mass += mass;
            for axis in 0..2 {
                observables.momentum[axis] += mass * velocity[axis];
                observables.kinetic_energy += 0.5 * mass * velocity[axis].powi(2);
            }
        }
        let products = report.masses.iter().zip(&report.deviation).map(|(mass, deviation)| (mass - mean) * deviation);
        observables.potential_energy = 0.5 * speed_squared * products.sum::<f64>();
        if let Some(step) = &water.bath {
            let squares: f64 = report.bath.iter().map(|variable| variable * variable).sum();
            observables.bath_square = squares / water.nodes() as f64;
            observables.bath_energy = speed_squared * bath::energy(step, squares).unwrap_or(0.0);
        }
        Ok(observables)
    }

    /// Positions and velocities at the report point of the current step, X(n) and V(n).
    ///
    /// # Errors
    /// As [`Self::observe`].
    pub fn reported_state(&self) -> Result<Reported, Unstable> {
        let velocities = self.report()?.velocities;
        let momenta = velocities.iter().map(|[u, v]| [*u as i32, *v as i32, 0]).collect();
        Ok(Reported { momenta, ..self.state.clone().into() })
    }

    fn report(&self) -> Result<Report, Unstable> {
        let masses = self.node_masses();
        let deviation = self.deviation(&masses);
        self.check_depth(&deviation)?;
        let bath = self.bath_after(&masses);
        let mut surface = deviation.clone();
        for (surface, variable) in surface.iter_mut().zip(&bath) {
            *surface += variable;
        }
        let mut velocities: Vec<[i64; 2]> =
            self.state.momenta.iter().map(|[u, v, _]| [i64::from(*u), i64::from(*v)]).collect();
        let kick = |position: &[u32; 3]| half_kick(&self.model, &self.water, &surface, *position);
        let kicks: Vec<[i64; 2]> = self.state.positions.iter().map(kick).collect();
        if self.state.step > 0 {
            for (particle, (velocity, kick)) in velocities.iter_mut().zip(&kicks).enumerate() {
                *velocity = [velocity[0] + kick[0], velocity[1] + kick[1]];
                if !self.motion.gyrates {
                    *velocity = self.motion.rotated(*velocity, 0.5);
                }
                self.check_velocity(particle, *velocity)?;
            }
        }
        Ok(Report { masses, deviation, bath, velocities, kicks })
    }

    /// s(n) from s(n-1) and h̃(n); at step 0 what it is.
    fn bath_after(&self, masses: &[f64]) -> Vec<f64> {
        let Some(step) = &self.water.bath else { return Vec::new() };
        if self.state.step == 0 {
            return self.bath.clone();
        }
        let key = noise::step_key(self.model.seed, stream::MESH, self.state.step);
        // Of kT/c₀²: the energy of the bath has the factor c₀².
        let temperature = self.model.temperature / self.water.wave_speed.powi(2);
        let next = |node: usize| {
            let words = noise::words(self.model.generator, key, [0, node as u32]);
            let change = masses[node] - self.previous[node];
            bath::advanced(step, temperature, self.bath[node], change, noise::gaussian(words))
        };
        (0..masses.len()).map(next).collect()
    }

    /// The mean of the depth: 1 where there is water at all.
    fn mean_depth(&self) -> f64 {
        if self.water.carriers == 0 { 0.0 } else { 1.0 }
    }

    /// A (h̃ - 1).
    fn deviation(&self, masses: &[f64]) -> Vec<f64> {
        let mean = self.mean_depth();
        let deviation: Vec<f64> = masses.iter().map(|mass| mass - mean).collect();
        self.smoothing.apply(&deviation)
    }

    /// A negative depth makes waves grow without limit.
    fn check_depth(&self, deviation: &[f64]) -> Result<(), Unstable> {
        if self.water.carriers == 0 {
            return Ok(());
        }
        match deviation.iter().position(|deviation| deviation.is_nan() || *deviation < -1.0 - ROUNDING) {
            Some(node) => {
                let columns = self.water.mesh[0];
                let node = [node as u32 % columns, node as u32 / columns];
                Err(Unstable::Depth { step: self.state.step, node })
            }
            None => Ok(()),
        }
    }

    fn check_velocity(&self, particle: usize, velocity: [i64; 2]) -> Result<(), Unstable> {
        if velocity.iter().any(|units| !(-MOST_VELOCITY..=MOST_VELOCITY).contains(units)) {
            return Err(Unstable::Momentum { step: self.state.step, particle });
        }
        Ok(())
    }
}
