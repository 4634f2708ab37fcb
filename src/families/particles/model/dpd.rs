//! Pair forces of dissipative particle dynamics, doi:10.1063/1.474784.

use super::ManyBodyForce;
use crate::document::{Bath, DpdInteraction};
use crate::families::{BathStep, Model, Species};
use std::f64::consts::PI;

/// Soft repulsion, friction and noise between all pairs of species.
#[derive(Debug, Clone, PartialEq)]
pub struct PairForce {
    /// The largest range of any pair of species that has a force.
    pub cutoff: f64,
    /// Temperature kT of the bath.
    pub temperature: f64,
    /// The bath of every pair.
    pub bath: Bath,
    /// Margin of a neighbour list beyond the cutoff.
    pub skin: f64,
    /// The repulsion between all pairs that depends on the local density, if there is one.
    pub many_body: Option<ManyBodyForce>,
    species: usize,
    repulsion: Vec<f64>,
    friction: Vec<f64>,
    /// Pairs of species of which both are held, and have no bath.
    uncoupled: Vec<bool>,
    cutoffs: Vec<f64>,
    exponents: Vec<f64>,
}

impl PairForce {
    pub(crate) fn new(interaction: &DpdInteraction, species: &[Species], temperature: f64, dimension: usize) -> Self {
        let count = species.len();
        let mut force = Self {
            cutoff: interaction.cutoff,
            temperature: interaction.bath.temperature(temperature),
            bath: interaction.bath.clone(),
            skin: interaction.skin,
            many_body: interaction.acting_many_body().map(|many_body| ManyBodyForce::new(many_body, dimension)),
            species: count,
            repulsion: vec![interaction.repulsion; count * count],
            friction: vec![interaction.friction; count * count],
            uncoupled: vec![false; count * count],
            cutoffs: vec![interaction.cutoff; count * count],
            exponents: vec![interaction.weight_exponent; count * count],
        };
        for pair in &interaction.pairs {
            let index = |name: &str| species.iter().position(|species| species.name == name);
            let (Some(a), Some(b)) = (index(&pair.between[0]), index(&pair.between[1])) else { continue };
            for entry in [a * count + b, b * count + a] {
                if let Some(repulsion) = pair.repulsion {
                    force.repulsion[entry] = repulsion;
                }
                if let Some(friction) = pair.friction {
                    force.friction[entry] = friction;
                }
                if let Some(cutoff) = pair.cutoff {
                    force.cutoffs[entry] = cutoff;
                }
                if let Some(exponent) = pair.weight_exponent {
                    force.exponents[entry] = exponent;
                }
            }
        }
        // Held particles do not move each other.
        for pair in 0..count * count {
            let [one, other] = [&species[pair / count], &species[pair % count]];
            if one.fixed && other.fixed {
                (force.friction[pair], force.uncoupled[pair]) = (0.0, true);
            }
            if one.frozen && other.frozen {
                force.repulsion[pair] = 0.0;
            }
        }
        force.unite_what_does_not_act();
        force
    }

    /// Finds the largest cutoff of all forces that there are, and gives it to pairs of species without a force, which need none.
    fn unite_what_does_not_act(&mut self) {
        let acts = |entry: &usize| self.repulsion[*entry] != 0.0 || self.bath.acts(self.friction[*entry]);
        let rubs = |entry: &usize| self.bath.acts(self.friction[*entry]);
        let (acting, still): (Vec<usize>, Vec<usize>) = (0..self.cutoffs.len()).partition(acts);
        let (rubbing, smooth): (Vec<usize>, Vec<usize>) = (0..self.cutoffs.len()).partition(rubs);
        let of_pairs = acting.iter().map(|entry| self.cutoffs[*entry]);
        if let Some(largest) = of_pairs.chain(self.many_body.map(|many_body| many_body.cutoff)).reduce(f64::max) {
            self.cutoff = largest;
            for entry in still {
                self.cutoffs[entry] = largest;
            }
        }
        if let Some(first) = rubbing.first().map(|entry| self.exponents[*entry]) {
            for entry in smooth {
                self.exponents[entry] = first;
            }
        }
    }

