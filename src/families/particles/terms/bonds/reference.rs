//! Bonds in float64.

use super::Bonds;
use crate::document::BondPotential;
use crate::families::particles::reference::{
    Configuration, Images, Kicks, Moment, Pair, Potential, Virials, dot, exchange, held,
};
use crate::families::particles::terms::ReferenceTerm;
use crate::families::reference::{Unstable, bath};
use crate::families::{Bond, Model};
use crate::noise::{self, stream};
use crate::state::State;

/// The ends of a bond where they are.
fn span(images: &Images<'_>, bond: &Bond, positions: &[[u32; 3]]) -> Pair {
    let [first, second] = bond.ends.map(|end| end as usize);
    Pair::of(images, positions, first, second)
}

impl Bonds {
    fn potential_at(&self, potential: Option<&BondPotential>, distance: f64) -> Option<Potential> {
        match self.largest_force {
            Some(force) => Some(Potential::of_limited_bond(potential, force, distance)),
            None => Potential::of_bond(potential, distance),
        }
    }
}

impl ReferenceTerm for Bonds {
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        let (model, state, motion) = (moment.model, moment.state, &moment.motion);
        let key = noise::step_key(model.seed, stream::BOND, model.clock(state.step));
        let mut baths = state.bond_baths.clone();
        for (index, bond) in self.iter().enumerate() {
            let kind = &self.kinds[bond.kind as usize];
            let pair = span(&moment.images, &bond, &state.positions);
            let Some(potential) = self.potential_at(kind.potential.as_ref(), pair.distance) else {
                kicks.failure = Some(Unstable::Bond { step: state.step, bond: index });
                return;
            };
            let mut friction = 0.0;
            // Where steps are split, velocities along bonds relax in O.
            if let Some(step) = kind.bath.as_ref().filter(|_| !model.particles().relaxes_bonds()) {
                let gaussian = noise::gaussian(noise::words(model.generator, key, [index as u32, 0]));
                let change = if step.remembers() {
                    motion.change_of_distance(&pair)
                } else {
                    motion.approach(&pair).unwrap_or_else(|| motion.drift_of_distance(&pair))
                };
                let kept = baths.get_mut(index);
                let value = bath::at_report(step, kind.temperature, model.clock(state.step), kept, change, gaussian);
                kicks.bath_sums.add(step, value);
                friction = -value;
            }
            kicks.push_apart(model, &pair, potential.force(), friction);
        }
        kicks.baths.bond_baths = baths;
    }

    fn observe(&self, sums: &mut Configuration<'_>) {
        for bond in self.iter() {
            let pair = span(sums.images, &bond, &sums.state.positions);
            let potential = self.kinds[bond.kind as usize].potential.as_ref();
            if let Some(potential) = self.potential_at(potential, pair.distance) {
                sums.add(&pair, &potential);
            }
        }
    }
}

/// Friction and noise along bonds, in rounds of bonds that share no particle. The velocity u along a bond of reduced
/// mass μ is an Ornstein-Uhlenbeck process, u' = c u + √(kT(1 - c²)/μ) ξ with c = exp(-γdt/μ), and the ends get ±μ(u' -
/// u).
pub(crate) fn relax(model: &Model, state: &State, masses: &[f64], momenta: &mut [[i64; 3]], virials: &mut Virials) {
    let Some(bonds) = model.particles().bonds.as_ref().filter(|_| model.particles().relaxes_bonds()) else {
        return;
    };
    let images = Images::of_step(model, state.step);
    let key = noise::step_key(model.seed, stream::BOND, model.clock(state.step));
    for (place, bond) in bonds.rounds().into_iter().flatten() {
        let kind = &bonds.kinds[bond.kind as usize];
        let Some(bath) = &kind.bath else { continue };
        let pair = span(&images, &bond, &state.positions);
        let [first, second] = [pair.first, pair.second]
            .map(|end| momenta[end].map(|units| units as f64 * model.units.momentum / masses[end]));
        let mut relative: [f64; 3] = std::array::from_fn(|axis| first[axis] - second[axis]);
        relative[0] -= pair.boxes_up as f64 * model.particles().shear.as_ref().map_or(0.0, |shear| shear.velocity);
        let velocity = dot(pair.direction(), relative);
        let inverse_mass = |end: usize| if held::is_held(model, state, end) { 0.0 } else { 1.0 / masses[end] };
        let reduced_mass = 1.0 / (inverse_mass(pair.first) + inverse_mass(pair.second));
        // Two held ends have no motion to relax.
        if reduced_mass.is_infinite() {
            continue;
        }
        let friction = 0.5 * model.time_step * bath.coupling;
        let kept = (-friction * model.time_step / reduced_mass).exp();
        let gaussian = noise::gaussian(noise::words(model.generator, key, [place, 0]));
        let after = kept * velocity + (kind.temperature * (1.0 - kept * kept) / reduced_mass).sqrt() * gaussian;
        let impulse = reduced_mass * (after - velocity);
        let impulses = pair.direction().map(|component| impulse * component);
        exchange(momenta, &pair, impulses, model.units.momentum);
        for end in [pair.first, pair.second].into_iter().filter(|end| held::is_held(model, state, *end)) {
            momenta[end] = state.momenta[end].map(i64::from);
        }
        virials.add(&pair, 0.0, impulse / model.time_step);
    }
}

/// The pairs whose repulsion bonds exclude, smaller number first, in order.
pub(crate) fn excluded_pairs(model: &Model) -> Vec<[u32; 2]> {
    let Some(bonds) = model.particles().bonds.as_ref() else { return Vec::new() };
    let excluding = bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_repulsion);
    let mut excluded: Vec<_> =
        excluding.map(|bond| [bond.ends[0].min(bond.ends[1]), bond.ends[0].max(bond.ends[1])]).collect();
    excluded.sort_unstable();
    excluded
}
