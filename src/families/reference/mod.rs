//! The plain float64 implementation of every integrator on the CPU: the executable specification.
//!
//! It steps the same integer [`State`] as the GPU and draws the same random words, so that single steps can be
//! compared closely; all real arithmetic is in float64. Positions are moved and momenta kicked by whole units, and the
//! impulse of a pair is rounded once for both ends, so momentum is conserved to the last bit and no sum over pairs
//! depends on their order.
//!
//! A step begins at positions r(n) with the momenta p(n-½) that brought the particles there. Its *report point* is
//! (r(n), p(n)), when the step's closing kick (and relaxation) is done: there everything is measured. The opening kick
//! and the drift of the same step follow. At step 0 the momenta given are those of the report point, and nothing is
//! closed.

pub(super) mod bath;

use crate::state::State;

pub use super::particles::reference::{Reference, Relaxation, Virial};
pub use super::shallow_water::reference::ShallowWaterReference;
pub use super::voronoi::reference::VoronoiReference;

/// The reference of any family.
pub trait Stepper {
    /// The state between steps, as the GPU keeps it.
    fn state(&self) -> &State;

    /// Advances by one step.
    ///
    /// # Errors
    /// [`Unstable`] when a number does not fit the integer state, which is then left as it was.
    fn step(&mut self) -> Result<(), Unstable>;

    /// Momenta at the report point of the current step, in units of the state.
    ///
    /// # Errors
    /// As [`Self::step`].
    fn reported_momenta(&self) -> Result<Vec<[i32; 3]>, Unstable>;
}

/// What the references of all families have in common.
macro_rules! stepper {
    ($reference:ident) => {
        impl $reference {
            /// The model.
            #[must_use]
            pub fn model(&self) -> &Model {
                &self.model
            }

            /// Advances by a number of steps.
            ///
            /// # Errors
            /// As [`Self::step`]; the state is then that before the failing step.
            pub fn run(&mut self, steps: u64) -> Result<(), Unstable> {
                (0..steps).try_for_each(|_| self.step())
            }
        }

        impl crate::families::reference::Stepper for $reference {
            fn state(&self) -> &State {
                self.state()
            }

            fn step(&mut self) -> Result<(), Unstable> {
                self.step()
            }

            fn reported_momenta(&self) -> Result<Vec<[i32; 3]>, Unstable> {
                Ok(self.reported_state()?.momenta)
            }
        }
    };
}
pub(crate) use stepper;

/// A step that the integer state cannot hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unstable {
    /// A momentum beyond 2³¹ units; in shallow water a velocity beyond 2³⁰.
    #[error("step {step}: the momentum of particle {particle} left the range of the integer state")]
    Momentum {
        /// The step.
        step: u64,
        /// The particle's id.
        particle: usize,
    },
    /// A drift of half the box or more.
    #[error("step {step}: particle {particle} moved by half the box or more")]
    Drift {
        /// The step.
        step: u64,
        /// The particle's id.
        particle: usize,
    },
    /// A bond that is longer than its potential allows.
    #[error("step {step}: bond {bond} is longer than it can be")]
    Bond {
        /// The step.
        step: u64,
        /// The bond's index.
        bond: usize,
    },
    /// A Voronoi cell that gave more mass than it had, or took more than the state can hold.
    #[error("step {step}: the mass of cell {particle} left the range of the integer state")]
    Mass {
        /// The step.
        step: u64,
        /// The cell's id.
        particle: usize,
    },
    /// An energy of a Voronoi cell beyond 2³¹ units.
    #[error("step {step}: the energy of cell {particle} left the range of the integer state")]
    Energy {
        /// The step.
        step: u64,
        /// The cell's id.
        particle: usize,
    },
    /// A smoothed depth of shallow water that is negative.
    #[error("step {step}: there is no depth left at mesh node ({}, {})", node[0], node[1])]
    Depth {
        /// The step.
        step: u64,
        /// The node (k, l).
        node: [u32; 2],
    },
}

/// Half the box: a drift as long as this could be in either direction.
const MOST_DRIFT: i64 = 1 << 31;

/// A distance along an edge of the box, in units of the box fraction, rounded half to even; half the box if it is longer.
pub(crate) fn whole_fractions(distance: f64, edge: f64) -> i64 {
    let most = MOST_DRIFT as f64;
    (distance / edge * 4_294_967_296.0).round_ties_even().clamp(-most, most) as i64
}

/// Moves every particle by whole units of the box fraction.
///
/// # Errors
/// [`Unstable::Drift`] for one that would move by half the box or more; the state is then left as it was.
pub(crate) fn drift<const AXES: usize>(state: &mut State, ways: &[[i64; AXES]]) -> Result<(), Unstable> {
    let too_far = |way: &[i64; AXES]| way.iter().any(|units| !(1 - MOST_DRIFT..MOST_DRIFT).contains(units));
    if let Some(particle) = ways.iter().position(too_far) {
        return Err(Unstable::Drift { step: state.step, particle });
    }
    for (position, way) in state.positions.iter_mut().zip(ways) {
        for (position, units) in position.iter_mut().zip(way) {
            *position = position.wrapping_add(*units as u32);
        }
    }
    Ok(())
}

/// Momenta as the state keeps them.
pub(crate) fn narrow(momenta: &[[i64; 3]], step: u64) -> Result<Vec<[i32; 3]>, Unstable> {
    let fits = |units: &i64| i32::try_from(*units).is_ok();
    match momenta.iter().position(|momentum| !momentum.iter().all(fits)) {
        Some(particle) => Err(Unstable::Momentum { step, particle }),
        None => Ok(momenta.iter().map(|momentum| momentum.map(|units| units as i32)).collect()),
    }
}

/// Momenta wide enough for sums.
pub(crate) fn widen(momenta: &[[i32; 3]]) -> Vec<[i64; 3]> {
    momenta.iter().map(|momentum| momentum.map(i64::from)).collect()
}

pub(crate) fn add(sums: &mut [[i64; 3]], terms: &[[i64; 3]]) {
    for (sum, term) in sums.iter_mut().zip(terms) {
        for axis in 0..3 {
            sum[axis] += term[axis];
        }
    }
}
