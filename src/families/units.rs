//! The unit of integer momenta.

use super::particles::model::forces;
use super::particles::terms;
use super::{PairForce, Species, speeds};
use crate::document::Scene;

/// A momentum that forces make this many times larger than motion from elsewhere is the one that integers have to hold: they
/// have room for 64 of the scale that their unit follows, rounded up to a power of two, and heat and neighbours add to it.
const RULED_BY_FORCES: f64 = 48.0;
/// Part of the largest momentum that forces are expected to make which the unit then follows.
const PART_OF_LARGEST: f64 = 0.125;
/// Times that the momenta of the lightest particles may be smaller than the scale that the unit follows: of its 2²⁴ units they have
/// 2¹² then.
const RESOLVED: f64 = 4096.0;

/// A power of two near 2 to the minus `bits` of the largest momentum a species has for a reason: thermal, that of its
/// fastest listed particle or of one that a coloured noise has pushed, or, in a scene without any of these, that of a
/// particle that has rolled down the repulsion. Where forces make momenta far beyond, as in a cold scene, it follows those.
pub(super) fn momentum_unit(scene: &Scene, species: &[Species], pair_force: Option<&PairForce>, bits: f64) -> f64 {
    let heaviest = species.iter().map(|species| species.mass).fold(0.0, f64::max);
    let hottest = speeds::hottest(scene).max(scene.temperature);
    let own = terms::acting(scene).map(|term| term.momentum_of_particles(scene)).fold(0.0, f64::max);
    let shear = scene.space.shear.as_ref().map_or(0.0, |shear| shear.speed(&scene.space.lengths));
    let given = scene.particles.iter().map(|group| group.mass * speeds::given(scene, group).unwrap_or(0.0));
    let driven = given.fold(heaviest * speeds::of_walls(scene).max(shear), f64::max);
    let random = terms::random_momenta(scene)[0];
    let mut scale = (heaviest * hottest).sqrt().max(own).max(driven / 8.0).max(random);
    if scale == 0.0
        && let Some(force) = pair_force
    {
        scale = (heaviest * force.largest_energy()).sqrt();
    }
    let lightest = species.iter().map(|species| species.mass).fold(f64::INFINITY, f64::min).min(heaviest);
    let [mut forced, of_lightest] =
        [f64::INFINITY, lightest].map(|heaviest| forces::momentum(scene, species, pair_force, heaviest));
    // A unit for what forces make of a particle that is heavier by far could not resolve a light one.
    if forced > of_lightest * RESOLVED / PART_OF_LARGEST {
        forced = of_lightest;
    }
    if scale == 0.0 {
        // The impulses of weak forces in one step would be lost in rounding.
        scale = if forced > 0.0 && forced < 1.0 / 16.0 { forced } else { 1.0 };
    }
    if forced > RULED_BY_FORCES * scale.log2().ceil().exp2() {
        scale = PART_OF_LARGEST * forced;
    }
    (scale.log2().ceil() - bits).exp2()
}
