//! The normal modes of networks of springs without a length.

use super::model::{Neighbours, bonded_particles};
use crate::document::BondPotential;
use crate::families::{Bond, BondKind, Bonds};
use nalgebra::DMatrix;
use std::collections::HashMap;

/// Bonds that are looked at.
const MOST_BONDS: u64 = 1_000_000;

/// Particles of one network: the work of its modes grows with the third power.
const LARGEST_NETWORK: usize = 256;

/// Bonds of a network, between places among its particles, and their kinds.
type Shape = Vec<([usize; 2], u32)>;

/// Stiffnesses of all modes of so many particles, with how many modes have them; one particle has one mode along each axis. None
/// where bonds are no springs without a length, have baths of their own, or join too many particles.
pub(super) fn stiffnesses(bonds: &Bonds, particles: u64) -> Option<Vec<(f64, u64)>> {
    let spring = |kind: &BondKind| match kind.potential {
        Some(BondPotential::Harmonic { stiffness, length: 0.0 }) if kind.bath.is_none() => Some(stiffness),
        _ => None,
    };
    let springs: Vec<f64> = bonds.kinds.iter().map(spring).collect::<Option<_>>()?;
    if bonds.count() > MOST_BONDS {
        return None;
    }
    let bonded: Vec<Bond> = bonds.iter().collect();
    let members = bonded_particles(&bonded);
    let place = |end: u32| members.partition_point(|member| *member < end);
    let joins = bonded.iter().map(|bond| bond.ends.map(|end| place(end) as u32));
    let neighbours = Neighbours::new(joins, members.len() as u32);
    let mut is_known = vec![false; members.len()];
    // The network of each particle that has bonds, and its place there.
    let mut networks = vec![(0, 0); members.len()];
    let mut sizes = Vec::new();
    for particle in 0..members.len() {
        if is_known[particle] {
            continue;
        }
        let mut network = neighbours.joined(particle as u32, &mut is_known);
        network.sort_unstable();
        for (at, member) in network.iter().enumerate() {
            networks[*member as usize] = (sizes.len(), at);
        }
        sizes.push(network.len());
    }
    if sizes.iter().any(|size| *size > LARGEST_NETWORK) {
        return None;
    }
    let mut shapes: Vec<Shape> = vec![Vec::new(); sizes.len()];
    for bond in &bonded {
        let ends = bond.ends.map(|end| networks[place(end)]);
        shapes[ends[0].0].push((ends.map(|(_, at)| at), bond.kind));
    }
    // Networks alike in the order of their particles have the same modes.
    let mut alike: HashMap<Shape, (usize, u64)> = HashMap::new();
    for (shape, size) in shapes.into_iter().zip(&sizes) {
        alike.entry(shape).or_insert((*size, 0)).1 += 1;
    }
    let mut modes = vec![(0.0, particles.checked_sub(members.len() as u64)?)];
    for (shape, (size, copies)) in alike {
        let mut matrix = DMatrix::<f64>::zeros(size, size);
        for ([a, b], kind) in shape {
            let spring = springs[kind as usize];
            matrix[(a, a)] += spring;
            matrix[(b, b)] += spring;
            matrix[(a, b)] -= spring;
            matrix[(b, a)] -= spring;
        }
        let mut found: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
        found.sort_by(f64::total_cmp);
        // The network as a whole is held by nothing.
        found[0] = 0.0;
        modes.extend(found.into_iter().map(|stiffness| (stiffness, copies)));
    }
    modes.retain(|(_, count)| *count > 0);
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(modes)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::scene;
    use std::f64::consts::PI;

    fn modes(potential: &str, pairs: &str) -> Option<Vec<(f64, u64)>> {
        let bonds = format!(r#"{{"type":"bonds","potential":{potential},"pairs":{pairs}}}"#);
        let set = [
            r#"particles=[{"species":"bead","count":12}]"#.to_owned(),
            format!(r#"interactions=[{{"type":"langevin","friction":1}},{bonds}]"#),
        ];
        let model = scene::load("gle-oscillator", &set).unwrap().model().clone();
        super::stiffnesses(model.particles().bonds.as_ref().unwrap(), 12)
    }

    /// Chains have 2K (1 - cos πk/n), as everybody knows since Rouse; what is not bonded has none.
    #[test]
    fn modes_of_chains_are_those_of_rouse() {
        let found = modes(r#"{"type":"harmonic","stiffness":2}"#, "[[0,1],[1,2],[2,3],[6,7],[7,8],[8,9]]").unwrap();
        let expected = [0, 1, 2, 3].map(|mode| 4.0 * (1.0 - (PI * f64::from(mode) / 4.0).cos()));
        assert_eq!(found.len(), 5);
        assert_eq!(found[..2], [(0.0, 4), (0.0, 2)]);
        for (found, expected) in found[2..].iter().zip(&expected[1..]) {
            assert!((found.0 - expected).abs() < 1e-12 && found.1 == 2, "{found:?} {expected}");
        }
    }

    #[test]
    fn springs_with_a_length_have_no_modes_that_stay() {
        for other in
            [r#"{"type":"harmonic","stiffness":2,"length":1}"#, r#"{"type":"fene","stiffness":2,"extent":100}"#]
        {
            assert_eq!(modes(other, "[[0,1]]"), None);
        }
    }
}
