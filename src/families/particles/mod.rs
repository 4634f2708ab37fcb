//! Particles with forces between them: dissipative particle dynamics, couplings with baths, bonds and chains.

pub(crate) mod chains;
pub(crate) mod checks;
pub mod combinations;
mod composition;
mod conservation;
mod description;
mod layout;
pub(crate) mod model;
mod normal_modes;
mod observables;
mod oscillators;
pub(crate) mod plan;
pub mod reference;
pub(crate) mod space;
pub(crate) mod stability;
mod start;
mod sums;
pub(crate) mod terms;
mod unneeded;
mod warnings;

pub use layout::{CoupledLayout, KeptArray, ListLayout, ParticleLayout};

use super::reference::Stepper;
use super::{
    Angles, BathStep, BodyForces, Bonds, ChainGroup, Checked, ColouredNoise, Column, Electrostatics, ExactMean,
    KeptQuantity, KeptSum, Limit, Model, Observables, PairForce, Physics, PlaneWalls, PositionBath, ShearedBox,
    Species, Tethers, units,
};
use crate::document::{BondPotential, Integrator, PairRelaxation, Problems, Scene, Surroundings, Warning};
use crate::plan::{Hardware, Measured, Options, PhysicsPlan, Plan};
use crate::shaders::Sum;
use crate::state::State;
use model::topology::chain_groups;
use reference::Reference;
use std::ops::Range;
use std::sync::LazyLock;
use terms::Term;

/// What acts on particles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Particles {
    /// Integrator.
    pub integrator: Integrator,
    /// The pair force, if the scene has one.
    pub pair_force: Option<PairForce>,
    /// How dense it is around particles, where there is one and the start says where they are.
    pub surroundings: Option<Surroundings>,
    /// A heat bath on the coordinates of particles.
    pub position_bath: Option<PositionBath>,
    /// A random force on every particle that is constant for random times.
    pub coloured_noise: Option<ColouredNoise>,
    /// Springs from every particle to where it started.
    pub tethers: Option<Tethers>,
    /// Forces between charged particles.
    pub electrostatics: Option<Electrostatics>,
    /// Forces on particles from outside.
    pub body_forces: Option<BodyForces>,
    /// Walls that reflect particles, in the order of their axes.
    pub walls: Vec<PlaneWalls>,
    /// Boundaries that shear, if there are any.
    pub shear: Option<ShearedBox>,
    /// Groups of chains; of molecules, where a scene measures their sizes.
    pub chain_groups: Vec<ChainGroup>,
    /// Bonds, if there are any.
    pub bonds: Option<Bonds>,
    /// Angles between bonds, if they are stiff.
    pub angles: Option<Angles>,
    /// True if particles are of systems side by side that never meet, each at a temperature of its own; then they lie
    /// species by species.
    pub side_by_side: bool,
}

/// What acts on the particles of other families.
pub(super) static NONE: LazyLock<Particles> = LazyLock::new(Particles::default);

impl Particles {
    /// Temperature kT of the bath of pairs in their model.
    pub(crate) fn pair_temperature(&self, model: &Model) -> f64 {
        self.pair_force.as_ref().map_or(model.temperature, |force| force.temperature)
    }

    /// Whether steps of their model are split, friction apart from the conservative force. Without friction there is nothing to
    /// split.
    #[must_use]
    pub fn splits(&self) -> bool {
        self.relaxes_pairs() || self.relaxes_particles() || self.relaxes_bonds()
    }

    /// Whether a split step relaxes the velocities of pairs.
    pub(crate) fn relaxes_pairs(&self) -> bool {
        matches!(self.integrator, Integrator::Splitting { .. })
            && self.pair_force.as_ref().is_some_and(|force| force.largest_friction() > 0.0)
    }

    /// Whether a split step relaxes the momentum of every particle by itself.
    pub(crate) fn relaxes_particles(&self) -> bool {
        matches!(self.integrator, Integrator::Splitting { .. })
            && self.position_bath.as_ref().is_some_and(|bath| !bath.memory)
    }

    /// Kicks of a step have baths on coordinates of particles, or a random force on them.
    pub(crate) fn acts_on_particles(&self) -> bool {
        (self.position_bath.is_some() && !self.relaxes_particles()) || self.coloured_noise.is_some()
    }

