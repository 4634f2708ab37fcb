//! The particles of a scene with molecules, as a file would list them: molecule by molecule, each bead by bead.

use super::super::semantics::check_one_of_two;
use crate::document::{Generator, Molecule, Problems, Scene, SpeciesNames};
use crate::noise::{self, stream};
use crate::state::MOST_PARTICLES;
use crate::state_file::{Links, ParticleFile};
use std::collections::{HashMap, HashSet};

/// The most beads in a scene: they are placed one by one in memory, and their bonds are listed.
const MOST_BEADS: u64 = 100_000_000;

/// Type of the bonds of molecules that say nothing of it.
const BOND: &str = "bond";

/// Type of the angles of molecules that say nothing of it.
const ANGLE: &str = "angle";

/// Directions that are tried for a bead until it is not too near to the others that are bonded to the same one.
const TRIES: u32 = 32;

/// How near those may be, in parts of the spacing.
const NEAREST: f64 = 0.8;

/// Places of a molecule with rings that are tried until all bonds can have their length.
const STARTS: u32 = 8;

/// Rounds in which the ends of bonds are moved until all have their length.
const ROUNDS: u32 = 2000;

/// Part of the spacing by which a bond of a ring may be longer or shorter.
const SLACK: f64 = 1e-3;

/// Checks the molecules of a scene, by arithmetic.
pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    let names = SpeciesNames::of(scene);
    for (index, molecule) in scene.molecules.iter().enumerate() {
        check_kind(scene, &names, molecule, &format!("molecules[{index}]"), problems);
    }
    let volume = scene.space.volume();
    let beads = |molecule: &Molecule| molecule.resolved_count(volume).saturating_mul(molecule.beads.len() as u64);
    let total = scene.molecules.iter().map(beads).fold(0, u64::saturating_add);
    if total > MOST_BEADS.min(MOST_PARTICLES) {
        let accepted = format!(
            "at most {MOST_BEADS}, since they are placed one by one in memory; `particles` with a `count` and a `chain` are not"
        );
        problems.refuse("molecules", format!("{total} beads in all"), accepted);
    }
}

/// All particles of molecules that are right by themselves; none where some find no places.
pub(super) fn particles(scene: &Scene, problems: &mut Problems) -> Option<ParticleFile> {
    let names = SpeciesNames::of(scene);
    let mass = |name: &&str| scene.particles.iter().find(|group| group.species == *name).map(|group| group.mass);
    let mut all = ParticleFile {
        species: names.names().iter().map(|name| (*name).to_owned()).collect(),
        labelled: true,
        masses: names.names().iter().map(mass).collect(),
        dimension: Some(scene.space.lengths.len()),
        ..ParticleFile::default()
    };
    for (index, molecule) in scene.molecules.iter().enumerate() {
        if let Err(number) = add(&mut all, scene, &names, molecule) {
            let found = format!(
                "bonds that cannot all be {} long in {} dimensions, tried for molecule {number} in {STARTS} ways",
                molecule.spacing,
                scene.space.lengths.len()
            );
            let accepted =
                "rings whose beads find room around them; or a `state` from a file with the places of all beads";
            problems.refuse(format!("molecules[{index}].bonds"), found, accepted);
        }
    }
    problems.is_empty().then_some(all)
}

/// Checks molecules of one kind by themselves.
fn check_kind(scene: &Scene, names: &SpeciesNames<'_>, molecule: &Molecule, path: &str, problems: &mut Problems) {
    for (bead, name) in molecule.beads.iter().enumerate() {
        names.check(name, &format!("{path}.beads[{bead}]"), problems);
    }
    check_one_of_two(molecule.count, molecule.number_density, path, problems);
    let half = 0.5 * scene.space.shortest_length();
    if molecule.beads.len() > 1 && molecule.spacing > half {
        let accepted = format!("at most {half}, half of the shortest box edge");
        problems.refuse(format!("{path}.spacing"), molecule.spacing, accepted);
    }
    let bonds = check_links(&molecule.bonds, "bonds", molecule, path, problems);
    let angles = check_links(&molecule.angles, "angles", molecule, path, problems);
    check_types(&molecule.bond_types, molecule.bonds.len(), "bond", path, problems);
    check_types(&molecule.angle_types, molecule.angles.len(), "angle", path, problems);
    if !bonds {
        return;
    }
    let joined: HashSet<usize> = walk(molecule).into_iter().map(|step| step.bead).collect();
    if let Some(bead) = (0..molecule.beads.len()).find(|bead| !joined.contains(bead)) {
        let accepted = "bonds that join all beads; what is apart is a molecule of its own";
        problems.refuse(format!("{path}.bonds"), format!("no way along them from bead 0 to bead {bead}"), accepted);
    }
    if angles {
        let bonded: HashSet<[u32; 2]> = molecule.bonds.iter().flat_map(|[a, b]| [[*a, *b], [*b, *a]]).collect();
        let open = |[a, b, c]: &[u32; 3]| !bonded.contains(&[*a, *b]) || !bonded.contains(&[*b, *c]);
        for (index, angle) in molecule.angles.iter().enumerate().filter(|(_, angle)| open(angle)) {
            let accepted = "three beads of which the one in the middle is bonded to both others";
            problems.refuse(format!("{path}.angles[{index}]"), format!("{angle:?}"), accepted);
        }
    }
}

