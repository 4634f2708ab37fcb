//! How far the relaxation of pairs in split steps puts temperatures and transport off, and the rule that follows where a scene names none.
//!
//! Modes of the velocities that are slow, those of flow, relax by the sum of the frictions of pairs; a pair that relaxes alone in a step has
//! to relax by less than its friction. One stage can only give each pair one strength for both, so that it weakens the friction of a flow
//! and, with the noise of fast modes, cools slow ones; two stages do not, but let particles forget their velocities too fast by a share of
//! Γ dt. The numbers were measured in float64 and on the device: `docs/models/dpd-time-steps.md`.

use super::PairForce;
use crate::document::PairRelaxation;
use crate::families::Model;

/// The part of a temperature, of a viscosity or of a diffusion coefficient by which a step may put it off.
pub(crate) const TOLERANCE: f64 = 0.01;

/// How cold one stage leaves velocities, over the mean friction Γ dt of a step: .09 to .24 in fluids of chains, with repulsion and without.
const COLD: f64 = 0.12;

/// What one stage takes of a temperature at most: a fifth of that of the standard fluid at Γ dt = 21.
const COLDEST: f64 = 0.2;

/// How much faster velocities are kept in kicks of crowds that oscillate by ω dt radians, over the square of it, and how much less
/// positions scatter.
const HOT: f64 = 0.025;
const TIGHT: f64 = 0.018;

/// What the diffusion of two stages lacks over Γ dt: with repulsion, which lets particles go by it as well, and without.
const SLOW: [f64; 2] = [0.11, 0.3];

/// The quadratic term of two stages, b: diffusion lacks up to (1/2 - b) kT dt/m.
const QUADRATIC: f64 = 0.095;

/// The rate of the mean field up to which two stages have the friction of the scene.
const STAGED_RATE: f64 = 1.3;

/// Times that friction may relax velocities over in a step. In one stage the standard fluid ends within ten steps at 125 times; in two it has
/// been measured up to here.
pub(crate) const MOST_RELAXATION: f64 = 250.0;

/// What a step does to equilibrium and transport where pairs relax.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RelaxationErrors {
    /// The rule.
    pub rule: PairRelaxation,
    /// The part of the kinetic temperature that friction and noise take, to first order in the step.
    pub cold: f64,
    /// The part of it that the kicks add.
    pub hot: f64,
    /// The part by which the configurational temperature is too low.
    pub tight: f64,
    /// The part that the friction of a flow lacks.
    pub friction: f64,
    /// The part of that which the viscosity lacks, at most: that of friction by kinetic theory.
    pub viscosity: f64,
    /// What a coefficient of diffusion lacks, at most, as a length² over a time.
    pub diffusion: f64,
    /// The part that it lacks, about.
    pub slow: f64,
}

impl RelaxationErrors {
    /// The part of the kinetic temperature that friction and noise take, which does not go on growing with the step.
    pub(crate) fn missing_temperature(&self) -> f64 {
        self.cold / (1.0 + (self.cold / COLDEST).powi(2)).sqrt()
    }
}

impl Model {
    /// What a step of a scene whose pairs relax does by a rule; none where they do not.
    pub(crate) fn relaxation_errors(&self, rule: PairRelaxation) -> Option<RelaxationErrors> {
        let particles = self.particles();
        let force = particles.pair_force.as_ref().filter(|_| particles.relaxes_pairs())?;
        let (rate, index) = self.largest_friction_rate(force);
        let relaxed = rate * self.time_step;
        let oscillation = self.largest_repulsion_frequency(force).0 * self.time_step;
        let flow = self.flow_relaxation(force, index);
        let staged = rule == PairRelaxation::TwoStages;
        let friction =
            if staged { 1.0 - (STAGED_RATE / flow).min(1.0) } else { 1.0 + (-0.5 * flow).exp_m1() / (0.5 * flow) };
        let mass = self.species[index].mass;
        let only = |of: bool, value: f64| if of { value } else { 0.0 };
        Some(RelaxationErrors {
            rule,
            cold: only(!staged, COLD * relaxed),
            hot: HOT * oscillation.powi(2),
            tight: TIGHT * oscillation.powi(2),
            friction,
            viscosity: friction * self.viscosity_of_friction(force),
            diffusion: only(staged, (0.5 - QUADRATIC) * particles.pair_temperature(self) * self.time_step / mass),
            slow: only(staged, SLOW[usize::from(!force.is_conservative())] * relaxed),
        })
        .filter(|_| relaxed > 0.0)
    }

