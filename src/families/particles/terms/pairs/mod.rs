//! Pair forces of dissipative particle dynamics, doi:10.1063/1.474784.

pub(crate) mod densities;
pub(crate) mod law;
mod leapfrog;
mod list_reference;
mod many_body;
mod margin;
mod memory_reference;
mod plan;
mod relaxation;
mod scene;
pub(crate) mod surroundings;
mod time_scales;

pub use many_body::ManyBodyForce;
pub(crate) use relaxation::{MOST_RELAXATION, TOLERANCE};
pub(crate) use scene::check_together;
pub(crate) use time_scales::FREQUENCY_LIMIT;

use super::{ReferenceTerm, Term};
use crate::document::{Bath, DpdInteraction, Scene};
use crate::families::particles::reference::{Configuration, Kicks, Moment};
use crate::families::{BathStep, Model, Species};
use std::f64::consts::PI;

/// Margin of lists that no scene asks for, and of those of runs from before margins were chosen.
const MARGIN: f64 = 0.3;

/// Parts of a margin of which copies across a boundary that shears may move by one: a quarter of it is for them, in three parts.
const PARTS_FOR_COPIES: f64 = 4.0 * 3.0;

/// The soft repulsions, friction and noise between all pairs of species.
#[derive(Debug, Clone, PartialEq)]
pub struct PairForce {
    /// The largest range of any pair of species that has a force.
    pub cutoff: f64,
    /// Temperature kT of the bath.
    pub temperature: f64,
    /// The bath of every pair.
    pub bath: Bath,
    /// Margin of a neighbour list beyond the cutoff; without one every step makes a list.
    pub skin: f64,
    /// The repulsion between all pairs that depends on the local density, if there is one.
    pub many_body: Option<ManyBodyForce>,
    species: usize,
    /// Soft repulsions, which add up: tables of all pairs of species, in each of which a pair has at most one.
    repulsions: Vec<Vec<SoftRepulsion>>,
    frictions: Vec<PairFriction>,
}

/// The soft repulsion V = a rc/2 (1 - r/rc)² of a pair of species.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftRepulsion {
    /// Strength a, the force at contact; attraction where it is negative.
    pub strength: f64,
    /// Range rc.
    pub cutoff: f64,
}

/// The friction γ (1 - r/rc)^exponent of a pair of species.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PairFriction {
    coefficient: f64,
    cutoff: f64,
    exponent: f64,
    /// Both are held, and have no bath.
    uncoupled: bool,
}

/// The coefficients of a pair of species in a `dpd` interaction.
#[derive(Debug, Clone, Copy)]
struct Coefficients {
    repulsion: SoftRepulsion,
    friction: f64,
    exponent: f64,
}

impl Coefficients {
    /// A table of all pairs of species.
    fn of_all_pairs(interaction: &DpdInteraction, species: &[Species]) -> Vec<Self> {
        let count = species.len();
        let common = Self {
            repulsion: SoftRepulsion { strength: interaction.repulsion, cutoff: interaction.cutoff },
            friction: interaction.friction,
            exponent: interaction.weight_exponent,
        };
        let mut table = vec![common; count * count];
        for pair in &interaction.pairs {
            let index = |name: &str| species.iter().position(|species| species.name == name);
            let (Some(a), Some(b)) = (index(&pair.between[0]), index(&pair.between[1])) else { continue };
            for own in [a * count + b, b * count + a] {
                let Self { repulsion, friction, exponent } = &mut table[own];
                repulsion.strength = pair.repulsion.unwrap_or(repulsion.strength);
                repulsion.cutoff = pair.cutoff.unwrap_or(repulsion.cutoff);
                *friction = pair.friction.unwrap_or(*friction);
                *exponent = pair.weight_exponent.unwrap_or(*exponent);
            }
        }
        table
    }
}

impl Term for PairForce {
    fn has_potential(&self) -> bool {
        self.is_conservative()
    }

    fn has_memory(&self) -> bool {
        self.remembers()
    }

