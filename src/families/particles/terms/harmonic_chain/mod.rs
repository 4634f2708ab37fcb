//! Harmonic chains side by side in one scene: of beads, of clusters with friction and noise, of clusters without.

mod chain;
mod pulse;
mod scene;
mod thermal_start;

pub use chain::{HarmonicChain, SpringChain};
pub use pulse::{HalfPulse, Pulse, half_pulses};
pub use thermal_start::thermal_start;

use crate::document::{BondPotential, Generator, HarmonicChainInteraction, Interaction, Scene};
use crate::families::{BathStep, BondKind, Bonds, Species};
use crate::noise::{self, stream};
use crate::state::{State, Units};

/// Which chain of a trio.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Likeness {
    /// The chain of beads.
    Micro,
    /// The chain of clusters with friction and noise: dissipative particle dynamics.
    Dissipative,
    /// The chain of clusters without either.
    Frictionless,
}

impl Likeness {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Micro, Self::Dissipative, Self::Frictionless];
}

/// One chain among the particles of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strand {
    /// Its parameters.
    pub chain: SpringChain,
    /// Number of its first bead; the others follow.
    pub first: usize,
    /// Numbers of the fixed beads at its ends.
    pub ends: [usize; 2],
    /// Distance of neighbours at rest. The chain begins at the origin, and goes round the box as often as it has to.
    pub spacing: f64,
    /// Temperature kT.
    pub temperature: f64,
    /// Index of the species of its beads.
    pub species: usize,
}

impl Strand {
    /// Displacements and momenta of the beads among those of all particles, free of where the chain crosses the edges of the box.
    pub(crate) fn motion(&self, positions: &[[u32; 3]], momenta: &[[i32; 3]], units: &Units) -> (Vec<f64>, Vec<f64>) {
        let beads = self.first..self.first + self.chain.beads;
        let mut before = self.ends[0];
        let mut displacement = 0.0;
        let displacements = beads.clone().map(|bead| {
            let apart = units.displacement(positions[bead], positions[before])[0];
            before = bead;
            displacement += apart - self.spacing;
            displacement
        });
        let displacements = displacements.collect();
        (displacements, momenta[beads].iter().map(|momentum| units.momentum(*momentum)[0]).collect())
    }

    /// Places and moves the beads of a state.
    fn set(&self, state: &mut State, units: &Units, displacements: &[f64], momenta: &[f64]) {
        let at = |site: usize, displacement: f64| units.fraction([site as f64 * self.spacing + displacement, 0.0, 0.0]);
        for (index, (displacement, momentum)) in displacements.iter().zip(momenta).enumerate() {
            state.positions[self.first + index] = at(index + 1, *displacement);
            state.momenta[self.first + index][0] = (momentum / units.momentum).round_ties_even() as i32;
        }
        state.positions[self.ends[0]] = at(0, 0.0);
        state.positions[self.ends[1]] = at(self.chain.beads + 1, 0.0);
    }
}

/// Two trios of chains: a pulse without heat, and equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainTrios {
    /// The chains a pulse travels along, at temperature zero.
    pub pulse: HarmonicChain,
    /// Height of the pulse.
    pub amplitude: f64,
    /// Its standard deviation in clusters.
    pub width: f64,
    /// The chains in equilibrium.
    pub thermal: HarmonicChain,
    /// Their temperature kT.
    pub temperature: f64,
    /// Distance of beads at rest.
    pub spacing: f64,
}

/// Names of the species, in the order of their particles: beads, clusters, and the fixed ends.
const SPECIES: [&str; 3] = ["bead", "cluster", "end"];
/// Index of the last of them.
const END: usize = 2;

impl ChainTrios {
    /// Those of a scene, if it is of harmonic chains.
    pub(crate) fn from_scene(scene: &Scene) -> Option<Self> {
        scene.interactions().iter().find_map(|interaction| match interaction {
            Interaction::HarmonicChain(chain) => Some(Self::new(chain, scene)),
            _ => None,
        })
    }

