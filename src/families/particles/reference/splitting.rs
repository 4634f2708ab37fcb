//! The splitting A(½) B(½) O B(½) A(½), with friction and noise applied at the half-drifted positions.
//!
//! A drifts, B kicks by the conservative forces of pairs, bonds, angles and tethers and by body forces, O relaxes the
//! momenta of particles in baths of their own, then the velocities along bonds, and last the relative velocities of all
//! pairs along their lines of centres. Its report point is in the middle, just after O, where B and O see the same
//! pairs; what the state keeps is cut just before the closing B: two half drifts make one.
//!
//! ```text
//! p'   = p(n-½) + C(n)           closing kick, C = dt/2 F(r(n))
//! p"   = c p' + √(mkT(1 - c²)) ξ  O of single particles, c = exp(-γdt/m)
//! p(n) = p" + Σ J                O of bonds, one after the other, and of pairs
//! p(n+½) = p(n) + C(n)           opening kick
//! r(n+1) = r(n) + dt p(n+½) / m
//! ```
//! The initial momenta are those of the report point of step 0, so that closing kick and O are left out there.

use super::Reference;
use super::held;
use super::pairs::{self, Forces, Pair, dot};
use super::stress::Virials;
use crate::families::Model;
use crate::families::particles::terms::{bonds, langevin};
use crate::families::reference::add;
use crate::noise::{self, stream};

/// The rule by which O relaxes the velocities of pairs that share particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Relaxation {
    /// Exponential relaxation in the mean field of all pairs that share a particle; the rule of the device unless the scene
    /// names another.
    ///
    /// A pair alone relaxes at the rate g/μ, g = γω dt. All pairs act from the same velocities, so a pair's relative
    /// velocity relaxes at the rate s that its particles feel from all their pairs, those other than itself counted with
    /// the mean projection 1/d of one direction on another:
    /// s = μ (g/μ² + (Γᵢ - g)/(d mᵢ²) + (Γⱼ - g)/(d mⱼ²)), Γᵢ the sum of g over the pairs of i. The impulse is
    /// -g (1 - e⁻ˢ)/s u + √(kT g (1 - e⁻²ˢ)/s) ζ: for a pair alone the exact solution.
    #[default]
    MeanField,
    /// Two stages with the same noise, each with friction and noise of all pairs from the same momenta; the other rule of the
    /// device.
    ///
    /// With H the matrix of the frictions c of all pairs and N their noise, of covariance 2kT H, one stage after the other is
    /// p' = (1 - H + bH²) p + (1 - (1 + 2b)H/4) N. With b = (√2 - 1)²/2 it would leave a mode of eigenvalue h hot by a share of
    /// b²h³/2 that grows; b = .095 leaves it within 1.1 % up to h = 2. Slow modes, those of flow, relax by the friction itself: a pair
    /// has c = g up to a rate s of the mean field of 1.3, and beyond, where steps are stable so, 1.3 g/s.
    TwoStages,
    /// Each pair by the exact solution for that pair alone, all from the same momenta.
    Exponential,
    /// The implicit midpoint rule for all pairs at once, by fixed-point iteration from the explicit rule.
    Midpoint {
        /// Number of corrections; none is the explicit rule.
        corrections: u32,
    },
}

/// O: momenta relax, first those of particles, then along bonds, then of pairs, whose virials over the time of a step
/// are added.
pub(super) fn relax(reference: &Reference, found: &[Pair], momenta: &mut [[i64; 3]], virials: &mut Virials) {
    let (model, state) = (&reference.model, &reference.state);
    langevin::reference::relax(model, state, &reference.masses, momenta);
    bonds::reference::relax(model, state, &reference.masses, momenta, virials);
    if model.particles().relaxes_pairs() {
        // Friction sees held particles with the velocity that they keep, whatever a wall is to absorb.
        let mut seen = momenta.to_vec();
        held::hold(model, state, &mut seen);
        let impulses = relax_pairs(reference, found, &seen, virials);
        add(momenta, &impulses);
    }
}

/// The sums of the impulses of O, whose virials over the time of a step are added.
fn relax_pairs(reference: &Reference, found: &[Pair], momenta: &[[i64; 3]], virials: &mut Virials) -> Vec<[i64; 3]> {
    let (model, state) = (&reference.model, &reference.state);
    let key = noise::step_key(model.seed, stream::PAIR, model.clock(state.step));
    let couplings: Vec<_> = found
        .iter()
        .map(|pair| {
            let forces = Forces::between(model, &state.species, pair);
            let rate = forces.friction * forces.weight * forces.weight;
            let noise = if rate > 0.0 && model.particles().pair_temperature(model) > 0.0 {
                pairs::noise(model, key, pair)
            } else {
                0.0
            };
            (rate, noise)
        })
        .collect();
    let mut fields = vec![0.0; state.len()];
    for (pair, &(rate, _)) in found.iter().zip(&couplings) {
        fields[pair.first] += rate * model.time_step;
        fields[pair.second] += rate * model.time_step;
    }
    let corrections = match reference.relaxation {
        Relaxation::TwoStages => return two_stages(reference, found, momenta, (&couplings, &fields), virials),
        Relaxation::MeanField | Relaxation::Exponential => 0,
        Relaxation::Midpoint { corrections } => corrections,
    };
    let mut seen = momenta.to_vec();
    let mut correction = 0;
    loop {
        let mut sums = vec![[0; 3]; state.len()];
        for (pair, &(rate, noise)) in found.iter().zip(&couplings) {
            let approach = dot(pair.direction(), reference.relative_velocity(&seen, pair));
            let reduced_mass = reduced_mass(reference, pair);
            let impulse = if reference.relaxation == Relaxation::MeanField {
                let own = rate * model.time_step;
                let among = rate_among_others(reference, &fields, pair, own);
                mean_field_relaxation(model.particles().pair_temperature(model), own, among, approach, noise)
            } else {
                pair_relaxation(reference.relaxation, model, rate, reduced_mass, approach, noise)
            };
            pairs::exchange(
                &mut sums,
                pair,
                pair.direction().map(|component| impulse * component),
                model.units.momentum,
            );
            if correction == corrections {
                virials.add(pair, 0.0, impulse / model.time_step);
            }
        }
        if correction == corrections {
            return sums;
        }
        correction += 1;
        for (seen, (momentum, sum)) in seen.iter_mut().zip(momenta.iter().zip(&sums)) {
            for axis in 0..3 {
                seen[axis] = momentum[axis] + (sum[axis] as f64 / 2.0).round_ties_even() as i64;
            }
        }
        held::hold(model, state, &mut seen);
    }
}

