//! How the integer state lies in the buffers and textures of a plan: what every family says of its own.

use super::compared::Compared;
use crate::shaders::Array;
use crate::state::{State, StateArray};
use std::any::Any;
use std::fmt::Debug;
use std::ops::Deref;
use std::sync::Arc;

/// How the integer state of a family lies in buffers and textures.
pub trait StateLayout: Compared + Debug + Send + Sync {
    /// The buffers and textures that hold the state.
    fn buffers(&self) -> Vec<Array>;

    /// The contents of [`Self::buffers`], with the particles in a given order of their ids.
    ///
    /// # Errors
    /// [`Misfit`].
    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit>;

    /// True if [`Self::pack`] of some particles gives their part of the first array, and all of the others: a state
    /// then passes to the device and back in stretches.
    fn divides(&self) -> bool {
        false
    }

    /// The state of so many particles at a step in the contents of [`Self::buffers`]: what [`Self::pack`] put in, in order
    /// of the ids.
    ///
    /// # Errors
    /// What is wrong with the contents.
    fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String>;

    /// The same, of particles that several ranks share out, which [`Self::place`] puts in: the first of the contents is empty.
    ///
    /// # Errors
    /// What is wrong with the contents.
    fn begin(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let _ = (step, contents, count);
        Err("a state of this kind lies on one device".to_owned())
    }

    /// Puts some particles, as they are stored, into a state that was begun.
    ///
    /// # Errors
    /// What is wrong with them.
    fn place(&self, particles: &[u32], places: &mut Places, state: &mut State) -> Result<(), String> {
        let _ = (particles, places, state);
        Err("a state of this kind lies on one device".to_owned())
    }

    /// The arrays that a state of so many particles has, and how long they are; it has no others.
    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)>;

    /// What a state of the right arrays holds that no run leaves, if anything.
    fn wrong_content(&self, state: &State) -> Option<String> {
        let _ = state;
        None
    }
}

/// The length of an array of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// So many elements.
    Exactly(usize),
    /// So many, or none before the first step, which makes it.
    AfterFirstStep(usize),
    /// Any number; an estimate is so many.
    About(usize),
}

impl Length {
    /// Number of elements, as far as it is known beforehand.
    pub(crate) fn expected(self) -> usize {
        match self {
            Self::Exactly(count) | Self::AfterFirstStep(count) | Self::About(count) => count,
        }
    }

    /// Whether an array of a state at a step may have so many elements.
    pub(crate) fn allows(self, count: usize, step: u64) -> bool {
        match self {
            Self::Exactly(expected) => count == expected,
            Self::AfterFirstStep(expected) => count == expected || (step == 0 && count == 0),
            Self::About(_) => true,
        }
    }
}

/// Why a state does not fit a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Misfit {
    /// An array of fixed capacity would have to hold more particles than it can.
    Crowded,
    /// Something the layout stores is not in the state.
    Missing(String),
}

impl From<&str> for Misfit {
    fn from(what: &str) -> Self {
        Self::Missing(format!("{what} missing"))
    }
}

/// The layout of a plan.
///
/// ```
/// use mesoscope::families::particles::{CoupledLayout, ParticleLayout};
/// use mesoscope::{plan::Layout, state::State};
///
/// let layout = Layout::new(ParticleLayout { dimension: 2, predicted: false, account: 0, walls: 0 });
/// let positions = vec![[1, 2, 0], [3, 4, 0]];
/// let state = State { positions, momenta: vec![[-1, 1, 0]; 2], species: vec![0, 0], ..State::default() };
/// // The order in storage is forgotten when the state is read back.
/// let words = layout.pack(&state, &[1, 0]).map_err(|misfit| format!("{misfit:?}"))?;
/// let contents: Vec<&[u32]> = words.iter().map(Vec::as_slice).collect();
/// assert_eq!(layout.unpack(0, &contents, 2)?, state);
/// // Whoever knows the family can ask for what only its layouts have.
/// assert!(layout.of::<ParticleLayout>().is_some_and(|layout| layout.dimension == 2));
/// assert!(layout.of::<CoupledLayout>().is_none());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone)]
pub struct Layout(Arc<dyn StateLayout>);

impl Layout {
    /// A layout of some family.
    #[must_use]
    pub fn new(layout: impl StateLayout) -> Self {
        Self(Arc::new(layout))
    }

    /// It as one of a type, if it is.
    #[must_use]
    pub fn of<L: StateLayout>(&self) -> Option<&L> {
        let any: &dyn Any = self.0.as_ref();
        any.downcast_ref()
    }
}

impl Deref for Layout {
    type Target = dyn StateLayout;

    fn deref(&self) -> &Self::Target {
        self.0.as_ref()
    }
}

impl PartialEq for Layout {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(other.0.as_ref())
    }
}

/// The places of particles that are read back, by their ids: each comes once.
#[derive(Debug)]
pub struct Places(Vec<bool>);

impl Places {
    /// Of so many particles.
    pub(crate) fn of(count: usize) -> Self {
        Self(vec![false; count])
    }

    /// The place of a particle.
    ///
    /// # Errors
    /// An id that came already, or is none.
    pub(crate) fn take(&mut self, id: u32) -> Result<usize, String> {
        let place = id as usize;
        let fresh = self.0.get_mut(place).is_some_and(|taken| !std::mem::replace(taken, true));
        if fresh { Ok(place) } else { Err(format!("a particle came back with number {id}")) }
    }
}

/// The contents of one of the arrays of a layout; empty if it is missing.
pub(crate) fn content<'a>(contents: &[&'a [u32]], index: usize) -> &'a [u32] {
    contents.get(index).copied().unwrap_or_default()
}
