//! Where the beads of chains start.

use std::f64::consts::{PI, TAU};

use crate::document::{Chain, Generator, ParticleGroup};
use crate::families::Model;
use crate::families::start::lattice_sites;
use crate::noise::{self, stream};
use crate::state::State;

/// Appends the positions of a group of chains.
///
/// `random`: an open chain is a random walk of steps of `spacing`, a closed one a regular polygon of that side in a random
/// orientation, each from a bead at a random place. `lattice`: chains are laid out along the first axis, or folded
/// where they are longer than the box, in cells of a lattice that are as elongated as the chains; `shift` moves it by
/// this fraction of its spacing. On a line, a closed chain goes out and back, or round the box if it fits exactly. Walls reflect what would lie
/// beyond them.
pub(crate) fn place(state: &mut State, group: &ParticleGroup, chain: &Chain, count: usize, model: &Model, shift: f64) {
    let beads = chain.beads.max(1) as usize;
    let first = state.len();
    let starts = starts(group, chain, first, count, model, shift);
    let laid_out = outline(chain, group.placement.is_lattice(), model);
    let units = &model.units;
    for index in 0..count {
        let id = first + index;
        let start = starts[index / beads];
        let offset = match &laid_out {
            Some(outline) if group.placement.is_lattice() => outline[index % beads],
            Some(outline) => turned(outline, index % beads, id - index % beads, model),
            // A step of a random walk from the bead before.
            None if index % beads == 0 => [0.0; 3],
            None => {
                let before = units.position(state.positions[id - 1]);
                let step = direction(id, 0, model);
                let next = std::array::from_fn(|axis| before[axis] + chain.spacing * step[axis]);
                state.positions.push(fraction(next, model));
                continue;
            }
        };
        let position = std::array::from_fn(|axis| start[axis] + offset[axis]);
        state.positions.push(fraction(position, model));
    }
}

/// The integer position of a real one, zero on axes that the box has not.
fn fraction(position: [f64; 3], model: &Model) -> [u32; 3] {
    let all = model.units.place(std::array::from_fn(|axis| match model.units.ends()[axis] {
        0 => position[axis],
        _ => mirrored(position[axis], model.units.edges()[axis]),
    }));
    std::array::from_fn(|axis| if axis < model.units.dimension { all[axis] } else { 0 })
}

/// A coordinate that walls at 0 and at an edge have reflected as often as it went beyond one.
pub(crate) fn mirrored(coordinate: f64, edge: f64) -> f64 {
    let twice = coordinate.rem_euclid(2.0 * edge);
    if twice > edge { 2.0 * edge - twice } else { twice }
}

/// Where the first bead of every chain starts.
fn starts(
    group: &ParticleGroup,
    chain: &Chain,
    first: usize,
    count: usize,
    model: &Model,
    shift: f64,
) -> Vec<[f64; 3]> {
    let beads = chain.beads.max(1) as usize;
    let chains = count.div_ceil(beads);
    let units = &model.units;
    if !group.placement.is_lattice() {
        return (0..chains)
            .map(|number| units.position(crate::families::start::random_position(first + number * beads, model)))
            .collect();
    }
    let extent = extent(chain, model);
    let lengths: Vec<f64> = (0..units.dimension).map(|axis| units.edges()[axis] / extent[axis]).collect();
    let sites = lattice_sites(chains as u64, &lengths);
    let all: u128 = sites.iter().map(|sites| u128::from(*sites)).product();
    (0..chains)
        .map(|number| {
            let mut site = number as u128 * all / chains as u128;
            std::array::from_fn(|axis| {
                let coordinate = (site % u128::from(sites[axis])) as f64;
                site /= u128::from(sites[axis]);
                (coordinate + shift) / sites[axis] as f64 * units.edges()[axis]
            })
        })
        .collect()
}

/// Beads of a folded chain along each axis: as many along the first as the box holds, and so on.
fn folds(chain: &Chain, model: &Model) -> [usize; 3] {
    let units = &model.units;
    let mut left = chain.beads.max(1) as usize;
    std::array::from_fn(|axis| {
        if axis >= units.dimension {
            return 1;
        }
        let last = axis + 1 == units.dimension;
        let fit = ((units.edges()[axis] / chain.spacing) as usize).max(1);
        let beads = if last { left } else { left.min(fit) };
        left = left.div_ceil(beads);
        beads
    })
}

/// Radius of a regular polygon around its corners.
fn radius(chain: &Chain) -> f64 {
    0.5 * chain.spacing / (PI / f64::from(chain.beads)).sin()
}