    /// Whether particles are oscillators in baths with memory: a report adds the covariances of bath, momentum and displacement, which theory
    /// knows.
    pub(crate) fn oscillates_in_memory(&self) -> bool {
        self.tethers.is_some() && self.position_bath.as_ref().is_some_and(|bath| bath.memory)
    }

    /// The number of coordinates that have such a bath, and can move.
    pub(crate) fn oscillating_coordinates(&self, model: &Model) -> u64 {
        let Some(bath) = self.position_bath.as_ref().filter(|_| self.oscillates_in_memory()) else { return 0 };
        let oscillates = |(_, step): &(&Species, &BathStep)| step.continuous_coupling > 0.0;
        let species = model.species.iter().zip(&bath.steps).filter(oscillates);
        species.map(|(species, _)| species.count * model.units.dimension as u64).sum()
    }

    /// Whether a split step relaxes the velocities along bonds.
    pub(crate) fn relaxes_bonds(&self) -> bool {
        matches!(self.integrator, Integrator::Splitting { .. })
            && self.bonds.as_ref().is_some_and(|bonds| bonds.have_friction() && !bonds.have_memory())
    }

    /// Whether a split step relaxes the velocities of pairs in two stages.
    pub(crate) fn relaxes_in_two_stages(&self) -> bool {
        self.relaxes_pairs() && self.integrator == Integrator::Splitting { relaxation: Some(PairRelaxation::TwoStages) }
    }

    /// What acts on the particles of a scene; harmonic chains add their species.
    pub(super) fn new(scene: &Scene, integrator: &Integrator, species: &mut Vec<Species>) -> Self {
        let mut particles = Self {
            integrator: integrator.clone(),
            walls: PlaneWalls::of(scene),
            shear: ShearedBox::of(scene),
            ..Self::default()
        };
        for term in terms::acting(scene) {
            term.add(scene, species, &mut particles);
        }
        let unbonded = Bonds::default();
        particles.chain_groups = chain_groups(scene, particles.bonds.as_ref().unwrap_or(&unbonded));
        particles.bonds = particles.bonds.filter(|bonds| bonds.count() > 0);
        particles.angles = particles.angles.filter(|angles| angles.count() > 0);
        particles
    }

    /// Everything that acts on particles, and the walls and boundaries of their space.
    pub(crate) fn terms(&self) -> Vec<&dyn Term> {
        fn term<T: Term>(term: &T) -> &dyn Term {
            term
        }
        let before = [self.coloured_noise.as_ref().map(term), self.body_forces.as_ref().map(term)];
        let after = [
            self.shear.as_ref().map(term),
            self.position_bath.as_ref().map(term),
            self.pair_force.as_ref().map(term),
            self.bonds.as_ref().map(term),
            self.angles.as_ref().map(term),
            self.tethers.as_ref().map(term),
            self.electrostatics.as_ref().map(term),
        ];
        before.into_iter().flatten().chain(self.walls.iter().map(term)).chain(after.into_iter().flatten()).collect()
    }

    /// The arrays of the state that terms keep between steps.
    pub(crate) fn kept(&self, model: &Model) -> Vec<KeptArray> {
        self.terms().into_iter().filter_map(|term| term.keeps(model)).collect()
    }

    /// Leaves out how bonds and angles are described where both have the same, which may be along chains or from a file, and who belongs
    /// to a chain and how dense it is around particles, which no force depends on.
    pub(super) fn take_links_alike(&mut self, other: &mut Self) {
        other.chain_groups.clone_from(&self.chain_groups);
        other.surroundings.clone_from(&self.surroundings);
        if let (Some(mine), Some(theirs)) = (&self.bonds, &mut other.bonds)
            && mine.iter().eq(theirs.iter())
        {
            theirs.runs = mine.runs.clone();
        }
        if let (Some(mine), Some(theirs)) = (&self.angles, &mut other.angles)
            && mine.iter().eq(theirs.iter())
        {
            theirs.runs = mine.runs.clone();
        }
    }

    /// Whether a wall moves.
    pub(crate) fn walls_move(&self) -> bool {
        self.walls.iter().any(PlaneWalls::move_along)
    }

    /// True if forces from outside oscillate.
    pub(crate) fn have_oscillating_forces(&self) -> bool {
        self.body_forces.as_ref().is_some_and(|forces| forces.turn.is_some())
    }

    /// Whether forces depend on the density around particles.
    pub(crate) fn have_local_densities(&self) -> bool {
        self.pair_force.as_ref().is_some_and(|force| force.many_body.is_some())
    }

