//! What is measured of a state at one step, as raw sums, and what follows from them.

use super::Model;
use crate::state::State;

/// Raw sums over particles and pairs at the report point of one step.
///
/// Whoever fills this in, the reference or a GPU, computes sums only; everything derived from them is here, once.
///
/// ```
/// use mesoscope::{families::reference::Reference, scene};
///
/// let scene = scene::load("ideal-dissipative-gas", &["space.box=[4,4,4]".to_owned(), "output={}".to_owned()])?;
/// let model = scene.model().clone();
/// let state = mesoscope::families::initial_state(&scene);
/// let found = Reference::new(model, state).observe()?;
/// assert_eq!((found.potential_energy, found.total_energy()), (0.0, found.kinetic_energy));
/// // Without forces that have a potential, pressure is density times temperature.
/// let density = found.particles as f64 / found.volume;
/// assert!((found.conservative_pressure() - density * found.kinetic_temperature()).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Observables {
    /// The step.
    pub step: u64,
    /// Number of particles.
    pub particles: u64,
    /// Number of those that can move.
    pub mobile: u64,
    /// Number of dimensions.
    pub dimension: usize,
    /// Volume of the box (area in two dimensions).
    pub volume: f64,
    /// Mass of all particles.
    pub mass: f64,
    /// Σ p²/2m.
    pub kinetic_energy: f64,
    /// Σ V over pairs.
    pub potential_energy: f64,
    /// The part of it that charges have.
    pub electrostatic_energy: f64,
    /// Σ |∇V|² over particles.
    pub gradient_squared: f64,
    /// Σ ∇²V over particles.
    pub laplacian: f64,
    /// Σ r·F over pairs, of conservative forces only.
    pub conservative_virial: f64,
    /// Σ r·F over pairs, of all forces of the step: conservative, friction and noise.
    pub total_virial: f64,
    /// Total momentum.
    pub momentum: [f64; 3],
    /// Whether the motion of the centre of mass is no degree of freedom of a temperature.
    pub about_centre_of_mass: bool,
    /// Energy of bath variables with memory.
    pub bath_energy: f64,
    /// Mean square of the bath variables.
    pub bath_square: f64,
    /// Mean products of oscillators with their baths.
    pub bath_products: BathProducts,
    /// Momentum and work of body forces since the start.
    pub from_body_forces: Transfer,
    /// Momentum that walls have absorbed since the start, and their work.
    pub on_walls: OnWalls,
    /// What is measured of Voronoi cells, in Voronoi DPD.
    pub cells: Option<CellObservables>,
}

/// Mean products, over all coordinates of oscillators that have a bath with memory: the covariances of bath variable, momentum and displacement
/// from the end of the tether. In equilibrium the exact motion has none of them, and the schemes only the second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BathProducts {
    /// Bath variable times momentum.
    pub momentum: f64,
    /// Bath variable times displacement.
    pub displacement: f64,
    /// Momentum times displacement.
    pub momentum_displacement: f64,
}

/// Momentum and work that body forces have added since the start of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Transfer {
    /// Momentum, the sum of the impulses on all particles.
    pub momentum: [f64; 3],
    /// Work: force times displacement over all drifts so far.
    pub work: f64,
}

/// Momentum that walls have absorbed since the start of a run, and their work.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OnWalls {
    /// Momentum of the lower and the upper wall across x, then y, then z.
    pub momentum: [[f64; 3]; 6],
    /// Momentum along the flow that boundaries which shear have taken from the particles that crossed them.
    pub sheared: f64,
    /// The work that walls have done on the particles: their velocities times the momenta that they gave away.
    pub work: f64,
}

impl OnWalls {
    /// From the sums of the walls that a model has, in order, in units of momentum.
    pub(crate) fn new(model: &Model, sums: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut on_walls = Self::default();
        if model.particles().shear.is_some() {
            on_walls.sheared = sums.map(|sum| sum[0]).sum::<f64>() * model.units.momentum;
            return on_walls;
        }
        let walls = model.particles().walls.iter().flat_map(|pair| [0, 1].map(|upper| (pair, upper)));
        for ((pair, upper), sum) in walls.zip(sums) {
            let momentum = sum.map(|units| units * model.units.momentum);
            on_walls.momentum[2 * pair.axis + upper] = momentum;
            on_walls.work -= (0..3).map(|axis| pair.velocities[upper][axis] * momentum[axis]).sum::<f64>();
        }
        on_walls
    }
}

/// What is measured of Voronoi cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellObservables {
    /// Σ V, which is the volume of the box.
    pub volume: f64,
    /// Number of faces, each counted once; of a generic tessellation of N cells 3N.
    pub faces: u64,
    /// Σ M in integer units.
    pub mass_units: i64,
    /// Σ E, of internal energies.
    pub internal_energy: f64,
    /// Mean temperature kT inside the cells.
    pub internal_temperature: f64,
    /// Σ pV over the volume of the box.
    pub pressure: f64,
    /// Exchanges that the limit has cut since the state was uploaded.
    pub limited_exchanges: u64,
    /// Iterations of the last solution for the friction.
    pub iterations: u64,
    /// Its residual, relative to the right-hand side.
    pub residual: f64,
}

impl Observables {
    /// Those of a step of a model of which nothing has been added up yet.
    pub(crate) fn at(model: &Model, step: u64) -> Self {
        Self {
            step,
            particles: model.particle_count(),
            mobile: model.mobile_particles(),
            dimension: model.units.dimension,
            volume: model.units.volume(),
            about_centre_of_mass: model.measures_about_centre_of_mass(),
            ..Self::default()
        }
    }