    /// No force: nothing reaches further than half the shortest edge.
    pub(crate) fn none(units: &crate::state::Units, species: usize) -> Self {
        let zeros = vec![0.0; species * species];
        Self {
            cutoff: 0.5 * units.shortest_length(),
            temperature: 0.0,
            bath: Bath::default(),
            skin: 0.0,
            many_body: None,
            species,
            repulsion: zeros.clone(),
            friction: zeros,
            uncoupled: vec![false; species * species],
            cutoffs: vec![0.5 * units.shortest_length(); species * species],
            exponents: vec![2.0; species * species],
        }
    }

    /// The part of the displacement of boundaries that shear after which a list of neighbours is made again, in 2⁻³² of
    /// the box.
    ///
    /// Listed copies across a boundary go on by that much without their particles. A quarter of the margin is kept for
    /// it, in three parts: pairs move with their copies, and either particle is followed from a copy of where it was.
    pub(crate) fn margin_of_copies(&self, model: &Model) -> u32 {
        let part = self.skin / (4.0 * 3.0) / model.units.lengths[0];
        ((part * 4_294_967_296.0) as u32).max(1)
    }

    /// How far a particle may go from where it was listed until neighbours are listed again.
    pub(crate) fn reach_in_list(&self, model: &Model) -> f64 {
        let units_of_length = model.units.lengths[0] / 4_294_967_296.0;
        let moved = 3.0 * f64::from(self.margin_of_copies(model)) * units_of_length;
        let copies = if model.particles().shear.is_some() { moved } else { 0.0 };
        0.5 * (self.skin - copies).max(0.0)
    }

    /// Repulsion a between two species.
    #[must_use]
    pub fn repulsion(&self, a: usize, b: usize) -> f64 {
        self.repulsion[a * self.species + b]
    }

    /// Range of the force between two species, at most [`Self::cutoff`].
    ///
    /// ```
    /// use mesoscope::{families::Model, scene};
    ///
    /// let own = r#"interactions.0.pairs=[{"between":["A","B"],"cutoff":1.5,"weight_exponent":1}]"#;
    /// let model = Model::new(&scene::load("binary-mixture", &[own.to_owned()])?);
    /// let force = model.particles().pair_force.as_ref();
    /// let cutoffs = force.map(|force| [force.cutoff_between(0, 0), force.cutoff_between(0, 1), force.cutoff]);
    /// assert_eq!(cutoffs, Some([1.0, 1.5, 1.5]));
    /// let exponents = force.map(|force| [force.weight_exponent(0, 0), force.weight_exponent(0, 1)]);
    /// assert_eq!(exponents, Some([2.0, 1.0]));
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn cutoff_between(&self, a: usize, b: usize) -> f64 {
        self.cutoffs[a * self.species + b]
    }

    /// Exponent of the friction weight ω = (1 - r/rc)^exponent of two species.
    #[must_use]
    pub fn weight_exponent(&self, a: usize, b: usize) -> f64 {
        self.exponents[a * self.species + b]
    }

    /// Whether forces of pairs of species have different ranges.
    #[must_use]
    pub fn cutoffs_differ(&self) -> bool {
        self.cutoffs.iter().any(|cutoff| *cutoff != self.cutoff)
    }

    /// The exponent of the friction weight that all pairs of species have, if they have one.
    #[must_use]
    pub fn common_weight_exponent(&self) -> Option<f64> {
        let first = self.exponents.first().copied().unwrap_or(2.0);
        self.exponents.iter().all(|exponent| *exponent == first).then_some(first)
    }

    /// Volume of the sphere (disc, line) within the cutoff of two species.
    #[must_use]
    pub(crate) fn sphere(&self, a: usize, b: usize, dimension: usize) -> f64 {
        let cutoff = self.cutoff_between(a, b);
        match dimension {
            1 => 2.0 * cutoff,
            2 => PI * cutoff.powi(2),
            _ => 4.0 / 3.0 * PI * cutoff.powi(3),
        }
    }