    /// There is more than pairs without memory: bonds, angles, tethers, baths on particles, memory, or a line on
    /// which particles are.
    pub(crate) fn have_more_than_pairs(&self, model: &Model) -> bool {
        self.are_sprung() || self.acts_on_particles() || self.has_memory() || model.units.dimension == 1
    }

    /// Steps list pairs: those that persist because they remember, those on a line, and those of steps as short as
    /// a coloured noise needs, for which a list lasts long (its scene is 7 % faster so on lavapipe, 2026-11-27).
    pub(crate) fn list_pairs(&self, model: &Model) -> bool {
        let short = self.coloured_noise.is_some() && !self.have_local_densities() && !self.splits();
        self.pair_force
            .as_ref()
            .is_some_and(|force| force.acts() && (force.remembers() || model.units.dimension == 1 || short))
    }

    /// Whether there are bonds, angles or tethers.
    pub(crate) fn are_sprung(&self) -> bool {
        self.are_bonded() || self.tethers.is_some()
    }

    /// Whether there are bonds or angles.
    pub(crate) fn are_bonded(&self) -> bool {
        self.bonds.is_some() || self.angles.is_some()
    }
}

impl Physics for Particles {
    fn momentum_unit(&self, scene: &Scene, species: &[Species]) -> f64 {
        units::momentum_unit(scene, species, self.pair_force.as_ref(), 24.0)
    }

    fn gaps(&self, scene: &Scene) -> [f64; 3] {
        let mut gaps = [0.0; 3];
        let cutoff = self.pair_force.as_ref().map(|force| force.cutoff);
        for walls in &self.walls {
            gaps[walls.axis] = walls.gap(cutoff, scene.space.lengths.get(walls.axis).copied().unwrap_or(1.0));
        }
        gaps
    }

    fn reach(&self, model: &Model) -> f64 {
        match &self.pair_force {
            Some(force) => force.cutoff,
            // Nothing but a pair force tells, but it must not go round the box.
            None => 0.4 * model.units.shortest_length(),
        }
    }