    /// Those of a state of which nothing has been added up yet.
    pub(crate) fn zero(model: &Model, state: &State) -> Self {
        Self { particles: state.len() as u64, ..Self::at(model, state.step) }
    }

    /// Kinetic and potential energy.
    #[must_use]
    pub fn total_energy(&self) -> f64 {
        self.kinetic_energy + self.potential_energy
    }

    /// Velocity of the centre of mass; NaN without particles.
    #[must_use]
    pub fn centre_of_mass_velocity(&self) -> [f64; 3] {
        if self.particles == 0 { [f64::NAN; 3] } else { self.momentum.map(|momentum| momentum / self.mass) }
    }

    /// Kinetic temperature kT, about the velocity of the centre of mass where that is none of heat; NaN for too few
    /// particles.
    ///
    /// Σp²/2m - (Σp)²/2Σm is chi-squared with d(N - 1) degrees of freedom whatever the masses, and whether or not they are
    /// exchanged: in equilibrium momenta are Gaussian for any masses at hand.
    #[must_use]
    pub fn kinetic_temperature(&self) -> f64 {
        if !self.about_centre_of_mass {
            return 2.0 * self.kinetic_energy / (self.dimension as f64 * self.mobile as f64);
        }
        if self.mobile < 2 {
            return f64::NAN;
        }
        let bulk = self.momentum.iter().map(|momentum| momentum * momentum).sum::<f64>() / (2.0 * self.mass);
        2.0 * (self.kinetic_energy - bulk) / (self.dimension as f64 * (self.mobile - 1) as f64)
    }

    /// Configurational temperature Σ|∇V|² / Σ∇²V of this one step; NaN where no pair interacts.
    ///
    /// An average over steps is the ratio of the averages of [`Self::gradient_squared`] and [`Self::laplacian`], not
    /// the average of this ratio.
    #[must_use]
    pub fn configurational_temperature(&self) -> f64 {
        self.gradient_squared / self.laplacian
    }

    /// Pressure from all forces; NaN for fewer than two particles. Of Voronoi cells that inside of them and that of their
    /// motion: friction and noise add nothing to it on average in equilibrium.
    #[must_use]
    pub fn pressure(&self) -> f64 {
        match self.cells {
            Some(cells) => self.pressure_of(0.0) + cells.pressure,
            None => self.pressure_of(self.total_virial),
        }
    }

    /// Pressure from conservative forces alone: friction and noise add nothing to it on average in equilibrium, but
    /// widen its distribution. NaN for fewer than two particles.
    #[must_use]
    pub fn conservative_pressure(&self) -> f64 {
        self.pressure_of(self.conservative_virial)
    }

    fn pressure_of(&self, virial: f64) -> f64 {
        let density = self.mobile as f64 / self.volume;
        density * self.kinetic_temperature() + virial / (self.dimension as f64 * self.volume)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAIR: Observables = Observables {
        step: 0,
        particles: 2,
        mobile: 2,
        dimension: 3,
        volume: 10.0,
        mass: 3.0,
        kinetic_energy: 5.0,
        potential_energy: 2.0,
        gradient_squared: 8.0,
        laplacian: 4.0,
        conservative_virial: 6.0,
        total_virial: 12.0,
        momentum: [0.0, 3.0, 0.0],
        about_centre_of_mass: true,
        electrostatic_energy: 0.0,
        bath_energy: 0.0,
        bath_square: 0.0,
        bath_products: BathProducts { momentum: 0.0, displacement: 0.0, momentum_displacement: 0.0 },
        from_body_forces: Transfer { momentum: [0.0; 3], work: 0.0 },
        on_walls: OnWalls { momentum: [[0.0; 3]; 6], sheared: 0.0, work: 0.0 },
        cells: None,
    };

    #[test]
    fn derived_values_follow_from_the_sums() {
        assert_eq!(PAIR.total_energy(), 7.0);
        assert_eq!(PAIR.centre_of_mass_velocity(), [0.0, 1.0, 0.0]);
        // Bulk motion holds 9 / 6 of the kinetic energy.
        assert!((PAIR.kinetic_temperature() - 7.0 / 3.0).abs() < 1e-15);
        assert_eq!(PAIR.configurational_temperature(), 2.0);
        let on_a_mesh = Observables { about_centre_of_mass: false, ..PAIR };
        assert!((on_a_mesh.kinetic_temperature() - 10.0 / 6.0).abs() < 1e-15);
        assert!((PAIR.conservative_pressure() - (7.0 / 15.0 + 0.2)).abs() < 1e-15);
        assert!((PAIR.pressure() - (7.0 / 15.0 + 0.4)).abs() < 1e-15);
    }

    #[test]
    fn voronoi_cells_have_a_pressure_inside() {
        let cells = CellObservables {
            volume: 10.0,
            faces: 6,
            mass_units: 1,
            internal_energy: 30.0,
            internal_temperature: 1.5,
            pressure: 2.0,
            limited_exchanges: 0,
            iterations: 0,
            residual: 0.0,
        };
        let cells = Observables { cells: Some(cells), ..PAIR };
        assert!((cells.pressure() - (7.0 / 15.0 + 2.0)).abs() < 1e-15);
    }

    #[test]
    fn what_is_undefined_is_not_a_number() {
        let single = Observables { particles: 1, mobile: 1, gradient_squared: 0.0, laplacian: 0.0, ..PAIR };
        assert!(single.kinetic_temperature().is_nan());
        assert!(single.pressure().is_nan());
        assert!(single.configurational_temperature().is_nan());
        assert!(Observables { particles: 0, ..single }.centre_of_mass_velocity()[0].is_nan());
    }
}