    fn baths(&self, model: &Model) -> Vec<(BathStep, f64)> {
        let species = model.species.len();
        let steps = (0..species * species).map(|pair| self.bath_step(pair / species, pair % species, model.time_step));
        steps.map(|step| (step, self.temperature)).collect()
    }
}

impl ReferenceTerm for PairForce {
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        if self.remembers() {
            memory_reference::kick(self, moment, kicks);
        } else {
            leapfrog::kick(self, moment, kicks);
        }
    }

    fn observe(&self, sums: &mut Configuration<'_>) {
        leapfrog::observe(self, sums);
    }
}

impl PairForce {
    /// The force between pairs of a scene in a box of some dimensions; none without `dpd` interactions.
    fn of_scene(scene: &Scene, species: &[Species], dimension: usize) -> Option<Self> {
        let interactions: Vec<&DpdInteraction> = scene.pair_interactions().map(|(_, dpd)| dpd).collect();
        Self::new(&interactions, species, scene.temperature, dimension)
    }

    /// The force that `dpd` interactions make together: repulsions add up, and a pair of species has the friction of
    /// the interaction that gives it one. The bath is that of interactions with friction. None without an interaction.
    pub(crate) fn new(
        interactions: &[&DpdInteraction],
        species: &[Species],
        temperature: f64,
        dimension: usize,
    ) -> Option<Self> {
        let first = *interactions.first()?;
        let count = species.len();
        let bathed = interactions.iter().find(|interaction| interaction.has_bath()).unwrap_or(&first);
        let many_body = interactions.iter().find_map(|interaction| interaction.acting_many_body());
        let tables: Vec<Vec<Coefficients>> =
            interactions.iter().map(|interaction| Coefficients::of_all_pairs(interaction, species)).collect();
        let mut repulsions: Vec<Vec<SoftRepulsion>> = Vec::with_capacity(count * count);
        let mut frictions = Vec::with_capacity(count * count);
        for pair in 0..count * count {
            let [one, other] = [&species[pair / count], &species[pair % count]];
            // Held particles do not move each other.
            let (uncoupled, unmoved) = (one.fixed && other.fixed, one.frozen && other.frozen);
            let acting = tables.iter().map(|table| table[pair].repulsion);
            repulsions.push(acting.filter(|own| own.strength != 0.0 && !unmoved).collect());
            let frictional = tables.iter().zip(interactions).find(|(table, own)| own.bath.acts(table[pair].friction));
            let Coefficients { friction, repulsion, exponent } =
                frictional.map_or(&tables[0], |(table, _)| table)[pair];
            let coefficient = if uncoupled { 0.0 } else { friction };
            frictions.push(PairFriction { coefficient, cutoff: repulsion.cutoff, exponent, uncoupled });
        }
        let mut force = Self {
            cutoff: interactions.iter().map(|interaction| interaction.cutoff).fold(0.0, f64::max),
            temperature: bathed.bath.temperature(temperature),
            bath: bathed.bath.clone(),
            skin: interactions.iter().filter_map(|interaction| interaction.skin).reduce(f64::max).unwrap_or(MARGIN),
            many_body: many_body.map(|many_body| ManyBodyForce::new(many_body, dimension)),
            species: count,
            repulsions: Vec::new(),
            frictions,
        };
        force.find_largest_cutoff(&repulsions);
        force.tabulate(&repulsions);
        Some(force)
    }

    /// Finds the largest cutoff of all forces that there are, and gives it to pairs of species without friction, which
    /// need none.
    fn find_largest_cutoff(&mut self, repulsions: &[Vec<SoftRepulsion>]) {
        let has_friction = |friction: &PairFriction| self.bath.acts(friction.coefficient);
        let of_frictions =
            self.frictions.iter().filter(|friction| has_friction(friction)).map(|friction| friction.cutoff);
        let of_repulsions = repulsions.iter().flatten().map(|repulsion| repulsion.cutoff);
        let of_densities = self.many_body.map(|many_body| many_body.cutoff);
        if let Some(largest) = of_frictions.chain(of_repulsions).chain(of_densities).reduce(f64::max) {
            self.cutoff = largest;
        }
        let exponent = self.frictions.iter().find(|friction| has_friction(friction)).map(|friction| friction.exponent);
        for friction in self.frictions.iter_mut().filter(|friction| !self.bath.acts(friction.coefficient)) {
            friction.cutoff = self.cutoff;
            friction.exponent = exponent.unwrap_or(friction.exponent);
        }
    }