/// Whether bonds or angles join beads that are there, all different, and each set of them once.
fn check_links<const LENGTH: usize>(
    links: &[[u32; LENGTH]],
    key: &str,
    molecule: &Molecule,
    path: &str,
    problems: &mut Problems,
) -> bool {
    let mut known: HashMap<[u32; LENGTH], usize> = HashMap::new();
    let mut right = true;
    for (index, link) in links.iter().enumerate() {
        let mut refuse = |accepted: String| {
            problems.refuse(format!("{path}.{key}[{index}]"), format!("{link:?}"), accepted);
            right = false;
        };
        let backward = std::array::from_fn(|at| link[LENGTH - 1 - at]);
        if link.iter().any(|bead| *bead as usize >= molecule.beads.len()) {
            refuse(format!("beads from 0 to {}", molecule.beads.len().saturating_sub(1)));
        } else if (1..LENGTH).any(|at| link[..at].contains(&link[at])) {
            refuse("beads that are all different".to_owned());
        } else if let Some(first) = known.insert((*link).min(backward), index) {
            refuse(format!("each once: {path}.{key}[{first}] is the same"));
        }
    }
    right
}

/// Types are given for all or for none.
fn check_types(types: &[String], links: usize, noun: &str, path: &str, problems: &mut Problems) {
    if !types.is_empty() && types.len() != links {
        let accepted = format!("{links}, one for each of `{noun}s`, or no `{noun}_types`");
        problems.refuse(format!("{path}.{noun}_types"), format!("a list of {}", types.len()), accepted);
    }
}

/// A bead, the one to which it is bonded, and those that are bonded to that one and have places before it.
struct Step {
    bead: usize,
    before: Option<usize>,
    beside: Vec<usize>,
}

/// A walk along the bonds that starts at the first bead and comes to every one that can be reached, once.
fn walk(molecule: &Molecule) -> Vec<Step> {
    let mut bonded = vec![Vec::new(); molecule.beads.len()];
    for [a, b] in molecule.bonds.iter().map(|ends| ends.map(|end| end as usize)) {
        bonded[a].push(b);
        bonded[b].push(a);
    }
    let mut reached = vec![false; molecule.beads.len()];
    let mut steps = vec![Step { bead: 0, before: None, beside: Vec::new() }];
    reached[0] = true;
    let mut next = 0;
    while next < steps.len() {
        let here = steps[next].bead;
        for &bead in &bonded[here] {
            if !reached[bead] {
                let beside = bonded[here].iter().copied().filter(|other| reached[*other]).collect();
                steps.push(Step { bead, before: Some(here), beside });
                reached[bead] = true;
            }
        }
        next += 1;
    }
    steps
}

