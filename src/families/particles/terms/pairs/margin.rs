//! The margin of a list of neighbours, where a scene states none.
//!
//! With a margin s, whoever makes a list looks at the 3ᵈ cells around each particle, which are as wide as the range rc + s, and
//! every step visits the pairs on it, half a ball of that radius for each particle. Both are as many as (rc + s)ᵈ; the list
//! holds until the fastest of all particles has come half the margin far. Per listed pair and step that costs
//!
//! ```text
//! (1 + s/rc)ᵈ (1 + c/n),        n = s/(2 v dt), at least 1,        v² = (d + 2 ln N) kT/m
//! ```
//!
//! in units of a visit at s = 0, with c the cost of the candidates of a listed pair, each of which is cheaper than that pair. The speeds of N particles in equilibrium
//! have the law of Maxwell: of one v² is d kT/m on average, and the largest of many goes with 2 ln N. Where particles are
//! many or steps long, no margin pays: a list without one is made in every step.

use super::PARTS_FOR_COPIES;
use crate::families::Model;
use std::f64::consts::PI;

/// The cost of a candidate, whose position lies beside that of the last one, where that of a listed pair has to be gathered: with it a
/// margin of .3 is better than .4 for 24 000 particles at a step of .01, as measured.
const CANDIDATE: f64 = 0.75;

/// Margins that are compared, in parts of the cutoff: as fine as the cost, which is flat around its least value, can tell them apart.
const PARTS: u32 = 10;

/// Ways of a step on which it depends how long a list holds, and where it is made.
#[derive(Debug, Clone, Copy)]
struct Motion {
    dimension: usize,
    cutoff: f64,
    /// The way of the fastest particle.
    fastest: f64,
    /// That of copies across boundaries that shear.
    copies: f64,
}

impl Motion {
    /// The margin at which a step costs least: none, where every step had better make a list.
    fn margin(self) -> f64 {
        let margins = (0..=PARTS).map(|tenths| self.cutoff * f64::from(tenths) / f64::from(PARTS));
        let costs = margins.map(|margin| (margin, self.cost(margin)));
        costs.reduce(|least, other| if other.1 < least.1 { other } else { least }).map_or(0.0, |(margin, _)| margin)
    }

    /// The cost of a step.
    fn cost(self, margin: f64) -> f64 {
        let candidates = match self.dimension {
            1 => 3.0,
            2 => 9.0 / (PI / 2.0),
            _ => 27.0 / (2.0 * PI / 3.0),
        };
        let size = (1.0 + margin / self.cutoff).powi(self.dimension as i32);
        size * (1.0 + CANDIDATE * candidates / self.steps(margin))
    }

    /// Steps for which a list holds.
    fn steps(self, margin: f64) -> f64 {
        if margin == 0.0 {
            return 1.0;
        }
        let for_copies = margin / PARTS_FOR_COPIES;
        let for_particles = 0.5 * (margin - if self.copies > 0.0 { 3.0 * for_copies } else { 0.0 });
        let held = |part: f64, way: f64| if way > 0.0 { part / way } else { f64::INFINITY };
        held(for_particles, self.fastest).min(held(for_copies, self.copies)).max(1.0)
    }
}

impl Model {
    /// The margin of the list of neighbours for a scene that states none; `None` where steps make no list.
    pub(crate) fn advisable_margin(&self) -> Option<f64> {
        let particles = self.particles();
        let force = particles.pair_force.as_ref().filter(|_| particles.list_pairs(self))?;
        let mobile = self.species.iter().filter(|species| !species.fixed).map(|species| species.count).sum::<u64>();
        let boundary = particles.shear.map_or(0.0, |shear| shear.velocity.abs());
        // Particles flow along with the boundaries, of which either has half of the velocity.
        let flow = 0.5 * boundary;
        let fastest = fastest_of(mobile, self.units.dimension) * (self.expected_velocity - flow).max(0.0) + flow;
        let motion = Motion {
            dimension: self.units.dimension,
            cutoff: force.cutoff,
            fastest: fastest * self.time_step,
            copies: boundary * self.time_step,
        };
        Some(motion.margin())
    }
}