    /// As many tables as a pair of species has repulsions, at least one.
    fn tabulate(&mut self, repulsions: &[Vec<SoftRepulsion>]) {
        let tables = repulsions.iter().map(Vec::len).max().unwrap_or(0).max(1);
        let none = SoftRepulsion { strength: 0.0, cutoff: self.cutoff };
        let table = |index: usize| repulsions.iter().map(|own| own.get(index).copied().unwrap_or(none)).collect();
        self.repulsions = (0..tables).map(table).collect();
    }

    /// No force: nothing reaches further than half the shortest edge.
    pub(crate) fn none(units: &crate::state::Units, species: usize) -> Self {
        let cutoff = 0.5 * units.shortest_length();
        let friction = PairFriction { coefficient: 0.0, cutoff, exponent: 2.0, uncoupled: false };
        Self {
            cutoff,
            temperature: 0.0,
            bath: Bath::default(),
            skin: 0.0,
            many_body: None,
            species,
            repulsions: vec![vec![SoftRepulsion { strength: 0.0, cutoff }; species * species]],
            frictions: vec![friction; species * species],
        }
    }

    /// The part of the displacement of boundaries that shear after which a list of neighbours is made again, in 2⁻³² of
    /// the box.
    ///
    /// Listed copies across a boundary go on by that much without their particles. A quarter of the margin is kept for
    /// it, in three parts: pairs move with their copies, and either particle is followed from a copy of where it was.
    pub(crate) fn margin_of_copies(&self, model: &Model) -> u32 {
        let part = self.skin / PARTS_FOR_COPIES / model.units.lengths[0];
        ((part * 4_294_967_296.0) as u32).max(1)
    }

    /// How far a particle may go from where it was listed until neighbours are listed again.
    pub(crate) fn reach_in_list(&self, model: &Model) -> f64 {
        let units_of_length = model.units.lengths[0] / 4_294_967_296.0;
        let moved = 3.0 * f64::from(self.margin_of_copies(model)) * units_of_length;
        let copies = if model.particles().shear.is_some() { moved } else { 0.0 };
        0.5 * (self.skin - copies).max(0.0)
    }

    /// The soft repulsions of two species, whose forces add up; those without strength stand for a pair that has fewer
    /// than another.
    ///
    /// ```
    /// use mesoscope::scene;
    ///
    /// let second = r#"interactions.1={"type":"dpd","repulsion":-10,"cutoff":1.5}"#;
    /// let model = scene::load("dpd-fluid", &[second.to_owned()])?.model().clone();
    /// let force = model.particles().pair_force.as_ref();
    /// let repulsions = force.map(|force| force.repulsions(0, 0).map(|own| [own.strength, own.cutoff]).collect());
    /// assert_eq!(repulsions, Some(vec![[25.0, 1.0], [-10.0, 1.5]]));
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    pub fn repulsions(&self, a: usize, b: usize) -> impl Iterator<Item = SoftRepulsion> {
        let pair = a * self.species + b;
        self.repulsions.iter().map(move |table| table[pair])
    }

    /// The number of soft repulsions that add up between the species that have most; one at least.
    pub(crate) fn repulsion_count(&self) -> usize {
        self.repulsions.len()
    }

    /// Repulsion a between two species, the force at contact.
    #[must_use]
    pub fn repulsion(&self, a: usize, b: usize) -> f64 {
        self.repulsions(a, b).map(|own| own.strength).sum()
    }