    pub(crate) fn new(interaction: &HarmonicChainInteraction, scene: &Scene) -> Self {
        let chain = |clusters: u32| HarmonicChain {
            clusters: clusters as usize,
            cluster_size: interaction.cluster_size as usize,
            mass: interaction.mass,
            stiffness: interaction.stiffness,
            reduced_friction: interaction.friction,
        };
        Self {
            pulse: chain(interaction.pulse.clusters),
            amplitude: interaction.pulse.amplitude,
            width: interaction.pulse.width,
            thermal: chain(interaction.equilibrium.clusters),
            temperature: scene.temperature,
            spacing: interaction.spacing,
        }
    }

    /// The chains a pulse travels along and those in equilibrium, each in the order of [`Likeness::ALL`].
    pub(crate) fn strands(&self) -> [[Strand; 3]; 2] {
        let [pulse, thermal] =
            [&self.pulse, &self.thermal].map(|trio| [trio.micro(), trio.dissipative(), trio.frictionless()]);
        let chains = [pulse[0], thermal[0], pulse[1], pulse[2], thermal[1], thermal[2]];
        let total: usize = chains.iter().map(|chain| chain.beads).sum();
        let mut first = 0;
        let mut number = 0;
        let strands = chains.map(|chain| {
            let beads_are_clusters = number >= 2;
            let is_thermal = [1, 4, 5].contains(&number);
            let size = if beads_are_clusters { self.pulse.cluster_size as f64 } else { 1.0 };
            let strand = Strand {
                chain,
                first,
                ends: [total + 2 * number, total + 2 * number + 1],
                spacing: size * self.spacing,
                temperature: if is_thermal { self.temperature } else { 0.0 },
                species: usize::from(beads_are_clusters),
            };
            first += chain.beads;
            number += 1;
            strand
        });
        [[strands[0], strands[2], strands[3]], [strands[1], strands[4], strands[5]]]
    }

    /// The species of all chains.
    pub(crate) fn species(&self) -> [Species; 3] {
        let beads = (self.pulse.micro().beads + self.thermal.micro().beads) as u64;
        let clusters = 2 * (self.pulse.clusters + self.thermal.clusters) as u64;
        let species = |kind: usize, mass: f64, count: u64| Species {
            name: SPECIES[kind].to_owned(),
            mass,
            count,
            fixed: kind == END,
            frozen: false,
            charge: 0.0,
        };
        let mass = self.pulse.mass;
        [species(0, mass, beads), species(1, self.pulse.frictionless().mass, clusters), species(2, mass, 12)]
    }

    /// The species of every particle.
    fn species_of_particles(&self) -> Vec<u32> {
        let all = self.species();
        all.iter().zip(0_u32..).flat_map(|(species, kind)| vec![kind; species.count as usize]).collect()
    }

    /// Adds a spring between all neighbours, with a dashpot and its noise where the chain has friction.
    pub(crate) fn add_bonds(&self, bonds: &mut Bonds, time_step: f64) {
        for strand in self.strands().as_flattened() {
            let kind = bonds.kinds.len() as u32;
            let step = BathStep::without_memory(strand.chain.friction, time_step);
            bonds.kinds.push(BondKind {
                potential: Some(BondPotential::Harmonic { stiffness: strand.chain.stiffness, length: strand.spacing }),
                bath: (strand.chain.friction > 0.0).then_some(step),
                temperature: strand.temperature,
                exclude_repulsion: false,
                exclude_charges: false,
            });
            let (ends, first) = (strand.ends.map(|end| end as u32), strand.first as u32);
            let species = [strand.species, END];
            bonds.runs.add_strand(kind, ends, first, strand.chain.beads as u32, species);
        }
    }

    /// A momentum as large as those of the scene.
    pub(crate) fn momentum_scale(&self) -> f64 {
        let cluster = self.pulse.dissipative();
        let pulse = self.amplitude.abs() / self.width * (cluster.mass * cluster.stiffness).sqrt();
        pulse.max((cluster.mass * self.temperature).sqrt())
    }

