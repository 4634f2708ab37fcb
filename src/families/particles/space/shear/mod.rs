//! Shear in numbers: by how much boundaries are displaced, and what a particle's momentum changes by where it crosses one.

pub(crate) mod plan;
pub(crate) mod reference;
pub(crate) mod scene;

use crate::document::{Problems, Scene, Shear};
use crate::families::particles::terms::{PlannedTerm, ReferenceTerm, Term};
use crate::families::{Checked, Model};

/// Periodic boundaries that move along x past each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearedBox {
    /// The axis along which the velocity grows, across which the boundaries are.
    pub gradient: usize,
    /// The velocity of a boundary past the opposite one.
    pub velocity: f64,
    /// What the displacement grows by in half a time step, in 2⁻⁶⁴ of the box.
    increment: u64,
    /// The displacement at the start, in 2⁻³² of the box.
    first: u32,
}

/// What a displacement has grown by after some halves of time steps, in 2⁻³² of the box.
fn grown(halves: u64, increment: u64) -> u32 {
    (halves.wrapping_mul(increment) >> 32) as u32
}

impl PlannedTerm for ShearedBox {}
impl ReferenceTerm for ShearedBox {}

impl Term for ShearedBox {
    fn energy_source(&self) -> Option<&'static str> {
        Some("added by shear, at the rate of the shear stress times the shear rate and the volume")
    }

    fn momentum_source(&self) -> Option<&'static str> {
        let way = "sheared boundaries take it from particles that cross them, as much as `shear_momentum` in the table \
                   of energies says";
        Some(way)
    }

    fn check_capacity(&self, scene: &Checked, problems: &mut Problems) {
        scene::check_step(scene, self, problems);
    }
}

impl ShearedBox {
    /// That of a scene; none at a rate of zero, unless boundaries are displaced.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let is_there = |shear: &&Shear| shear.rate != 0.0 || shear.first_shift(&scene.space.lengths) != 0;
        let shear = scene.space.shear.as_ref().filter(is_there)?;
        let gradient = shear.gradient as usize;
        let edge = |axis: usize| scene.space.lengths.get(axis).copied().unwrap_or(1.0);
        let velocity = shear.rate * edge(gradient);
        let boxes = (0.5 * scene.time.step * velocity / edge(0)).fract();
        let increment = (boxes * 2_f64.powi(64)).round_ties_even() as i128 as u64;
        // That of the scene is where they are when its first step begins.
        let steps = scene.earlier_run().map_or(0, |earlier| earlier.steps);
        let first = shear.first_shift(&scene.space.lengths).wrapping_sub(grown(steps.wrapping_mul(2), increment));
        Some(Self { gradient, velocity, increment, first })
    }

    /// How far the copy of the box above it is displaced along x after some halves of time steps of the [clock](Model::clock), in 2⁻³² of
    /// the box: exactly, after any number of them.
    ///
    /// ```
    /// use mesoscope::{families::Model, scene};
    ///
    /// // A box in 256 steps, a quarter in 64.
    /// let changes = [r#"space={"box":[8,8,8],"shear":{"rate":0.25,"gradient":"y"}}"#, "time.step=0.015625", "output={}"];
    /// let scene = scene::load("dpd-fluid", &changes.map(str::to_owned))?;
    /// let shear = scene.model().particles().shear.expect("shear");
    /// assert_eq!(shear.shift(128), 1 << 30);
    /// assert_eq!(shear.shift(512), shear.shift(0));
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn shift(&self, halves: u64) -> u32 {
        self.first.wrapping_add(grown(halves, self.increment))
    }

    /// The low and the high word of what the displacement grows by in half a time step.
    pub(crate) fn increment(&self) -> [u32; 2] {
        [self.increment as u32, (self.increment >> 32) as u32]
    }

    /// The shear rate: velocity per length along the gradient.
    pub(crate) fn rate(&self, model: &Model) -> f64 {
        self.velocity / model.units.lengths[self.gradient]
    }

    /// By how many units the momentum of a particle of a species is larger above a boundary than below.
    #[must_use]
    pub fn jump(&self, species: usize, model: &Model) -> i32 {
        (model.species[species].mass * self.velocity / model.units.momentum).round_ties_even() as i32
    }

    /// The momentum of a species that flows with the linear profile, at a place along the gradient.
    #[must_use]
    pub fn flow(&self, species: usize, place: u32, model: &Model) -> f64 {
        (f64::from(place) / 4_294_967_296.0 - 0.5) * f64::from(self.jump(species, model))
    }
}
