//! Voronoi DPD: Flekkøy, Coveney and De Fabritiis, doi:10.1103/PhysRevE.62.2140.
//!
//! A particle is the cell k of a Voronoi tessellation, of mass Mₖ, momentum Pₖ = Mₖ Uₖ and internal energy Eₖ. With
//! e = (rₖ - rₗ)/r, l the length of the face between k and l, c from the middle between the points to that of the face
//! and U = Uₖ - Uₗ,
//!
//! ```text
//! dMₖ = Σ (l/r) ρ̄ c·U dt                                                               (33)
//! dPₖ = Σ dM (Uₖ + Uₗ)/2 + l (pₖ + pₗ)/2 e dt
//!          - η (l/r)(U + (U·e)e) dt + √(2kΘη l/r)(√2 e dW₁ + t dW₂)                     (39), (62)
//! dEₖ = Σ λ (l/r)(Tₗ - Tₖ) dt + √(2kTₖTₗ λ l/r) dW₃ + (l/r) c·U (Eₖ/Vₖ + Eₗ/Vₗ)/2 dt
//!          + dM|U|²/8 - work/2                                                          (43), (62)
//! ```
//! Every term is odd in k and l. The printed coefficient of the mass exchange is half of this, and the printed pressure
//! term of (39) even: [`crate::scene::VoronoiForm`] has the choices. The form `gradient` keeps masses and pushes with
//! l [(pₖ + pₗ)/2 e + (pₖ - pₗ) c/r].
//!
//! The state is that of a full step: positions, momenta, masses, and kinetic and internal energy together. A step is
//!
//! ```text
//! splitting: r += dt/2 U, tessellate, B(dt/2) O(dt) B(dt/2), r += dt/2 U
//! euler:     tessellate, B(dt) + O(dt) from the same U, r += dt U
//! ```
//! B is what pressure does, O friction, noise and heat; O solves for the mean velocity by Crank and Nicolson's rule. What
//! crosses a face is computed once and handed to both cells in whole units. Energies follow from velocities before and
//! after, so that the total is constant to the last bit.

mod equation_of_state;
mod exchange;
mod faces;
mod friction;
mod heat;
mod observables;
mod pressure;

use crate::document::CellIntegrator;
use crate::families::Observables;
use crate::families::reference::{Unstable, drift, whole_fractions};
use crate::families::{Model, Voronoi};
use crate::noise::{self, stream};
use crate::state::{Reported, State};
use crate::tessellation::{self, Tessellation};
use exchange::{Exchange, Ledger};
use faces::{Cells, Face, dot};

/// A model of Voronoi DPD and its state, stepped on the CPU.
///
/// ```
/// use mesoscope::{families::reference::VoronoiReference, scene};
///
/// let small = ["space.box=[6,6]", "particles.0.count=36", "output={}"].map(str::to_owned);
/// let scene = scene::load("voronoi-dpd", &small)?;
/// let model = scene.model().clone();
/// let start = mesoscope::families::initial_state(&scene);
/// let mass = |masses: &[u32]| masses.iter().map(|&units| u64::from(units)).sum::<u64>();
/// let mut reference = VoronoiReference::new(model, start.clone()).ok_or("no Voronoi cells")?;
/// reference.run(10)?;
/// // Cells exchange mass, and none is lost.
/// assert_ne!(reference.state().masses, start.masses);
/// assert_eq!(mass(&reference.state().masses), mass(&start.masses));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct VoronoiReference {
    model: Model,
    cells: Voronoi,
    state: State,
    /// Exchanges that the limit has cut.
    limited: u64,
    /// Of the last solution for the friction.
    iterations: u64,
    residual: f64,
}

/// The faces of a step and the volumes of its cells.
struct Geometry {
    faces: Vec<Face>,
    volumes: Vec<f64>,
}

crate::families::reference::stepper!(VoronoiReference);

impl VoronoiReference {
    /// A reference run from a state; none for a model without Voronoi cells, or a state without what the model needs:
    /// masses, and total energies where cells keep account of them.
    #[must_use]
    pub fn new(model: Model, state: State) -> Option<Self> {
        let cells = model.voronoi().cloned()?;
        let energies = if cells.keeps_energy() { state.len() } else { 0 };
        if state.masses.len() != state.len() || state.energies.len() != energies || state.masses.contains(&0) {
            return None;
        }
        Some(Self { model, cells, state, limited: 0, iterations: 0, residual: 0.0 })
    }