    fn reach_in_words(&self) -> &'static str {
        if self.pair_force.is_some() { "the cutoff" } else { "what is safe in this box" }
    }

    fn longest_step(&self, model: &Model) -> f64 {
        model.pair_step()
    }

    fn has_potential(&self) -> bool {
        self.terms().iter().any(|term| term.has_potential())
    }

    fn has_memory(&self) -> bool {
        self.terms().iter().any(|term| term.has_memory())
    }

    fn is_free(&self) -> bool {
        !self.terms().iter().any(|term| term.is_tied_to_space())
    }

    fn reaches_equilibrium(&self) -> bool {
        !self.side_by_side && self.body_forces.is_none() && !self.walls_move() && self.shear.is_none()
    }

    fn is_conservative(&self, model: &Model) -> bool {
        conservation::drives(model).is_empty()
            && conservation::baths(model).iter().all(|(step, _)| step.coupling == 0.0)
    }

    fn has_thermostat(&self, model: &Model) -> bool {
        let mut acting = conservation::baths(model).into_iter().filter(|(step, _)| step.coupling > 0.0).peekable();
        conservation::drives(model).is_empty()
            && acting.peek().is_some()
            && model.temperature > 0.0
            && acting.all(|(_, temperature)| temperature == model.temperature)
    }

    fn limits(&self, scene: &Checked) -> Vec<Limit> {
        stability::limits(self, scene)
    }

    fn exact_means(&self, model: &Model) -> Vec<ExactMean> {
        oscillators::means(model)
    }

    fn estimates(&self, model: &Model) -> Vec<String> {
        description::estimates(model)
    }

    fn warnings(&self, scene: &Checked) -> Vec<Warning> {
        warnings::warnings(self, scene)
    }

    fn complete_start(&self, state: &mut State, scene: &Checked, thermal: &[Range<usize>]) {
        start::complete(self, state, scene, thermal);
    }

    fn may_refuse_starts(&self) -> bool {
        let kinds = self.bonds.iter().flat_map(|bonds| &bonds.kinds);
        let are_walled = !self.walls.is_empty() && self.bonds.is_some();
        are_walled || kinds.into_iter().any(|kind| matches!(kind.potential, Some(BondPotential::Fene { .. })))
    }

    fn check_start(&self, scene: &Checked, state: &State, problems: &mut Problems) {
        terms::bonds::check_extents(scene, state, problems);
        space::walls::scene::check_bonds(self, scene.model(), state, problems);
    }

    fn unneeded(&self, scene: &Checked) -> Vec<String> {
        unneeded::unneeded(self, scene)
    }

    fn check_capacity(&self, scene: &Checked, problems: &mut Problems) {
        for term in self.terms() {
            term.check_capacity(scene, problems);
        }
        if let Some(asked) = &scene.output.chain_sizes {
            checks::check_kinds(asked, self, problems);
        }
    }

    fn check_step(&self, scene: &Checked, problems: &mut Problems) {
        if self.have_more_than_pairs(scene.model()) {
            stability::check(scene, problems);
        }
        stability::check_pairs(scene, problems);
    }

    fn unshared(&self, scene: &Scene) -> Vec<String> {
        combinations::unshared(scene)
    }

    fn plan(&self, model: &Model, measured: &Measured, hardware: Hardware, options: Options) -> PhysicsPlan {
        self::plan::step::plan(model, measured, hardware, options)
    }

    fn description(&self, scene: &Checked, plan: &Plan, cells: &str) -> Vec<(&'static str, String)> {
        let mut rows = vec![("cells", cells.to_owned())];
        rows.extend(description::list(scene.model(), plan));
        if let Some(electrostatics) = &self.electrostatics {
            rows.extend(terms::electrostatics::description(electrostatics, scene.model()));
        }
        rows
    }

    fn composition(&self, scene: &Checked) -> Vec<(&'static str, String)> {
        composition::rows(scene)
    }

    fn observables(&self, step: u64, sums: &[i64], plan: &Plan, model: &Model) -> Observables {
        observables::observables(step, sums, plan, model)
    }

    fn columns(&self, model: &Model) -> Vec<Column> {
        observables::columns(self, model)
    }

    fn kept(&self, model: &Model, state: &State) -> Vec<KeptSum> {
        if !model.exchanges_momentum() {
            return Vec::new();
        }
        let sums = sums::sums(model);
        let given = sums.place(Sum::GivenMomentum);
        let walls = sums.place(Sum::Walls).map(|first| (first, space::walls::plan::count(model)));
        // What frozen particles have by the motion of their walls is no part of the momentum of a report.
        let carried = |axis: usize| -> i64 {
            let frozen = |(momentum, species): (&[i32; 3], &u32)| {
                if model.species[*species as usize].frozen { i64::from(momentum[axis]) } else { 0 }
            };
            state.momenta.iter().zip(&state.species).map(frozen).sum()
        };
        // A run that goes on with an earlier one starts with what had been given and absorbed.
        let exchanged = state.exchanged_momentum();
        let shear = self.shear.is_some();
        let quantity = KeptQuantity::Momentum { walls: walls.is_some() && !shear, shear, body_forces: given.is_some() };
        let mut momentum = super::conservation::momentum(state, &sums, model.units.dimension, model.units.momentum);
        for (axis, sum) in momentum.iter_mut().enumerate() {
            (sum.quantity, sum.total) = (quantity, exchanged[axis] - carried(axis));
            sum.parts.extend(given.map(|first| (first + axis, -1)));
            sum.parts.extend(
                walls.into_iter().flat_map(|(first, count)| (0..count).map(move |wall| (first + 3 * wall + axis, 1))),
            );
        }
        momentum
    }

    fn never_changes(&self) -> &'static [&'static str] {
        &["mass"]
    }

    fn fate_of_energy(&self, model: &Model) -> String {
        conservation::fate_of_energy(model)
    }

    fn fate_of_momentum(&self, model: &Model) -> Vec<&'static str> {
        conservation::fate_of_momentum(model)
    }

    fn momentum_out_of_range(&self, _: &Plan) -> String {
        "a momentum is more than 64 times its natural scale, √(m kT), as it also becomes where particles start much closer \
         together than their temperature lets them come"
            .to_owned()
    }

    fn crowd(&self, model: &Model) -> &'static str {
        if self.list_pairs(model) {
            "the neighbour list overflowed"
        } else {
            "too many particles crowd in one part of the box"
        }
    }

    fn reference(&self, model: &Model, state: &State) -> Option<Box<dyn Stepper>> {
        let (model, state) = (model.clone(), state.clone());
        Some(Box::new(Reference::new(model, state)))
    }
}

/// The index of a species by its name.
fn index_of(species: &[Species], name: &str) -> Option<usize> {
    species.iter().position(|species| species.name == name)
}
