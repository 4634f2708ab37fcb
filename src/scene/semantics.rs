//! What a schema cannot say: counts, species, lengths and durations that have to fit each other.

use std::collections::HashMap;
use std::fmt::Display;

use super::{
    CountedPairs, CountedQuantity, Interaction, ParticleGroup, Placement, Problems, ProfiledQuantity, Scene,
    SpeciesNames, StructureFactor, Velocities,
};
use crate::families;
use crate::state::MOST_PARTICLES;

/// Bytes of device memory that a fluid without lists and analyses needs for each particle, as an upper bound.
pub const BYTES_PER_PARTICLE: u64 = 100;

/// The number of a species has eight bits of a particle.
const MOST_SPECIES: usize = 256;

/// Bonds and angles are numbered by 32-bit words.
const MOST_RUNS: u64 = u32::MAX as u64;

/// All problems of a scene that satisfies the schema, by arithmetic: no time and no memory that grow with what it asks for.
pub(super) fn check(scene: &Scene) -> Problems {
    let mut problems = Problems::default();
    check_box(scene, &mut problems);
    let species = SpeciesNames::of(scene);
    check_groups(scene, &mut problems);
    check_number_of_particles(scene, &mut problems);
    check_number_of_species(&species, &mut problems);
    check_number_of_runs(scene, &mut problems);
    check_interactions(scene, &species, &mut problems);
    check_durations(scene, &mut problems);
    check_species_of_analyses(scene, &species, &mut problems);
    super::colours::check(scene, &mut problems);
    problems
}

fn check_groups(scene: &Scene, problems: &mut Problems) {
    let dimension = scene.space.lengths.len();
    let mut first: HashMap<&str, (usize, f64)> = HashMap::new();
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}]");
        check_amount(group, &path, problems);
        if group.file_type.is_some() && scene.state.is_none() {
            let accepted = "no `type`, which is one of the file that particles start from";
            problems.refuse(format!("{path}.type"), "without a `state`", accepted);
        }
        if let Placement::Listed { positions } = &group.placement {
            check_vectors(positions, dimension, &format!("{path}.placement.positions"), problems);
        }
        if let Velocities::Listed { velocities } = &group.velocities {
            let path = format!("{path}.velocities.velocities");
            let count = group.resolved_count(&scene.space);
            if velocities.len() as u64 != count {
                let found = format!("a list of {}", velocities.len());
                problems.refuse(&path, found, format!("one velocity for each particle of the group: {count}"));
            }
            check_vectors(velocities, dimension, &path, problems);
        }
        let (known, mass) = *first.entry(&group.species).or_insert((index, group.mass));
        if mass != group.mass {
            let accepted = format!("{mass}, the mass of species `{}` in particles[{known}]", group.species);
            problems.refuse(format!("{path}.mass"), group.mass, accepted);
        }
    }
}

/// A group says in exactly one way how many particles it has.
fn check_amount(group: &ParticleGroup, path: &str, problems: &mut Problems) {
    if let Placement::Listed { positions } = &group.placement {
        let length = positions.len();
        if let Some(count) = group.count.filter(|count| *count != length as u64) {
            let accepted = format!("{length}, the number of listed positions, or no `count` at all");
            problems.refuse(format!("{path}.count"), count, accepted);
        }
        if let Some(density) = group.number_density {
            let accepted = "no `number_density`: the listed positions say how many particles there are";
            problems.refuse(format!("{path}.number_density"), density, accepted);
        }
        return;
    }
    check_one_of_two(group.count, group.number_density, path, problems);
}

/// An amount is a count or a density.
pub(super) fn check_one_of_two(count: Option<u64>, density: Option<f64>, path: &str, problems: &mut Problems) {
    let found = match (count, density) {
        (Some(_), Some(_)) => "both `count` and `number_density` are given",
        (None, None) => "neither `count` nor `number_density` is given",
        _ => return,
    };
    problems.add(path, found, "exactly one of `count` and `number_density`");
}