    /// Range of the forces between two species, at most [`Self::cutoff`].
    ///
    /// ```
    /// use mesoscope::scene;
    ///
    /// let own = r#"interactions.0.pairs=[{"between":["A","B"],"cutoff":1.5,"weight_exponent":1}]"#;
    /// let model = scene::load("binary-mixture", &[own.to_owned()])?.model().clone();
    /// let force = model.particles().pair_force.as_ref();
    /// let cutoffs = force.map(|force| [force.cutoff_between(0, 0), force.cutoff_between(0, 1), force.cutoff]);
    /// assert_eq!(cutoffs, Some([1.0, 1.5, 1.5]));
    /// let exponents = force.map(|force| [force.weight_exponent(0, 0), force.weight_exponent(0, 1)]);
    /// assert_eq!(exponents, Some([2.0, 1.0]));
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn cutoff_between(&self, a: usize, b: usize) -> f64 {
        let of_friction = self.bath.acts(self.friction(a, b)).then(|| self.friction_cutoff(a, b));
        let acting = self.repulsions(a, b).filter(|own| own.strength != 0.0).map(|own| own.cutoff);
        acting.chain(of_friction).reduce(f64::max).unwrap_or(self.cutoff)
    }

    /// Range of friction and noise between two species.
    pub(crate) fn friction_cutoff(&self, a: usize, b: usize) -> f64 {
        self.frictions[a * self.species + b].cutoff
    }

    /// Exponent of the friction weight ω = (1 - r/rc)^exponent of two species.
    #[must_use]
    pub fn weight_exponent(&self, a: usize, b: usize) -> f64 {
        self.frictions[a * self.species + b].exponent
    }

    /// The exponent of the friction weight that all pairs of species have, if they have one.
    pub(crate) fn common_weight_exponent(&self) -> Option<f64> {
        let first = self.frictions.first().map_or(2.0, |friction| friction.exponent);
        self.frictions.iter().all(|friction| friction.exponent == first).then_some(first)
    }

    /// Volume of the sphere (disc, line) within the range of the forces of two species.
    pub(crate) fn sphere(&self, a: usize, b: usize, dimension: usize) -> f64 {
        ball(self.cutoff_between(a, b), dimension)
    }

    /// The friction weight ω of two species integrated over the sphere within its cutoff.
    pub(crate) fn weight_volume(&self, a: usize, b: usize, dimension: usize) -> f64 {
        let (cutoff, exponent) = (self.friction_cutoff(a, b), self.weight_exponent(a, b));
        match dimension {
            1 => 2.0 * cutoff / (exponent + 1.0),
            2 => 2.0 * PI * cutoff.powi(2) / ((exponent + 1.0) * (exponent + 2.0)),
            _ => 8.0 * PI * cutoff.powi(3) / ((exponent + 1.0) * (exponent + 2.0) * (exponent + 3.0)),
        }
    }

    /// r² times a power of the friction weight ω of two species, integrated over that sphere.
    pub(crate) fn weighted_square(&self, a: usize, b: usize, dimension: usize, power: f64) -> f64 {
        let exponent = power * self.weight_exponent(a, b);
        // The integral of x^(d + 1) (1 - x)^n over 0 to 1.
        let beta = (0..=dimension + 1).fold(1.0 / (exponent + 1.0), |beta, factor| {
            if factor == 0 { beta } else { beta * factor as f64 / (exponent + 1.0 + factor as f64) }
        });
        let cutoff = self.friction_cutoff(a, b);
        dimension as f64 * ball(cutoff, dimension) * cutoff.powi(2) * beta
    }

    /// The mean force constant per axis, times d, by which repulsions of a species at unit density hold a particle of
    /// another: Σ |a| V(rc)/rc.
    pub(crate) fn stiffness(&self, a: usize, b: usize, dimension: usize) -> f64 {
        self.repulsions(a, b).map(|own| own.strength.abs() * ball(own.cutoff, dimension) / own.cutoff).sum()
    }

    /// Friction γ between two species.
    pub(crate) fn friction(&self, a: usize, b: usize) -> f64 {
        self.frictions[a * self.species + b].coefficient
    }

    /// Whether the bath of pairs has a memory, and any effect.
    pub(crate) fn remembers(&self) -> bool {
        matches!(self.bath, Bath::Memory { .. }) && self.has_friction()
    }