/// Whether a chain is closed by a bond of its own.
fn closes(chain: &Chain) -> bool {
    chain.closed && chain.beads > 2
}

/// What a chain takes of space on each axis.
fn extent(chain: &Chain, model: &Model) -> [f64; 3] {
    let spacing = chain.spacing;
    if !closes(chain) {
        return folds(chain, model).map(|beads| beads as f64 * spacing);
    }
    if model.units.dimension == 1 {
        return [0.5 * f64::from(chain.beads) * spacing, spacing, spacing];
    }
    let across = 2.0 * radius(chain) + spacing;
    [across, across, spacing]
}

/// The beads relative to the first; none where every step is random.
fn outline(chain: &Chain, lattice: bool, model: &Model) -> Option<Vec<[f64; 3]>> {
    let beads = chain.beads.max(1) as usize;
    let spacing = chain.spacing;
    let line = |place: &dyn Fn(f64) -> f64| (0..beads).map(|bead| [spacing * place(bead as f64), 0.0, 0.0]).collect();
    if closes(chain) && model.units.dimension == 1 {
        let round = beads as f64 * spacing;
        if (round / model.units.lengths[0] - 1.0).abs() < 1e-9 {
            return Some(line(&|bead| bead));
        }
        // Out and back; a quarter of a bond off, so that no two beads meet.
        let half = 0.5 * beads as f64;
        return Some(line(&|bead| half - 0.25 - (half - 0.25 - bead).abs()));
    }
    if closes(chain) {
        let radius = radius(chain);
        let corner = |bead: usize| {
            let (sine, cosine) = (TAU * bead as f64 / beads as f64).sin_cos();
            [radius * (cosine - 1.0), radius * sine, 0.0]
        };
        let mut corners: Vec<[f64; 3]> = (0..beads).map(corner).collect();
        if lattice {
            // The lattice gives the lower corner of a cell.
            for corner in &mut corners {
                corner[0] += 2.0 * radius;
                corner[1] += radius;
            }
        }
        return Some(corners);
    }
    lattice.then(|| {
        let folds = folds(chain, model);
        let there_and_back = |index: usize, length: usize, turn: usize| {
            if turn.is_multiple_of(2) { index } else { length - 1 - index }
        };
        (0..beads)
            .map(|bead| {
                let (row, layer) = (bead / folds[0], bead / (folds[0] * folds[1]));
                let along = there_and_back(bead % folds[0], folds[0], row);
                let across = there_and_back(row % folds[1], folds[1], layer);
                [along, across, layer].map(|place| place as f64 * spacing)
            })
            .collect()
    })
}

/// A bead of an outline turned at random about the first.
fn turned(outline: &[[f64; 3]], bead: usize, first: usize, model: &Model) -> [f64; 3] {
    let [x, y, _] = outline[bead];
    let along = direction(first, 0, model);
    let across = match model.units.dimension {
        1 => [0.0; 3],
        2 => [-along[1], along[0], 0.0],
        _ => perpendicular(along, direction(first, 1, model)),
    };
    std::array::from_fn(|axis| x * along[axis] + y * across[axis])
}

/// The unit vector perpendicular to `along` on the side of `other`; both are unit vectors.
fn perpendicular(along: [f64; 3], other: [f64; 3]) -> [f64; 3] {
    let dot: f64 = (0..3).map(|axis| along[axis] * other[axis]).sum();
    let rest: [f64; 3] = std::array::from_fn(|axis| other[axis] - dot * along[axis]);
    let length = rest.iter().map(|part| part * part).sum::<f64>().sqrt();
    // Two random directions of 24 bits may be the same.
    if length > 1e-6 { rest.map(|part| part / length) } else { perpendicular(along, [along[1], along[2], -along[0]]) }
}