    /// The particles of all chains at step 0: a pulse at rest, and a draw from equilibrium.
    pub(crate) fn fill(&self, state: &mut State, units: &Units, seed: u64) {
        let total = self.species().iter().map(|species| species.count as usize).sum();
        state.positions = vec![[0; 3]; total];
        state.momenta = vec![[0; 3]; total];
        state.species = self.species_of_particles();
        let [pulse, thermal] = self.strands();
        let shape = Pulse { amplitude: self.amplitude, width: self.width };
        let beads = shape.displacements(&self.pulse);
        let at_rest = vec![0.0; beads.len()];
        let (clusters, still) = self.pulse.coarse_grained(&beads, &at_rest);
        pulse[0].set(state, units, &beads, &at_rest);
        for strand in &pulse[1..] {
            strand.set(state, units, &clusters, &still);
        }
        let key = noise::step_key(seed, stream::CHAIN, 0);
        for (number, strand) in (0_u32..).zip(&thermal) {
            let mut draws = 0;
            let (displacements, momenta) = thermal_start(&strand.chain, strand.temperature, || {
                draws += 1;
                noise::gaussian(noise::words(Generator::Threefry2x32, key, [draws, number]))
            });
            strand.set(state, units, &displacements, &momenta);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHAIN: HarmonicChain =
        HarmonicChain { clusters: 6, cluster_size: 4, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };

    fn trios() -> ChainTrios {
        let thermal = HarmonicChain { clusters: 9, ..CHAIN };
        ChainTrios { pulse: CHAIN, amplitude: 5.0, width: 1.0, thermal, temperature: 1.0, spacing: 16.0 }
    }

    const UNITS: Units =
        Units { dimension: 1, lengths: [300.0, 1.0, 1.0], gaps: [0.0; 3], momentum: 1.0 / 4_194_304.0 };

    #[test]
    fn every_particle_belongs_to_one_chain_and_one_species() {
        let trios = trios();
        let mut state = State::default();
        trios.fill(&mut state, &UNITS, 1);
        let mut met = vec![0; state.len()];
        for strand in trios.strands().as_flattened() {
            for bead in (strand.first..strand.first + strand.chain.beads).chain(strand.ends) {
                met[bead] += 1;
                let species = &trios.species()[state.species[bead] as usize];
                let mass = if species.fixed { 1.0 } else { strand.chain.mass };
                assert_eq!((species.fixed, species.mass), (strand.ends.contains(&bead), mass));
            }
        }
        assert!(met.iter().all(|count| *count == 1));
    }

    /// The chains are longer than the box, so they cross its edges; what comes back is what was put in, to the last unit.
    #[test]
    fn a_pulse_comes_back_out_of_the_integers() {
        let trios = trios();
        let mut state = State::default();
        trios.fill(&mut state, &UNITS, 1);
        let [pulse, thermal] = trios.strands();
        let shape = Pulse { amplitude: 5.0, width: 1.0 };
        let (beads, still) = pulse[0].motion(&state.positions, &state.momenta, &UNITS);
        for (found, expected) in beads.iter().zip(shape.displacements(&CHAIN)) {
            assert!((found - expected).abs() < 1e-7);
        }
        let clusters = CHAIN.coarse_grained(&beads, &still).0;
        for strand in &pulse[1..] {
            let (found, still) = strand.motion(&state.positions, &state.momenta, &UNITS);
            assert!(found.iter().zip(&clusters).all(|(found, expected)| (found - expected).abs() < 1e-6));
            assert!(still.iter().all(|momentum| *momentum == 0.0));
        }
        // Different draws, none of them at rest.
        let momenta = thermal.map(|strand| strand.motion(&state.positions, &state.momenta, &UNITS).1);
        assert!(momenta.iter().flatten().all(|momentum| *momentum != 0.0));
        assert_ne!(momenta[1], momenta[2]);
    }

    #[test]
    fn neighbours_are_bonded_in_order() {
        let trios = trios();
        let mut bonds = Bonds::default();
        trios.add_bonds(&mut bonds, 0.1);
        assert_eq!((bonds.kinds.len(), bonds.count()), (6, 25 + 7 + 7 + 37 + 10 + 10));
        let mut state = State::default();
        trios.fill(&mut state, &UNITS, 1);
        for bond in bonds.iter() {
            let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
            let Some(BondPotential::Harmonic { length, .. }) = bonds.kinds[bond.kind as usize].potential else {
                unreachable!("all are springs")
            };
            // Six standard deviations of a spring of a cluster, and the steepest place of the pulse.
            assert!((UNITS.displacement(b, a)[0] - length).abs() < 12.0);
        }
        let with_friction: Vec<f64> =
            bonds.kinds.iter().filter(|kind| kind.bath.is_some()).map(|kind| kind.temperature).collect();
        assert_eq!(with_friction, [0.0, 1.0]);
    }
}