/// Adds all molecules of a kind. The error is the number of one whose rings cannot be closed.
fn add(all: &mut ParticleFile, scene: &Scene, names: &SpeciesNames<'_>, molecule: &Molecule) -> Result<(), u64> {
    let lengths = &scene.space.lengths;
    let steps = walk(molecule);
    let types: Vec<u32> = molecule.beads.iter().map(|name| names.place(name).unwrap_or(0) as u32).collect();
    let rings = molecule.bonds.len() >= molecule.beads.len();
    let starts = if rings { STARTS } else { 1 };
    // Types are there even where no molecule is.
    link(&mut all.bonds, &molecule.bonds, &molecule.bond_types, BOND, None);
    link(&mut all.angles, &molecule.angles, &molecule.angle_types, ANGLE, None);
    for number in 0..molecule.resolved_count(scene.space.volume()) {
        let first = all.len() as u32;
        let start = corner(scene, first);
        let place = |attempt: u32| {
            let mut places = placed(molecule, &steps, scene.seed, lengths.len(), first, attempt);
            (!rings || close(&mut places, molecule)).then_some(places)
        };
        let places = (0..starts).find_map(place).ok_or(number)?;
        all.positions.extend(places.iter().map(|place| {
            std::array::from_fn(|axis| match lengths.get(axis) {
                Some(length) if scene.space.walls.of_axes()[axis].is_some() => {
                    crate::families::mirrored(start[axis] + place[axis], *length).min(length.next_down())
                }
                // A remainder may be rounded to the edge itself.
                Some(length) => (start[axis] + place[axis]).rem_euclid(*length).min(length.next_down()),
                None => 0.0,
            })
        }));
        all.types.extend_from_slice(&types);
        link(&mut all.bonds, &molecule.bonds, &molecule.bond_types, BOND, Some(first));
        link(&mut all.angles, &molecule.angles, &molecule.angle_types, ANGLE, Some(first));
    }
    Ok(())
}

/// Adds the types of the bonds or angles of a molecule, and those of one whose first bead has that number, if there is one.
fn link<const LENGTH: usize>(
    all: &mut Vec<Links<LENGTH>>,
    links: &[[u32; LENGTH]],
    types: &[String],
    usual: &str,
    first: Option<u32>,
) {
    for (index, link) in links.iter().enumerate() {
        let name = types.get(index).map_or(usual, String::as_str);
        let place = all.iter().position(|known| known.name == name).unwrap_or_else(|| {
            all.push(Links { name: name.to_owned(), members: Vec::new() });
            all.len() - 1
        });
        all[place].members.extend(first.map(|first| link.map(|bead| first + bead)));
    }
}

/// A random place in the box.
fn corner(scene: &Scene, particle: u32) -> [f64; 3] {
    let key = noise::step_key(scene.seed, stream::POSITION, 0);
    let [x, y] = noise::words(Generator::Threefry2x32, key, [particle, 0]);
    let [z, _] = noise::words(Generator::Threefry2x32, key, [particle, 1]);
    let words = [x, y, z];
    std::array::from_fn(|axis| {
        scene.space.lengths.get(axis).map_or(0.0, |length| (noise::centred_uniform(words[axis]) + 0.5) * length)
    })
}

/// Where the beads of a molecule are, from its first: a random walk along the bonds that does not turn back on itself.
fn placed(molecule: &Molecule, steps: &[Step], seed: u64, dimension: usize, first: u32, attempt: u32) -> Vec<[f64; 3]> {
    let key = noise::step_key(seed, stream::CHAIN, 0);
    let mut places = vec![[0.0; 3]; molecule.beads.len()];
    for step in steps {
        let Some(before) = step.before else { continue };
        let number = first + step.bead as u32;
        let candidate = |counter: u32| {
            let words = noise::words(Generator::Threefry2x32, key, [number, attempt * TRIES + counter]);
            let way = noise::direction(words, dimension);
            let place: [f64; 3] = std::array::from_fn(|axis| places[before][axis] + molecule.spacing * way[axis]);
            let nearest = step.beside.iter().map(|other| distance(place, places[*other])).fold(f64::MAX, f64::min);
            (place, nearest)
        };
        let mut best = candidate(0);
        for counter in 1..TRIES {
            if best.1 >= NEAREST * molecule.spacing {
                break;
            }
            let other = candidate(counter);
            if other.1 > best.1 {
                best = other;
            }
        }
        places[step.bead] = best.0;
    }
    places
}