/// A random unit vector for a bead.
fn direction(id: usize, counter: u32, model: &Model) -> [f64; 3] {
    let key = noise::step_key(model.seed, stream::CHAIN, 0);
    noise::direction(noise::words(Generator::Threefry2x32, key, [id as u32, counter]), model.units.dimension)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::families::Checked;
    use serde_json::json;

    /// Lengths of all bonds, chain by chain, and the state.
    fn lengths(edges: &[f64], chain: &serde_json::Value, count: u64, placement: &str) -> (Vec<f64>, State, Model) {
        let scene = json!({
            "title": "chains",
            "seed": 3,
            "space": {"box": edges},
            "time": {"step": 0.01, "steps": 1},
            "temperature": 1,
            "particles": [{"species": "bead", "count": count, "chain": chain, "placement": {"type": placement}}],
            "interactions": [{"type": "bonds", "potential": {"type": "harmonic", "stiffness": 10}}],
        });
        let scene = Checked::presumed(serde_json::from_value(scene).unwrap());
        let model = scene.model().clone();
        let state = crate::families::initial_state(&scene);
        let bond = |ends: [u32; 2]| {
            let [a, b] = ends.map(|end| state.positions[end as usize]);
            model.units.displacement(a, b).iter().map(|part| part * part).sum::<f64>().sqrt()
        };
        let lengths = model.particles().bonds.as_ref().unwrap().iter().map(|each| bond(each.ends)).collect();
        (lengths, state, model)
    }

    const BOXES: [&[f64]; 3] = [&[90.0], &[9.0, 12.0], &[6.0, 7.0, 8.0]];

    #[test]
    fn bonds_have_the_length_asked_for() {
        for edges in BOXES {
            for placement in ["random", "lattice"] {
                for closed in [false, true] {
                    // Folded thrice in two and three dimensions.
                    let chain = json!({"beads": 20, "spacing": 0.7, "closed": closed});
                    let (lengths, state, model) = lengths(edges, &chain, 60, placement);
                    assert_eq!(lengths.len(), if closed { 60 } else { 57 });
                    let back = closed && edges.len() == 1;
                    for length in lengths {
                        let short = back && (length - 0.35).abs() < 1e-6;
                        assert!((length - 0.7).abs() < 1e-6 || short, "{edges:?} {placement} {closed}: {length}");
                    }
                    let dimension = model.units.dimension;
                    assert!(state.positions.iter().all(|position| position[dimension..].iter().all(|word| *word == 0)));
                    let distinct: std::collections::HashSet<_> = state.positions.iter().collect();
                    assert!(placement == "random" || distinct.len() == 60, "{edges:?} {closed}");
                }
            }
        }
    }

    #[test]
    fn a_ring_that_fits_goes_round_the_box() {
        for placement in ["random", "lattice"] {
            let (lengths, state, _) =
                lengths(&[20.0], &json!({"beads": 40, "spacing": 0.5, "closed": true}), 40, placement);
            assert!(lengths.iter().all(|length| (length - 0.5).abs() < 1e-6), "{lengths:?}");
            let distinct: std::collections::HashSet<_> = state.positions.iter().collect();
            assert_eq!(distinct.len(), 40);
        }
    }

    /// The steps of many walks have no direction: each component of 6 000 unit vectors has a mean of 0 and a mean square
    /// of 1/d within four standard errors.
    #[test]
    fn walks_go_everywhere() {
        for edges in [&[50.0][..], &[50.0, 50.0], &[50.0, 50.0, 50.0]] {
            let (_, state, model) = lengths(edges, &json!({"beads": 3001}), 6002, "random");
            let bonds = model.particles().bonds.as_ref().unwrap();
            let dimension = edges.len() as f64;
            for axis in 0..edges.len() {
                let steps = bonds.iter().map(|bond| {
                    let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
                    model.units.displacement(b, a)[axis]
                });
                let [sum, squares] = steps.fold([0.0, 0.0], |[sum, squares], step| [sum + step, squares + step * step]);
                assert!((sum / 6000.0).abs() < 4.0 / (6000.0 * dimension).sqrt(), "{edges:?}: {sum}");
                // ⟨x⁴⟩ is 3/8 on the circle and 1/5 on the sphere.
                let fourth = [1.0, 0.375, 0.2][edges.len() - 1];
                let error = ((fourth - 1.0 / (dimension * dimension)) / 6000.0_f64).sqrt();
                let excess = squares / 6000.0 - 1.0 / dimension;
                assert!(excess.abs() < 4.0 * error + 1e-6, "{edges:?}: {excess}");
            }
        }
    }

    #[test]
    fn rings_are_turned_at_random() {
        let (_, state, model) = lengths(&[50.0, 50.0, 50.0], &json!({"beads": 6, "closed": true}), 1200, "random");
        // Normals of 200 hexagons: each component has a mean square of 1/3.
        let mut squares = [0.0; 3];
        for ring in state.positions.chunks_exact(6) {
            let [a, b] = [1, 2].map(|bead| model.units.displacement(ring[bead], ring[0]));
            let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let length: f64 = normal.iter().map(|part| part * part).sum();
            (0..3).for_each(|axis| squares[axis] += normal[axis] * normal[axis] / length / 200.0);
        }
        // The standard deviation of the square of a component is √(1/5 - 1/9).
        let error = ((0.2 - 1.0 / 9.0) / 200.0_f64).sqrt();
        assert!(squares.iter().all(|square| (square - 1.0 / 3.0).abs() < 4.0 * error), "{squares:?}");
    }
}