    /// The state between steps, that of a full step.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// [`Unstable`] when a momentum, a mass, an energy or a drift does not fit the integer state, which is then left as it
    /// was.
    pub fn step(&mut self) -> Result<(), Unstable> {
        let mut ahead = self.clone();
        if self.cells.integrator == (CellIntegrator::Euler {}) {
            ahead.euler()?;
        } else {
            ahead.split()?;
        }
        ahead.state.step = ahead.state.step.wrapping_add(1);
        *self = ahead;
        Ok(())
    }

    /// Measures the current state, with a tessellation of its own. There is no virial of friction and noise.
    ///
    /// # Errors
    /// None; the other references have some.
    pub fn observe(&self) -> Result<Observables, Unstable> {
        Ok(observables::observe(self))
    }

    /// The current state, which is that of the report point already.
    ///
    /// # Errors
    /// None; the other references have some.
    pub fn reported_state(&self) -> Result<Reported, Unstable> {
        Ok(self.state.clone().into())
    }

    /// The step of the integrator `splitting`.
    fn split(&mut self) -> Result<(), Unstable> {
        let time = self.model.time_step;
        self.drift(0.5 * time)?;
        let geometry = self.geometry();
        self.push(&geometry, 0.5 * time)?;
        self.relax(&geometry, time)?;
        self.push(&geometry, 0.5 * time)?;
        self.drift(0.5 * time)
    }

    /// The step of the integrator `euler`.
    fn euler(&mut self) -> Result<(), Unstable> {
        let time = self.model.time_step;
        let geometry = self.geometry();
        let now = self.now(&geometry);
        let mut exchanges = self.pressure(&geometry, &now, time);
        let deviates = self.deviates(&geometry.faces);
        for ((face, exchange), deviates) in geometry.faces.iter().zip(&mut exchanges).zip(deviates) {
            let random = friction::random_impulse(&self.cells, &now, face, deviates, time);
            exchange.add(&self.irreversible(face, &now, &now.velocities, random, deviates, time));
        }
        // The positions move with the velocities before.
        self.drift(time)?;
        self.settle(&geometry.faces, &exchanges, &now)
    }

    /// B: pressure and mass exchange.
    ///
    /// Internal energies change what pushes them: it is the pressure halfway that acts, so that the step is of second
    /// order.
    fn push(&mut self, geometry: &Geometry, time: f64) -> Result<(), Unstable> {
        let mut now = self.now(geometry);
        if self.cells.keeps_energy() {
            now.pressures = self.middle_pressures(geometry, &now, time);
        }
        let exchanges = self.pressure(geometry, &now, time);
        self.settle(&geometry.faces, &exchanges, &now)
    }

    /// The pressures in the middle of a push, from the heat that it brings to each cell if velocities and pressures stay.
    fn middle_pressures(&self, geometry: &Geometry, now: &Cells, time: f64) -> Vec<f64> {
        let mut heat = vec![0.0; self.state.len()];
        for face in &geometry.faces {
            let (exchange, _) = pressure::exchange(&self.cells, now, face, time);
            let total = exchange.total_energy(face, &now.velocities, &now.velocities);
            for (cell, sign) in [(face.k, 1.0), (face.l, -1.0)] {
                let velocity = now.velocities[cell];
                let kinetic = dot(exchange.momentum, velocity) - 0.5 * exchange.mass * dot(velocity, velocity);
                heat[cell] += sign * (total - kinetic);
            }
        }
        (0..heat.len())
            .map(|cell| {
                let energy = now.internal_energies[cell] + 0.5 * heat[cell];
                let temperature = equation_of_state::temperature(&self.cells, now.masses[cell], energy);
                equation_of_state::pressure(&self.cells, now.masses[cell], now.volumes[cell], temperature)
            })
            .collect()
    }

    fn pressure(&mut self, geometry: &Geometry, now: &Cells, time: f64) -> Vec<Exchange> {
        let mut exchanges = Vec::with_capacity(geometry.faces.len());
        for face in &geometry.faces {
            let (exchange, limited) = pressure::exchange(&self.cells, now, face, time);
            exchanges.push(exchange);
            self.limited += u64::from(limited);
        }
        exchanges
    }