/// Moves the ends of bonds until all are as long as they should be; whether they are.
fn close(places: &mut [[f64; 3]], molecule: &Molecule) -> bool {
    for _ in 0..ROUNDS {
        let mut worst = 0.0_f64;
        for [a, b] in molecule.bonds.iter().map(|ends| ends.map(|end| end as usize)) {
            let length = distance(places[a], places[b]);
            if length == 0.0 {
                return false;
            }
            let off = length / molecule.spacing - 1.0;
            worst = worst.max(off.abs());
            for axis in 0..3 {
                let part = 0.5 * (places[b][axis] - places[a][axis]) * (1.0 - molecule.spacing / length);
                places[a][axis] += part;
                places[b][axis] -= part;
            }
        }
        if worst <= SLACK {
            return true;
        }
    }
    false
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    /// The particles of one kind of molecules in a box with edges of 8.
    fn built(molecule: &serde_json::Value, dimension: usize) -> (ParticleFile, usize) {
        let scene = json!({
            "title": "molecules",
            "seed": 5,
            "space": {"box": vec![8; dimension]},
            "time": {"step": 0.01, "steps": 1},
            "temperature": 1,
            "particles": [{"species": "A"}, {"species": "B"}],
            "molecules": [molecule],
        });
        let scene: Scene = serde_json::from_value(scene).unwrap();
        let mut problems = Problems::default();
        let found = particles(&scene, &mut problems);
        (found.unwrap_or_default(), problems.iter().count())
    }

    fn apart(file: &ParticleFile, a: u32, b: u32) -> f64 {
        let [a, b] = [a, b].map(|particle| file.positions[particle as usize]);
        let way: [f64; 3] = std::array::from_fn(|axis| (a[axis] - b[axis]) - 8.0 * ((a[axis] - b[axis]) / 8.0).round());
        distance(way, [0.0; 3])
    }

    #[test]
    fn bonds_have_their_length_and_beads_beside_each_other_are_apart() {
        let star = json!({"beads": ["A", "B", "B", "B", "B", "B"], "count": 50, "spacing": 0.7,
            "bonds": [[0, 1], [0, 2], [0, 3], [3, 4], [4, 5]]});
        for dimension in [2, 3] {
            let (file, _) = built(&star, dimension);
            assert_eq!((file.len(), file.bonds.len(), file.bonds[0].members.len()), (300, 1, 250));
            for [a, b] in &file.bonds[0].members {
                assert!((apart(&file, *a, *b) - 0.7).abs() < 1e-9);
            }
            for first in (0..300).step_by(6) {
                for [a, b] in [[1, 2], [1, 3], [2, 3], [0, 4], [3, 5]] {
                    assert!(apart(&file, first + a, first + b) > 0.8 * 0.7 - 1e-9, "{dimension} {a} {b}");
                }
            }
            assert!(file.positions.iter().all(|place| place.iter().all(|part| (0.0..8.0).contains(part))));
            assert!(file.positions.iter().all(|place| place[dimension..].iter().all(|part| *part == 0.0)));
        }
    }

    #[test]
    fn rings_close_or_are_refused() {
        // A hexagon with a tail, and a tetrahedron, which a plane has no room for; a triangle has none on a line.
        let ring = json!({"beads": ["A", "A", "A", "A", "A", "A", "B"], "count": 40,
            "bonds": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [3, 6]]});
        let full = json!({"beads": ["A", "A", "A", "A"], "count": 40,
            "bonds": [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]});
        let triangle = json!({"beads": ["A", "A", "A"], "count": 40, "bonds": [[0, 1], [1, 2], [2, 0]]});
        for (molecule, least) in [(ring, 2), (full, 3), (triangle, 2)] {
            for dimension in 1..=3 {
                let (file, problems) = built(&molecule, dimension);
                assert_eq!(problems, usize::from(dimension < least), "{dimension}");
                for [a, b] in file.bonds.iter().flat_map(|links| &links.members) {
                    assert!((apart(&file, *a, *b) - 1.0).abs() < 2.0 * SLACK, "{dimension}");
                }
            }
        }
    }

    #[test]
    fn types_gather_the_bonds_of_all_molecules() {
        let (file, _) = built(
            &json!({"beads": ["A", "B", "B"], "count": 2, "bonds": [[0, 1], [1, 2]], "bond_types": ["head", "tail"],
                "angles": [[0, 1, 2]]}),
            3,
        );
        let named = |links: &Links<2>| (links.name.clone(), links.members.clone());
        let expected = [("head", [[0, 1], [3, 4]]), ("tail", [[1, 2], [4, 5]])];
        let expected: Vec<_> = expected.iter().map(|(name, links)| ((*name).to_owned(), links.to_vec())).collect();
        assert_eq!(file.bonds.iter().map(named).collect::<Vec<_>>(), expected);
        assert_eq!((file.angles[0].name.as_str(), &file.angles[0].members), ("angle", &vec![[0, 1, 2], [3, 4, 5]]));
        assert_eq!(file.types, [0, 1, 1, 0, 1, 1]);
    }
}