fn check_vectors(vectors: &[Vec<f64>], dimension: usize, path: &str, problems: &mut Problems) {
    for (index, vector) in vectors.iter().enumerate() {
        if vector.len() != dimension {
            let accepted = format_args!("{dimension} components, one for each box edge");
            problems.refuse(format_args!("{path}[{index}]"), format_args!("{} components", vector.len()), accepted);
        } else if let Some(axis) = vector.iter().position(|component| !component.is_finite()) {
            problems.refuse(format_args!("{path}[{index}][{axis}]"), vector[axis], "a finite number");
        }
    }
}

fn check_number_of_particles(scene: &Scene, problems: &mut Problems) {
    // In double precision, since a density can ask for more particles than any integer holds.
    let amount = |group: &ParticleGroup| match (&group.placement, group.count, group.number_density) {
        (Placement::Listed { positions }, _, _) => positions.len() as f64,
        (_, Some(count), _) => count as f64,
        (_, None, density) => (density.unwrap_or(0.0) * group.placement.volume(&scene.space)).round(),
    };
    let amounts: Vec<f64> = scene.particles.iter().map(amount).collect();
    let total: f64 = amounts.iter().sum();
    if total <= MOST_PARTICLES as f64 {
        return;
    }
    let of_groups = scene.particles.iter().enumerate().zip(&amounts);
    let path = match of_groups.max_by(|a, b| a.1.total_cmp(b.1)).map(|(group, _)| group) {
        Some((index, group)) if group.count.is_some() => format!("particles[{index}].count"),
        Some((index, group)) if group.number_density.is_some() => format!("particles[{index}].number_density"),
        _ => "particles".to_owned(),
    };
    let [total, gibibytes] = [total, total * BYTES_PER_PARTICLE as f64 / (1_u64 << 30) as f64].map(quantity);
    let found =
        format!("{total} particles in the scene, which need {gibibytes} GiB at {BYTES_PER_PARTICLE} bytes each");
    let accepted = format!("at most {MOST_PARTICLES} particles, since they are numbered by 32-bit words");
    problems.refuse(path, found, accepted);
}

pub(super) fn check_number_of_species(species: &SpeciesNames<'_>, problems: &mut Problems) {
    let count = species.count();
    if count > MOST_SPECIES {
        let accepted =
            format!("at most {MOST_SPECIES} species, since a particle has eight bits for the number of its own");
        problems.refuse("particles", format!("{count} species"), accepted);
    }
}

/// All bonds and angles are numbered, those along chains too.
fn check_number_of_runs(scene: &Scene, problems: &mut Problems) {
    let (mut bonds, mut angles) = (0_u64, 0_u64);
    for (index, interaction) in scene.interactions().iter().enumerate() {
        let (sum, found, what) = match interaction {
            Interaction::Bonds(asked) => (&mut bonds, asked.links(scene).count(scene), "bonds"),
            Interaction::Angles(asked) => (&mut angles, asked.links(scene).count(scene), "angles"),
            _ => continue,
        };
        let before = *sum;
        *sum = before.saturating_add(found);
        if *sum > MOST_RUNS && before <= MOST_RUNS {
            let found = format!("{} {what} with these", quantity(*sum as f64));
            let accepted = format!("at most {MOST_RUNS} {what} in a scene, since they are numbered by 32-bit words");
            problems.refuse(format!("interactions[{index}]"), found, accepted);
        }
    }
}

/// The longest edge of a box over the shortest: positions are resolved to 2⁻³² of an edge.
const MOST_ELONGATED: f64 = 1e6;

fn check_box(scene: &Scene, problems: &mut Problems) {
    let longest = scene.space.lengths.iter().copied().fold(0.0, f64::max);
    for (axis, length) in scene.space.lengths.iter().enumerate() {
        if *length < longest / MOST_ELONGATED {
            let accepted = format!("at least {:e}, a millionth of the longest edge", longest / MOST_ELONGATED);
            problems.refuse(format!("space.box[{axis}]"), format!("{length:e}"), accepted);
        }
    }
}