    /// O: friction and noise by Crank and Nicolson's rule, and heat.
    fn relax(&mut self, geometry: &Geometry, time: f64) -> Result<(), Unstable> {
        let now = self.now(geometry);
        let faces = &geometry.faces;
        let deviates = self.deviates(faces);
        let random =
            |(face, deviates): (&Face, &[f64; 3])| friction::random_impulse(&self.cells, &now, face, *deviates, time);
        let random: Vec<[f64; 2]> = faces.iter().zip(&deviates).map(random).collect();
        let mean = friction::solve(&self.cells, &now, faces, &random, time);
        let mut exchanges = Vec::with_capacity(faces.len());
        for ((face, random), deviates) in faces.iter().zip(random).zip(deviates) {
            exchanges.push(self.irreversible(face, &now, &mean.velocities, random, deviates, time));
        }
        (self.iterations, self.residual) = (mean.iterations, mean.residual);
        self.settle(faces, &exchanges, &now)
    }

    /// What friction at some velocities, noise and heat do at a face.
    fn irreversible(
        &mut self,
        face: &Face,
        now: &Cells,
        velocities: &[[f64; 2]],
        random: [f64; 2],
        deviates: [f64; 3],
        time: f64,
    ) -> Exchange {
        let friction = friction::impulse(&self.cells, face, velocities, time);
        let (energy, limited) = heat::flow(&self.cells, now, face, deviates, time);
        self.limited += u64::from(limited);
        Exchange { momentum: [0, 1].map(|axis| friction[axis] + random[axis]), energy, ..Exchange::default() }
    }

    /// Hands what crosses the faces to the cells: momentum and mass first, then energy, whose work depends on what they
    /// come to.
    fn settle(&mut self, faces: &[Face], exchanges: &[Exchange], before: &Cells) -> Result<(), Unstable> {
        let mut ledger = Ledger::new(self.state.len());
        for (face, exchange) in faces.iter().zip(exchanges) {
            ledger.hand(&self.model, &self.cells, face, exchange);
        }
        ledger.apply_to(&mut self.state)?;
        if self.cells.keeps_energy() {
            let after = self.velocities();
            let mut ledger = Ledger::new(self.state.len());
            for (face, exchange) in faces.iter().zip(exchanges) {
                let energy = exchange.total_energy(face, &before.velocities, &after);
                ledger.hand_energy(&self.cells, face, energy);
            }
            ledger.apply_to(&mut self.state)?;
        }
        Ok(())
    }

    /// U of every cell.
    fn velocities(&self) -> Vec<[f64; 2]> {
        faces::velocities(&self.model, &faces::masses(&self.cells, &self.state), &self.state)
    }

    fn now(&self, geometry: &Geometry) -> Cells {
        Cells::of(&self.model, &self.cells, &self.state, &geometry.volumes)
    }

    fn deviates(&self, faces: &[Face]) -> Vec<[f64; 3]> {
        let key = noise::step_key(self.model.seed, stream::FACE, self.state.step);
        faces.iter().map(|face| face.deviates(&self.model, key)).collect()
    }

    /// Tessellates, after cells at exactly the same place are parted.
    fn geometry(&mut self) -> Geometry {
        tessellation::part_coincident(&mut self.state.positions);
        let lengths = [self.model.units.lengths[0], self.model.units.lengths[1]];
        let tessellation = Tessellation::of_fractions(lengths, &self.state.positions);
        let volumes = tessellation.cells.iter().map(|cell| cell.volume).collect();
        Geometry { faces: faces::shared(&tessellation), volumes }
    }

    /// Moves every cell by U dt in whole units of the box fraction, rounded half to even.
    fn drift(&mut self, time: f64) -> Result<(), Unstable> {
        let (lengths, velocities) = (self.model.units.lengths, self.velocities());
        let way = |velocity: &[f64; 2]| [0, 1].map(|axis| whole_fractions(time * velocity[axis], lengths[axis]));
        drift(&mut self.state, &velocities.iter().map(way).collect::<Vec<_>>())
    }
}
