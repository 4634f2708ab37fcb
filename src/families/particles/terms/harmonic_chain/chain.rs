//! The harmonic chain and its coarse-grained likenesses: Español 1996, doi:10.1103/PhysRevE.53.1572.

/// Beads in a row, joined by springs and dashpots, between two fixed ends.
///
/// With x the displacements from the places at rest and A the Rouse matrix (2 on the diagonal, -1 next to it; the paper's
/// equation (4) prints +1),
///
/// dx = p/m dt, dp = -κ A x dt - (γ/m) A p dt + √(2kTγ) (dW on the right - dW on the left).
///
/// The noise of equation (47), √(kTγ), would leave the chain at half the temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringChain {
    /// Number N of beads that move.
    pub beads: usize,
    /// Mass m of a bead.
    pub mass: f64,
    /// Stiffness κ of a spring; there are N + 1.
    pub stiffness: f64,
    /// Friction γ of the dashpot parallel to each spring.
    pub friction: f64,
}

impl SpringChain {
    /// √(κ/m).
    pub(crate) fn frequency(&self) -> f64 {
        (self.stiffness / self.mass).sqrt()
    }

    /// Kinetic and potential energy of displacements and momenta, one each a bead.
    #[must_use]
    pub fn energy(&self, displacements: &[f64], momenta: &[f64]) -> f64 {
        let kinetic: f64 = momenta.iter().map(|momentum| momentum * momentum).sum::<f64>() / (2.0 * self.mass);
        let mut left = 0.0;
        let mut squares = 0.0;
        for displacement in displacements.iter().copied().chain([0.0]) {
            squares += (displacement - left) * (displacement - left);
            left = displacement;
        }
        kinetic + 0.5 * self.stiffness * squares
    }
}

/// A chain of single beads, of which every n make a cluster, and the two chains of clusters that are to move as it does.
///
/// ```
/// use mesoscope::families::HarmonicChain;
///
/// let chain = HarmonicChain { clusters: 2, cluster_size: 3, mass: 1.0, stiffness: 6.0, reduced_friction: 0.5 };
/// assert_eq!((chain.micro().beads, chain.frictionless().mass, chain.frictionless().stiffness), (6, 3.0, 2.0));
/// // The mean displacement and the total momentum of each cluster.
/// let found = chain.coarse_grained(&[0.0, 1.0, 2.0, 0.0, 0.0, 3.0], &[1.0, 1.0, 1.0, -2.0, 0.0, 2.0]);
/// assert_eq!(found, (vec![1.0, 1.0], vec![3.0, 0.0]));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicChain {
    /// Number N' of clusters.
    pub clusters: usize,
    /// Number n of beads in a cluster.
    pub cluster_size: usize,
    /// Mass m of a bead.
    pub mass: f64,
    /// Stiffness κ of the springs between beads.
    pub stiffness: f64,
    /// γ* = γ/√(mκ), the friction between clusters in units of the beads; exactly ½ for large clusters.
    pub reduced_friction: f64,
}

impl HarmonicChain {
    /// The chain of beads.
    #[must_use]
    pub fn micro(&self) -> SpringChain {
        let beads = self.clusters * self.cluster_size;
        SpringChain { beads, mass: self.mass, stiffness: self.stiffness, friction: 0.0 }
    }

    /// The chain of clusters with friction and noise, of mass nm, stiffness κ/n and friction γ*√(mκ): equation (45).
    #[must_use]
    pub fn dissipative(&self) -> SpringChain {
        let friction = self.reduced_friction * (self.mass * self.stiffness).sqrt();
        SpringChain { friction, ..self.frictionless() }
    }

    /// The chain of clusters without either.
    #[must_use]
    pub fn frictionless(&self) -> SpringChain {
        let size = self.cluster_size as f64;
        SpringChain { beads: self.clusters, mass: size * self.mass, stiffness: self.stiffness / size, friction: 0.0 }
    }

    /// n/ω₀, in which a pulse travels from one cluster to the next: the unit of the reduced time τ = ω₀t/n.
    #[must_use]
    pub fn cluster_time(&self) -> f64 {
        self.cluster_size as f64 / self.micro().frequency()
    }

    /// The mean displacement X and the total momentum P of every cluster: equation (6).
    #[must_use]
    pub fn coarse_grained(&self, displacements: &[f64], momenta: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let sums = |values: &[f64]| -> Vec<f64> {
            values.chunks_exact(self.cluster_size.max(1)).map(|cluster| cluster.iter().sum()).collect()
        };
        let means = sums(displacements).into_iter().map(|sum| sum / self.cluster_size as f64).collect();
        (means, sums(momenta))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAIN: HarmonicChain =
        HarmonicChain { clusters: 5, cluster_size: 4, mass: 2.0, stiffness: 3.0, reduced_friction: 0.5 };

    /// κ/n over nm is (ω₀/n)²: sound is as fast in clusters as in beads.
    #[test]
    fn clusters_weigh_as_much_and_carry_sound_as_fast_as_their_beads() {
        let [micro, dissipative, frictionless] = [CHAIN.micro(), CHAIN.dissipative(), CHAIN.frictionless()];
        assert_eq!(micro.beads as f64 * micro.mass, dissipative.beads as f64 * dissipative.mass);
        assert!((frictionless.frequency() * CHAIN.cluster_time() - 1.0).abs() < 1e-15);
        assert_eq!((micro.friction, frictionless.friction), (0.0, 0.0));
        assert!((dissipative.friction - 0.5 * 6.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn momenta_add_up_and_displacements_are_averaged() {
        let displacements: Vec<f64> = (0..20).map(f64::from).collect();
        let (means, sums) = CHAIN.coarse_grained(&displacements, &displacements);
        assert_eq!(means, [1.5, 5.5, 9.5, 13.5, 17.5]);
        assert_eq!(sums, [6.0, 22.0, 38.0, 54.0, 70.0]);
    }

    /// One bead out by 1 between two springs, and moving.
    #[test]
    fn the_ends_pull() {
        let one = SpringChain { beads: 1, mass: 2.0, stiffness: 3.0, friction: 0.0 };
        assert_eq!(one.energy(&[1.0], &[2.0]), 3.0 + 1.0);
        let two = SpringChain { beads: 2, ..one };
        assert_eq!(two.energy(&[1.0, -1.0], &[0.0, 0.0]), 1.5 * (1.0 + 4.0 + 1.0));
    }
}