/// A large number as people read it.
fn quantity(number: f64) -> String {
    if number < 1e15 { format!("{number:.0}") } else { format!("{number:.3e}") }
}

fn check_interactions(scene: &Scene, species: &SpeciesNames<'_>, problems: &mut Problems) {
    families::check_system(scene, species, problems);
    // Cutoffs of single pairs of species are checked where they are given.
    let common = scene.pair_interactions().filter_map(|(_, dpd)| dpd.common_cutoff(species.count()));
    let cutoff = common.fold(0.0, f64::max);
    for (axis, length) in scene.space.lengths.iter().enumerate() {
        if *length < 2.0 * cutoff {
            let why = match scene.space.walls.of_axes()[axis] {
                Some(_) => "walls nearer to each other leave no room for a fluid",
                None => "in a shorter box a particle would meet two images of a neighbour",
            };
            let accepted = format!("at least {}, two cutoffs of {cutoff}: {why}", 2.0 * cutoff);
            problems.refuse(format!("space.box[{axis}]"), length, accepted);
        }
    }
}

fn check_durations(scene: &Scene, problems: &mut Problems) {
    let time = &scene.time;
    if time.equilibration > time.steps {
        let accepted =
            format!("at most {}, the number of steps; `--set time.equilibration=0` leaves it out", time.steps);
        problems.refuse("time.equilibration", time.equilibration, accepted);
    }
    check_windows(scene, problems);
    check_analyses(scene, problems);
    let output = &scene.output;
    if let Some(factor) = &output.structure_factor {
        check_wave_numbers(factor, scene, problems);
    }
    let radial = output.radial_distribution.as_ref().map(|asked| ("radial_distribution.range", asked.range));
    let clusters = output.clusters.as_ref().map(|asked| ("clusters.distance", asked.distance));
    for (path, distance) in [radial, clusters].into_iter().flatten() {
        let half = 0.5 * scene.space.shortest_length();
        // A box that is none is a mistake of its own.
        if half > 0.0 && distance > half {
            let accepted = format!("at most {half}, half the shortest box edge");
            problems.refuse(format!("output.{path}"), distance, accepted);
        }
    }
    let without_normal = output.stress.as_ref().filter(|asked| asked.normal.is_none());
    if let Some(interfaces) = without_normal.and_then(|asked| asked.interfaces) {
        problems.refuse("output.stress.interfaces", interfaces, "`normal`, the axis across them, beside it");
    }
}

/// The most waves whose amplitudes are sampled: sixteen samples of them have 16 MiB.
const MOST_WAVES: u64 = 1 << 16;

/// A structure factor has wave vectors of the box, and no more of them than there is room for.
fn check_wave_numbers(factor: &StructureFactor, scene: &Scene, problems: &mut Problems) {
    let periodic = scene.space.lengths.iter().zip(scene.space.walls.of_axes()).filter(|(_, walls)| walls.is_none());
    let longest = periodic.map(|(length, _)| *length).fold(0.0, f64::max);
    let path = "output.structure_factor";
    if longest == 0.0 {
        problems.refuse(path, "between walls on all sides", "an axis without walls, along which there are waves");
        return;
    }
    let least = std::f64::consts::TAU / longest;
    if factor.range < least {
        let accepted =
            format!("at least {least:.4}, the wave number of one wave along the longest periodic edge of the box");
        problems.refuse(format!("{path}.range"), factor.range, accepted);
    }
    let is_told_apart =
        factor.species.is_some() || factor.charges || scene.particles.iter().any(ParticleGroup::is_frozen);
    let species = if is_told_apart { scene.particles.len() } else { 1 };
    let waves = u64::from(factor.bins) * u64::from(factor.vectors) * species.max(1) as u64;
    if waves > MOST_WAVES {
        let found = format!("{} bins of {} wave vectors and {species} species", factor.bins, factor.vectors);
        problems.refuse(path, found, format!("at most {MOST_WAVES} in all: fewer `bins` or `vectors`"));
    }
}