/// The speed of the fastest of some particles in some dimensions, in units of √(kT/m): in three dimensions within a hundredth of
/// that which one of them has on average, 4.30 of three thousand and 5.53 of a million.
fn fastest_of(particles: u64, dimension: usize) -> f64 {
    (dimension as f64 + 2.0 * (particles.max(1) as f64).ln()).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::{Motion, fastest_of};
    use crate::scene;

    /// The motion of particles with kT/m = 1 and a cutoff of 1 in three dimensions.
    fn motion(particles: u64, speed: f64, time_step: f64) -> Motion {
        Motion { dimension: 3, cutoff: 1.0, fastest: fastest_of(particles, 3) * speed * time_step, copies: 0.0 }
    }

    #[test]
    fn more_particles_have_a_faster_one() {
        let speeds = [1, 2, 100, 3_000, 1_000_000, 1_000_000_000].map(|particles| fastest_of(particles, 3));
        assert!(speeds.is_sorted_by(|slower, faster| slower < faster), "{speeds:?}");
        // One particle has the mean square of Maxwell's law; of n one has on average the speed x with n √(2/π) x exp(-x²/2) = 1.
        assert!((speeds[0] - 3.0_f64.sqrt()).abs() < 1e-12);
        for (particles, speed) in [(3e3, speeds[3]), (1e6, speeds[4]), (1e9, speeds[5])] {
            let mut exact: f64 = 5.0;
            for _ in 0..100 {
                exact = (2.0 * (particles * (2.0 / std::f64::consts::PI).sqrt() * exact).ln()).sqrt();
            }
            assert!((speed / exact - 1.0).abs() < 0.015, "{particles}: {speed}, {exact}");
        }
        assert_eq!(fastest_of(0, 2), fastest_of(1, 2));
    }

    #[test]
    fn the_margin_grows_with_the_way_of_a_step_until_every_step_makes_a_list() {
        let margins: Vec<f64> = (0..400).map(|way| motion(3_000, 1.0, 1e-4 * f64::from(way)).margin()).collect();
        let last = margins.iter().rposition(|margin| *margin > 0.0).unwrap();
        assert!(margins[..=last].is_sorted() && margins[last + 1..].iter().all(|margin| *margin == 0.0), "{margins:?}");
        assert!((100..250).contains(&last) && margins[last] < 0.6, "{last}: {margins:?}");
        // Particles that do not move need a list once, as do steps that take no time.
        assert_eq!((margins[0], motion(1, 0.0, 0.01).margin()), (0.1, 0.1));
        // A huge temperature outruns every margin.
        assert_eq!([motion(3_000, 1e100, 0.01).margin(), motion(1, 1e10, 0.01).margin()], [0.0; 2]);
    }

    #[test]
    fn the_margin_goes_by_the_number_of_particles() {
        let margin = |particles| motion(particles, 1.0, 0.008).margin();
        let margins = [1, 100, 3_000, 24_000, 1_000_000, 1_000_000_000].map(margin);
        assert!(margins.is_sorted() && margins[0] < margins[5], "{margins:?}");
        // At a step of 0.01 many particles outrun any.
        assert_eq!([1, 3_000, 1_000_000_000].map(|particles| motion(particles, 1.0, 0.01).margin()), [0.2, 0.3, 0.0]);
    }

    #[test]
    fn boundaries_that_outrun_their_part_make_a_list_in_every_step() {
        let still = motion(3_000, 1.0, 0.004);
        assert!(still.margin() > 0.0);
        assert_eq!(Motion { copies: 0.05, ..still }.margin(), 0.0);
    }

    #[test]
    fn a_margin_that_a_scene_states_is_kept() {
        let margin = |changes: &[&str]| {
            let changes: Vec<String> = changes.iter().copied().map(str::to_owned).collect();
            let scene = scene::load("edpd-fluid", &changes).unwrap();
            let skin = scene.model().particles().pair_force.as_ref().unwrap().skin;
            let stated = scene.pair_interactions().next().unwrap().1.skin;
            assert_eq!(stated, Some(skin), "the scene has the choice");
            skin
        };
        assert_eq!(margin(&[]), 0.3);
        assert_eq!(margin(&["time.step=0.04"]), 0.0);
        for stated in [0.0, 0.05, 0.3, 0.6] {
            assert_eq!(margin(&[&format!("interactions.0.skin={stated}"), "time.step=0.04"]), stated);
        }
        // Scenes without a list have none.
        let scene = scene::load("dpd-fluid", &[]).unwrap();
        assert_eq!((scene.model().advisable_margin(), scene.pair_interactions().next().unwrap().1.skin), (None, None));
    }
}