    /// The bath step of a pair of species, coupled to φ(r).
    pub(crate) fn bath_step(&self, a: usize, b: usize, time_step: f64) -> BathStep {
        let step = BathStep::of(&self.bath, self.friction(a, b), time_step);
        if self.frictions[a * self.species + b].uncoupled { step.uncoupled() } else { step }
    }

    /// Whether any pair of species has friction, with memory or without.
    pub(crate) fn has_friction(&self) -> bool {
        self.bath.acts(self.largest_friction())
    }

    /// Whether any pair of species has a force at all.
    pub(crate) fn acts(&self) -> bool {
        self.is_conservative() || self.has_friction()
    }

    /// Whether any pair of species has a force that derives from a potential.
    pub(crate) fn is_conservative(&self) -> bool {
        self.largest_repulsion() > 0.0 || self.many_body.is_some()
    }

    /// The largest magnitude of the repulsions between two species.
    #[must_use]
    pub fn largest_repulsion(&self) -> f64 {
        self.pairs().map(|[a, b]| self.repulsions(a, b).map(|own| own.strength.abs()).sum::<f64>()).fold(0.0, f64::max)
    }

    /// Σ |a| rc between two species and what densities add, twice the largest energy of two particles in one place.
    pub(crate) fn energy_between(&self, a: usize, b: usize) -> f64 {
        self.repulsions(a, b).map(|own| own.strength.abs() * own.cutoff).sum::<f64>() + self.many_body_energy()
    }

    /// The largest of it.
    pub(crate) fn largest_energy(&self) -> f64 {
        self.pairs().map(|[a, b]| self.energy_between(a, b)).fold(self.many_body_energy(), f64::max)
    }

    /// The part of it that is due to the many-body repulsion.
    fn many_body_energy(&self) -> f64 {
        self.many_body.as_ref().map_or(0.0, |many_body| 4.0 * many_body.self_energy(many_body.contact_density()))
    }

    /// The largest -Σ a rcᵈ⁺¹ of pairs that attract each other in d dimensions; 0 if none do.
    pub(crate) fn largest_attraction(&self, dimension: usize) -> f64 {
        let of_pair = |[a, b]: [usize; 2]| {
            self.repulsions(a, b).map(|own| -own.strength * own.cutoff.powi(dimension as i32 + 1)).sum::<f64>()
        };
        self.pairs().map(of_pair).fold(0.0, f64::max)
    }

    /// True if the soft repulsions of two species attract more than they repel, in contact or over all distances: many
    /// particles then have the lower an energy the closer they are, as the integral of a stable potential is not
    /// negative (Fisher and Ruelle, J. Math. Phys. 7, 260, 1966).
    pub(crate) fn attract(&self, a: usize, b: usize, dimension: usize) -> bool {
        let sum = |power: usize| -> f64 {
            self.repulsions(a, b).map(|own| own.strength * own.cutoff.powi(power as i32)).sum()
        };
        sum(1) < 0.0 || sum(dimension + 1) < 0.0
    }

    /// The smallest range of any force.
    pub(crate) fn smallest_cutoff(&self) -> f64 {
        let of_repulsions = self.repulsions.iter().flatten().map(|own| own.cutoff);
        of_repulsions.chain(self.frictions.iter().map(|friction| friction.cutoff)).fold(self.cutoff, f64::min)
    }

    /// The largest friction.
    pub(crate) fn largest_friction(&self) -> f64 {
        self.frictions.iter().map(|friction| friction.coefficient).fold(0.0, f64::max)
    }

    /// All pairs of species, in either order.
    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let species = self.species;
        (0..species).flat_map(move |a| (0..species).map(move |b| [a, b]))
    }
}

/// Volume of a sphere (disc, line) of a radius.
fn ball(radius: f64, dimension: usize) -> f64 {
    match dimension {
        1 => 2.0 * radius,
        2 => PI * radius.powi(2),
        _ => 4.0 / 3.0 * PI * radius.powi(3),
    }
}