/// A window that the run ends before gives no result.
fn check_windows(scene: &Scene, problems: &mut Problems) {
    let measured = scene.time.steps.saturating_sub(scene.time.equilibration);
    let output = &scene.output;
    let diffusion = output.diffusion.iter().map(|asked| ("diffusion".to_owned(), asked.every, asked.window));
    let viscosity = output.viscosity.iter().map(|asked| ("viscosity".to_owned(), asked.every, asked.window));
    let stress = output.stress.iter().filter_map(|asked| Some(("stress".to_owned(), asked.every, asked.window?)));
    let autocorrelations = output.autocorrelations.iter().enumerate();
    let autocorrelations =
        autocorrelations.map(|(index, asked)| (format!("autocorrelations[{index}]"), asked.every, asked.window));
    for (name, every, window) in diffusion.chain(viscosity).chain(stress).chain(autocorrelations) {
        let needed = u128::from(every) * u128::from(window);
        if needed > u128::from(measured) {
            let found = format!("{window} samples of {every} steps, {needed} steps in all");
            let most = measured / every.max(1);
            let longer = format!("time.steps of at least {}", needed + u128::from(scene.time.equilibration));
            let accepted = match most {
                0 | 1 => longer,
                _ => format!("at most {most} samples within the {measured} steps after equilibration, or {longer}"),
            };
            problems.refuse(format!("output.{name}.window"), found, accepted);
        }
    }
}

/// The most numbers of all histograms of pairs: a workgroup counts in 16 KiB of its own.
const MOST_BINS: u64 = 4096;

/// Analyses of species name those that there are, and that have what is measured.
fn check_species_of_analyses(scene: &Scene, species: &SpeciesNames<'_>, problems: &mut Problems) {
    let is = |name: &str, what: fn(&ParticleGroup) -> bool| {
        scene.particles.iter().find(|group| group.species == name).is_some_and(what)
    };
    for (path, name) in scene.output.species() {
        let path = format!("{path}.species");
        if species.check(name, &path, problems) && is(name, ParticleGroup::is_held) {
            let accepted = "a species whose particles can move: others have no motion to measure";
            problems.refuse(path, format!("\"{name}\", which is held"), accepted);
        }
    }
    let mut placed: Vec<(String, &str)> = Vec::new();
    placed.extend(scene.output.placed_species().map(|(path, name)| (path.to_owned(), name)));
    for (path, pairs, bins) in scene.output.pairs_of_species() {
        match pairs {
            CountedPairs::Within(all) if all == CountedPairs::ALL => check_all_pairs(species, path, bins, problems),
            CountedPairs::Within(name) => placed.push((path.to_owned(), name)),
            CountedPairs::Between(names) => {
                placed.extend((0..).zip(names).map(|(place, name)| (format!("{path}[{place}]"), name.as_str())));
            }
        }
    }
    for (path, name) in placed {
        if species.check(name, &path, problems) && is(name, ParticleGroup::is_frozen) {
            let accepted = "a species that is not frozen behind walls, where nothing is counted";
            problems.refuse(path, format!("\"{name}\", which is frozen"), accepted);
        }
    }
    let trajectory = scene.output.trajectory.iter().map(|asked| ("trajectory", &asked.species));
    for (key, names) in trajectory.chain([("snapshot", &scene.output.snapshot.species)]) {
        for (index, name) in names.iter().enumerate() {
            species.check(name, &format!("output.{key}.species[{index}]"), problems);
        }
    }
}

/// All pairs of species have so many bins that a workgroup holds them; `all` names no species.
fn check_all_pairs(species: &SpeciesNames<'_>, path: &str, bins: u32, problems: &mut Problems) {
    let (all, pairs) = (CountedPairs::ALL, species.count() as u64 * (species.count() as u64 + 1) / 2);
    let pair = "`species` with one or two names";
    let most = MOST_BINS / pairs.max(1);
    if species.place(all).is_some() {
        let accepted = format!("[\"{all}\", \"{all}\"] for pairs of the species, or another name of it");
        problems.refuse(path, format!("\"{all}\", which is also a species"), accepted);
    } else if most < u64::from(bins) {
        let fewer = format!("at most {MOST_BINS} bins in all: `bins` up to {most}, or {pair}");
        let accepted = if most == 0 { pair } else { &fewer };
        problems.refuse(path, format!("{pairs} pairs of species with {bins} bins each"), accepted);
    }
}