    /// What a step does by the rule of the scene; none where pairs do not relax.
    pub(crate) fn relaxation(&self) -> Option<RelaxationErrors> {
        let staged = self.particles().relaxes_in_two_stages();
        self.relaxation_errors(if staged { PairRelaxation::TwoStages } else { PairRelaxation::MeanField })
    }

    /// The rule for a scene that names none: one stage, unless it would leave the temperature or a viscosity a hundredth too low.
    pub(crate) fn advisable_relaxation(&self) -> PairRelaxation {
        let Some(one) = self.relaxation_errors(PairRelaxation::MeanField) else { return PairRelaxation::MeanField };
        let force = self.particles().pair_force.as_ref();
        let relaxed = force.map_or(0.0, |force| self.largest_friction_rate(force).0 * self.time_step);
        // What the kicks heat needs no second stage to be warm.
        let suffices = one.cold - one.hot <= TOLERANCE && one.viscosity <= TOLERANCE;
        if suffices || relaxed >= MOST_RELAXATION { PairRelaxation::MeanField } else { PairRelaxation::TwoStages }
    }

    /// The rate s at which pairs relax in a step among all others, which in a flow count with g r²: for those of a species
    /// (Γ + (2 - 1/d) g/m) dt with g = γ ω.
    fn flow_relaxation(&self, force: &PairForce, index: usize) -> f64 {
        let dimension = self.units.dimension;
        let (mut sum, mut squares) = (0.0, 0.0);
        for (other, density) in self.densities(index) {
            let friction = force.friction(index, other);
            sum += friction * density * force.weighted_square(index, other, dimension, 1.0);
            squares += friction.powi(2) * density * force.weighted_square(index, other, dimension, 2.0);
        }
        let own = if sum > 0.0 { squares / sum } else { 0.0 };
        let mass = self.species[index].mass;
        (self.largest_friction_rate(force).0 + (2.0 - 1.0 / dimension as f64) * own / mass) * self.time_step
    }

    /// The part of the viscosity that friction makes, by the kinetic theory of Marsh, Backx and Ernst, doi:10.1103/PhysRevE.56.1676:
    /// Σ γ ρᵢ ρⱼ \[r²ω\]/2d(d + 2), beside Σ ρᵢ kT/2Γᵢ of particles that carry momentum along.
    fn viscosity_of_friction(&self, force: &PairForce) -> f64 {
        let dimension = self.units.dimension;
        let temperature = self.particles().pair_temperature(self);
        let (mut by_friction, mut carried) = (0.0, 0.0);
        for index in 0..self.species.len() {
            let density = self.densities(index).nth(index).map_or(0.0, |(_, density)| density);
            let of_pair = |(other, others): (usize, f64)| {
                force.friction(index, other) * others * force.weighted_square(index, other, dimension, 1.0)
            };
            let divisor = (2 * dimension * (dimension + 2)) as f64;
            by_friction += density * self.densities(index).map(of_pair).sum::<f64>() / divisor;
            let rate = self.friction_rate(force, index);
            carried += if rate > 0.0 { density * temperature / (2.0 * rate) } else { 0.0 };
        }
        if by_friction > 0.0 { by_friction / (by_friction + carried) } else { 0.0 }
    }
}