/// [`Relaxation::TwoStages`]: both stages from the same frictions and the same noise, the second from the momenta after the first.
fn two_stages(
    reference: &Reference,
    found: &[Pair],
    momenta: &[[i64; 3]],
    (couplings, fields): (&[(f64, f64)], &[f64]),
    virials: &mut Virials,
) -> Vec<[i64; 3]> {
    let model = &reference.model;
    let temperature = model.particles().pair_temperature(model);
    let (curvature, most) = (0.095_f64, 1.3_f64);
    // (1 - first h)(1 - second h) = 1 - h + bh², and both stages together have the noise of the whole step.
    let discriminant = (1.0 - 4.0 * curvature).sqrt();
    let (first, second) = (0.5 - 0.5 * discriminant, 0.5 + 0.5 * discriminant);
    let first_noise = (0.25 + 0.5 * curvature) / second;
    let mut sums = vec![[0; 3]; momenta.len()];
    for [friction, noise] in [[first, first_noise], [second, 1.0 - first_noise]] {
        let mut seen = momenta.to_vec();
        add(&mut seen, &sums);
        held::hold(model, &reference.state, &mut seen);
        for (pair, &(rate, random)) in found.iter().zip(couplings) {
            let own = rate * model.time_step;
            let among = rate_among_others(reference, fields, pair, own);
            if among == 0.0 {
                continue;
            }
            let strength = if among > most { own * most / among } else { own };
            let approach = dot(pair.direction(), reference.relative_velocity(&seen, pair));
            let impulse = -friction * strength * approach + noise * (2.0 * temperature * strength).sqrt() * random;
            let impulses = pair.direction().map(|component| impulse * component);
            pairs::exchange(&mut sums, pair, impulses, model.units.momentum);
            virials.add(pair, 0.0, impulse / model.time_step);
        }
    }
    sums
}

/// 1/mᵢ, which is none of what no impulse moves.
fn inverse_mass(reference: &Reference, particle: usize) -> f64 {
    if held::is_held(&reference.model, &reference.state, particle) { 0.0 } else { 1.0 / reference.masses[particle] }
}

/// 1 / (1/mᵢ + 1/mⱼ).
fn reduced_mass(reference: &Reference, pair: &Pair) -> f64 {
    1.0 / (inverse_mass(reference, pair.first) + inverse_mass(reference, pair.second))
}

/// The rate s in a step at which the relative velocity of a pair with g = `own` relaxes among all pairs, from the sums of g of
/// each particle.
fn rate_among_others(reference: &Reference, fields: &[f64], pair: &Pair, own: f64) -> f64 {
    let inverse = [pair.first, pair.second].map(|end| inverse_mass(reference, end));
    if inverse == [0.0; 2] {
        return 0.0;
    }
    let reduced_mass = reduced_mass(reference, pair);
    let others = (fields[pair.first] - own) * inverse[0].powi(2) + (fields[pair.second] - own) * inverse[1].powi(2);
    reduced_mass * (own / reduced_mass.powi(2) + others / reference.model.units.dimension as f64)
}

/// The impulse along e of a pair with g = `own` that relaxes at the rate s = `among` with all others.
fn mean_field_relaxation(temperature: f64, own: f64, among: f64, approach: f64, noise: f64) -> f64 {
    if among == 0.0 {
        return 0.0;
    }
    let relaxed = -(-among).exp_m1() / among;
    let spread = -(-2.0 * among).exp_m1() / among;
    -own * relaxed * approach + (temperature * own * spread).sqrt() * noise
}

/// The impulse along e that a pair with friction `rate` = γω gets from its velocity of approach u = e·(vᵢ - vⱼ) and
/// its noise ζ.
fn pair_relaxation(rule: Relaxation, model: &Model, rate: f64, reduced_mass: f64, approach: f64, noise: f64) -> f64 {
    match rule {
        _ if rate == 0.0 => 0.0,
        Relaxation::Exponential => {
            // u relaxes to the Maxwell distribution of width √(kT/μ) at the rate γω/μ.
            let exponent = rate * model.time_step / reduced_mass;
            let decay = -(-exponent).exp_m1();
            let spread =
                (model.particles().pair_temperature(model) / reduced_mass * -(-2.0 * exponent).exp_m1()).sqrt();
            reduced_mass * (-decay * approach + spread * noise)
        }
        Relaxation::MeanField | Relaxation::TwoStages | Relaxation::Midpoint { .. } => {
            let amplitude = (2.0 * rate * model.particles().pair_temperature(model) * model.time_step).sqrt();
            -rate * model.time_step * approach + amplitude * noise
        }
    }
}