/// Analyses of charge are of all species, some of which have a charge.
fn check_analyses_of_charge(scene: &Scene, problems: &mut Problems) {
    let factor = scene.output.structure_factor.as_ref().filter(|factor| factor.charges);
    let profiles = scene.output.profiles.as_ref();
    let profiles = profiles.filter(|profiles| profiles.quantities.contains(&ProfiledQuantity::Charge));
    let are_charged = scene.particles.iter().any(|group| group.charge_parts() != 0 && !group.is_frozen());
    let factor = factor.map(|factor| ("structure_factor", "charges", factor.species.is_some()));
    let profiles = profiles.map(|profiles| ("profiles", "quantities", profiles.species.is_some()));
    for (analysis, key, of_species) in [factor, profiles].into_iter().flatten() {
        let path = format!("output.{analysis}");
        if of_species {
            let found = format!("together with the charge in `{key}`");
            problems.refuse(format!("{path}.species"), found, "one of them: charges are of all species");
        }
        if !are_charged {
            let accepted = "a `charge` other than 0 in one of `particles`";
            problems.refuse(format!("{path}.{key}"), "no particle with a charge", accepted);
        }
    }
}

/// Every quantity has one table and one plot; only velocities have a frame, and only components an axis.
fn check_analyses(scene: &Scene, problems: &mut Problems) {
    let output = &scene.output;
    check_analyses_of_charge(scene, problems);
    let mut once = |path: &str, key: &str, names: Vec<String>| {
        for (index, name) in names.iter().enumerate().filter(|(index, name)| names[..*index].contains(name)) {
            let path = format!("output.{path}[{index}]{key}");
            problems.refuse(path, format!("{name} again"), "every quantity at most once");
        }
    };
    let quoted = |name: &dyn Display| format!("\"{name}\"");
    let fields = output.fields.iter().flat_map(|asked| &asked.quantities);
    let fields = fields.map(|quantity| format!("the {}", quantity.stem().replace('_', " ")));
    once("fields.quantities", "", fields.collect());
    let correlated = output.autocorrelations.iter().map(|asked| quoted(&asked.quantity));
    once("autocorrelations", ".quantity", correlated.collect());
    let profiles = output.profiles.iter().flat_map(|asked| &asked.quantities);
    once("profiles.quantities", "", profiles.map(|quantity| quoted(quantity)).collect());
    once("histograms", ".quantity", output.histograms.iter().map(|asked| quoted(&asked.quantity)).collect());
    for (path, quantity, _) in
        output.frames().filter(|(_, quantity, _)| ["force", "acceleration"].contains(&quantity.as_str()))
    {
        let accepted = "no `frame`: only velocities depend on one";
        problems.refuse(format!("{path}.frame"), format!("for the quantity \"{quantity}\""), accepted);
    }
    let mut axes = vec![
        ("stress.normal".to_owned(), output.stress.as_ref().and_then(|asked| asked.normal)),
        ("profiles.axis".to_owned(), output.profiles.as_ref().map(|asked| asked.axis)),
    ];
    for (index, asked) in output.histograms.iter().enumerate() {
        let key = format!("histograms[{index}].axis");
        if asked.axis.is_some() && asked.quantity == CountedQuantity::Speed {
            problems.refuse(format!("output.{key}"), "for the quantity \"speed\"", "no `axis`: a speed has none");
        } else {
            axes.push((key, asked.axis));
        }
    }
    for (key, axis) in axes {
        if let Some(axis) = axis.filter(|axis| *axis as usize >= scene.space.lengths.len()) {
            problems.refuse(format!("output.{key}"), quoted(&axis), "an axis of the box");
        }
    }
}