    /// The friction weight ω of two species integrated over that sphere.
    #[must_use]
    pub(crate) fn weight_volume(&self, a: usize, b: usize, dimension: usize) -> f64 {
        let (cutoff, exponent) = (self.cutoff_between(a, b), self.weight_exponent(a, b));
        match dimension {
            1 => 2.0 * cutoff / (exponent + 1.0),
            2 => 2.0 * PI * cutoff.powi(2) / ((exponent + 1.0) * (exponent + 2.0)),
            _ => 8.0 * PI * cutoff.powi(3) / ((exponent + 1.0) * (exponent + 2.0) * (exponent + 3.0)),
        }
    }

    /// r² times a power of the friction weight ω of two species, integrated over that sphere.
    #[must_use]
    pub(crate) fn weighted_square(&self, a: usize, b: usize, dimension: usize, power: f64) -> f64 {
        let exponent = power * self.weight_exponent(a, b);
        // The integral of x^(d + 1) (1 - x)^n over 0 to 1.
        let beta = (0..=dimension + 1).fold(1.0 / (exponent + 1.0), |beta, factor| {
            if factor == 0 { beta } else { beta * factor as f64 / (exponent + 1.0 + factor as f64) }
        });
        dimension as f64 * self.sphere(a, b, dimension) * self.cutoff_between(a, b).powi(2) * beta
    }

    /// rc |V''| of the conservative force between two species, at most.
    #[must_use]
    pub fn stiffness(&self, a: usize, b: usize) -> f64 {
        self.repulsion(a, b).abs()
    }

    /// Friction γ between two species.
    #[must_use]
    pub fn friction(&self, a: usize, b: usize) -> f64 {
        self.friction[a * self.species + b]
    }

    /// Whether the bath of pairs has a memory, and any effect.
    #[must_use]
    pub fn remembers(&self) -> bool {
        matches!(self.bath, Bath::Memory { .. }) && self.has_friction()
    }

    /// The bath step of a pair of species, coupled to φ(r).
    #[must_use]
    pub fn bath_step(&self, a: usize, b: usize, time_step: f64) -> BathStep {
        let step = BathStep::of(&self.bath, self.friction(a, b), time_step);
        if self.uncoupled[a * self.species + b] { step.uncoupled() } else { step }
    }

    /// Whether any pair of species has friction, with memory or without.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.bath.acts(self.largest_friction())
    }

    /// Whether any pair of species has a force at all.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.is_conservative() || self.has_friction()
    }

    /// Whether any pair of species has a force that derives from a potential.
    #[must_use]
    pub fn is_conservative(&self) -> bool {
        self.largest_repulsion() > 0.0 || self.many_body.is_some()
    }

    /// The largest magnitude of any repulsion.
    #[must_use]
    pub fn largest_repulsion(&self) -> f64 {
        self.repulsion.iter().fold(0.0, |most: f64, a| most.max(a.abs()))
    }

    /// The largest magnitude of a rc, twice the energy of two particles in one place.
    #[must_use]
    pub fn largest_energy(&self) -> f64 {
        let of_pairs =
            self.repulsion.iter().zip(&self.cutoffs).fold(0.0, |most: f64, (a, cutoff)| most.max(a.abs() * cutoff));
        of_pairs + self.many_body_energy()
    }

    /// The part of it that is due to the many-body repulsion.
    pub(crate) fn many_body_energy(&self) -> f64 {
        self.many_body.as_ref().map_or(0.0, |many_body| 4.0 * many_body.self_energy(many_body.contact_density()))
    }

    /// The largest -a rcᵈ⁺¹ of pairs that attract each other in d dimensions; 0 if none do.
    pub(crate) fn largest_attraction(&self, dimension: usize) -> f64 {
        let of_pair = |(a, cutoff): (&f64, &f64)| -a * cutoff.powi(dimension as i32 + 1);
        self.repulsion.iter().zip(&self.cutoffs).map(of_pair).fold(0.0, f64::max)
    }

    /// The smallest range of any pair of species that has a force.
    #[must_use]
    pub fn smallest_cutoff(&self) -> f64 {
        self.cutoffs.iter().fold(self.cutoff, |least: f64, cutoff| least.min(*cutoff))
    }

    /// The largest friction.
    #[must_use]
    pub fn largest_friction(&self) -> f64 {
        self.friction.iter().fold(0.0, |most: f64, a| most.max(*a))
    }
}
