//! The state of a scene from a file or of molecules: what that says goes into the scene, and everything is compared with what the scene
//! says.

mod checkpoint;
mod fields;
mod molecules;
mod places;
mod weight;

use super::semantics;
use super::{
    FileStart, FileType, Integrator, Interaction, KeptStart, Origin, Output, OutsidePositions, Placement, Problem,
    Problems, Scene, SceneError, SpeciesNames, StateFile, StateFiles, StateVelocities, Velocities, Warning, nearest,
};
use crate::document::{FilePlaces, ParticleGroup, number_of_copies};
use crate::families::{self, Model};
use crate::host_memory;
use crate::numbers::counted;
use crate::state::MOST_PARTICLES;
use crate::state_file::{self, AtomStyle, Links, Mistake, ParticleFile, ROUNDING, StateFileError, quoted};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use weight::Weighing;

pub use weight::Fits;

/// The numbers that a group of a scene gives itself, and not a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Given {
    mass: bool,
    charge: bool,
}

impl Given {
    /// Those of a group as it is written.
    pub(super) fn of_group(group: &serde_json::Value) -> Self {
        let has = |key| group.get(key).is_some();
        Self { mass: has("mass"), charge: has("charge") }
    }
}

/// A number of groups that a file may have.
struct Adopted {
    noun: &'static str,
    is_given: fn(&Given) -> bool,
    number: fn(&mut ParticleGroup) -> &mut f64,
}

/// Reads the file of a scene's state, if it has one, which lies beside a scene of that name or where `files` says; `given` says which
/// numbers groups give themselves. Completes the scene by the box, the numbers of particles, masses, charges and the checksum. Notices say what is not used.
/// `fits` decides of the number of particles before they are read or placed.
///
/// # Errors
/// [`SceneError::StateChanged`] if the file is not what it was, and what `fits` returns.
pub(super) fn read(
    scene: &mut Scene,
    given: &[Given],
    (name, files): (&str, &StateFiles),
    fits: Option<&Fits<'_>>,
    notices: &mut Vec<Warning>,
) -> Result<Problems, SceneError> {
    let mut problems = Problems::default();
    if !scene.has_start() {
        return Ok(problems);
    }
    if let (Some(state), Some(mesh)) = (scene.state.clone(), scene.mesh()) {
        return fields::read(scene, &state, mesh, &files.path(name, &state.file), files);
    }
    check_scene(scene, &mut problems);
    if !problems.is_empty() {
        return Ok(problems);
    }
    let Some(state) = scene.state.clone() else { return of_molecules(scene, given, fits, problems, notices) };
    let path = files.path(name, &state.file);
    let weighing = Weighing::of(scene, fits);
    let read = particles(&path, &state, &|count| weighing.file(count));
    if let Some(refusal) = weighing.refusal.into_inner() {
        return Err(refusal);
    }
    let (file, run) = match read {
        Ok(found) => found,
        Err(error) if files.known(&state).is_some() => {
            let found = error.mistakes.first().map(|mistake| mistake.found.clone()).unwrap_or_default();
            return Err(SceneError::StateChanged { path, reason: found });
        }
        Err(error) => {
            refuse(&state, error.mistakes, &mut problems);
            return Ok(problems);
        }
    };
    let checksum = places::checksum(&file);
    files.check(&path, &state, &checksum)?;
    Ok(adopted(scene, given, Reader::new(&state, &file, run, Some(checksum)), "state.file", notices))
}

/// Places the molecules of a scene and completes it, as by a file.
fn of_molecules(
    scene: &mut Scene,
    given: &[Given],
    fits: Option<&Fits<'_>>,
    mut problems: Problems,
    notices: &mut Vec<Warning>,
) -> Result<Problems, SceneError> {
    molecules::check(scene, &mut problems);
    if problems.is_empty() {
        Weighing::of(scene, fits).molecules(host_memory::free(), &mut problems)?;
    }
    if !problems.is_empty() {
        return Ok(problems);
    }
    let Some(file) = molecules::particles(scene, &mut problems) else { return Ok(problems) };
    let state = StateFile {
        file: MOLECULES.to_owned(),
        frame: -1,
        velocities: StateVelocities::Thermal,
        replicate: Vec::new(),
        atom_style: None,
        outside: OutsidePositions::Refuse,
        checksum: None,
    };
    Ok(adopted(scene, given, Reader::new(&state, &file, None, None), MOLECULES, notices))
}

/// Takes what a reader has into a scene; the mistakes.
fn adopted(
    scene: &mut Scene,
    given: &[Given],
    mut reader: Reader<'_>,
    path: &str,
    notices: &mut Vec<Warning>,
) -> Problems {
    reader.adopt(scene, given);
    notices.extend(reader.notices.into_iter().map(|message| Warning { path: path.to_owned(), message }));
    reader.problems
}

/// Where the file of a scene of that name is.
pub(super) fn path(name: &str, file: &str) -> PathBuf {
    Path::new(name).parent().unwrap_or(Path::new("")).join(file)
}

/// The particles of a file, or of a run and that run.
fn particles(
    path: &Path,
    state: &StateFile,
    fits: &state_file::Fits<'_>,
) -> Result<(ParticleFile, Option<checkpoint::Run>), StateFileError> {
    let style = state.atom_style.as_deref();
    match checkpoint::of(path) {
        Some(checkpoint) => {
            let all = state_file::only_frame(state.frame).and_then(|()| state_file::no_atom_style(style));
            let all = all.and_then(|()| checkpoint::particles(&checkpoint, fits));
            all.map(|(file, run)| (file, Some(run)))
                .map_err(|mistake| StateFileError { path: path.to_path_buf(), mistakes: vec![mistake] })
        }
        None => state_file::read_fitting(path, state.frame, style, fits).map(|file| (file, None)),
    }
}

/// The particles of the last checkpoint of a run, with their velocities at its last report, or of a frame of a file, from 0, or from the end where it
/// is negative: in a box, with bonds between them, and each number one of its species.
///
/// # Errors
/// [`StateFileError`] with all mistakes.
pub fn particles_of(path: &Path, frame: i64) -> Result<ParticleFile, StateFileError> {
    let state = StateFile {
        file: String::new(),
        frame,
        velocities: StateVelocities::File,
        replicate: Vec::new(),
        atom_style: None,
        outside: OutsidePositions::Refuse,
        checksum: None,
    };
    let refusal = |mistakes| StateFileError { path: path.to_path_buf(), mistakes };
    let (mut file, run) = particles(path, &state, &|_| Ok(()))?;
    if let Some(run) = run {
        file.velocities = run.velocities().map_err(|mistake| refusal(vec![mistake]))?;
    }
    let Some(lengths) = file.lengths else {
        let accepted = "a file with a box, as `Lattice` is in extended XYZ";
        return Err(refusal(vec![Mistake::new("", "found no box", accepted)]));
    };
    let dimension = file.dimension.unwrap_or(3);
    let mut mistakes = file.mistakes(dimension, lengths, file.open_axes, true);
    mistakes.extend(file.mistakes_of_velocities(dimension));
    mistakes.extend(file.charge_mistakes.iter().cloned());
    if mistakes.is_empty() { Ok(file) } else { Err(refusal(mistakes)) }
}

fn refuse(state: &StateFile, mistakes: Vec<Mistake>, problems: &mut Problems) {
    let problem =
        |mistake: Mistake| Problem::new("state.file", mistake.found_in(Path::new(&state.file)), mistake.accepted);
    problems.extend(mistakes.into_iter().map(problem));
}

/// The key of molecules, which is also what messages call them.
const MOLECULES: &str = "molecules";

/// What a scene with a file or with molecules has to be, whatever those say.
fn check_scene(scene: &Scene, problems: &mut Problems) {
    let makes_particles = |interaction: &Interaction| matches!(interaction, Interaction::HarmonicChain(_));
    if let Some(index) = scene.interactions().iter().position(makes_particles) {
        let (path, what) = match &scene.state {
            Some(_) => ("state", "a file"),
            None => (MOLECULES, MOLECULES),
        };
        let found = format!("in a scene with interactions[{index}], whose particles {what} cannot describe");
        let accepted = format!(
            "{what} in scenes of `dpd`, `langevin`, `coloured-noise`, `tether`, `body-force`, `bonds` and `angles`: other particles have \
             more than a place and a velocity, such as masses of their own or energies"
        );
        problems.refuse(path, found, accepted);
    }
    if let Some(style) = scene.state.as_ref().and_then(|state| state.atom_style.as_deref())
        && let Err(mistake) = AtomStyle::of(style)
    {
        problems.add("state.atom_style", mistake.found, mistake.accepted);
    }
    if scene.space.shear.is_some() && scene.state.as_ref().is_some_and(|state| state.outside == OutsidePositions::Wrap)
    {
        let accepted = "positions inside the box, and no `outside`: whoever crosses boundaries that shear is displaced and gets their velocity";
        problems.refuse("state.outside", "\"wrap\" in a scene whose boundaries shear", accepted);
    }
    if scene.state.is_some() && !scene.molecules.is_empty() {
        let accepted = "one of the two: molecules are placed anew, and a file says where all particles are";
        problems.refuse(MOLECULES, "beside a `state`", accepted);
    }
    let (beside, places) = match &scene.state {
        Some(_) => ("beside a `state`", "no `placement`: the file of `state` says where particles start"),
        None => ("beside `molecules`", "no `placement`: molecules are placed along random walks"),
    };
    let free = scene.particles.iter().rposition(|group| !group.is_frozen());
    if let (Some(layer), Some(free)) = (scene.particles.iter().position(ParticleGroup::is_frozen), free)
        && layer < free
    {
        let accepted =
            format!("layers after all other groups, the last of which is particles[{free}]: their ids come last");
        problems.refuse(format!("particles[{layer}]"), beside, accepted);
    }
    for (index, group) in scene.particles.iter().enumerate() {
        if group.placement != Placement::Random && !group.is_frozen() {
            problems.refuse(format!("particles[{index}].placement"), beside, places);
        }
        if group.velocities != Velocities::Thermal {
            let accepted = match &scene.state {
                Some(_) => "no `velocities`: `state.velocities` is `file`, `thermal` or `rest` for all particles",
                None => "no `velocities`: molecules start with those of Maxwell's distribution",
            };
            problems.refuse(format!("particles[{index}].velocities"), beside, accepted);
        }
        if group.chain.is_some() && !scene.molecules.is_empty() {
            let accepted = "no `chain`: one is a molecule with `bonds` from bead to bead";
            problems.refuse(format!("particles[{index}].chain"), beside, accepted);
        }
    }
    semantics::check_number_of_species(&SpeciesNames::of(scene), problems);
}

/// The start that was read last, if it is the same: the variants of a sweep share it.
fn shared(start: FileStart) -> Arc<FileStart> {
    static LAST: Mutex<Weak<FileStart>> = Mutex::new(Weak::new());
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = last.upgrade().filter(|known| **known == start) {
        return known;
    }
    let start = Arc::new(start);
    *last = Arc::downgrade(&start);
    start
}

/// Compares the checksum of what was read with the one that a scene has, and puts it there.
fn adopt_checksum(scene: &mut Scene, state: &StateFile, found: String, problems: &mut Problems) {
    if let Some(given) = state.checksum.as_ref().filter(|given| **given != found) {
        let found = format!("\"{given}\", and \"{found}\" of `{}`", state.file);
        problems.refuse("state.checksum", found, "the file as it was, or no `checksum`");
    }
    if let Some(state) = &mut scene.state {
        state.checksum = Some(found);
    }
}

/// The first group of a species.
fn group_of(scene: &Scene, species: &str) -> usize {
    scene.particles.iter().position(|group| group.species == species).unwrap_or(0)
}

/// A file on its way into a scene.
struct Reader<'a> {
    state: &'a StateFile,
    file: &'a ParticleFile,
    /// Numbers of particles of its types.
    counts: Vec<u64>,
    /// The run that the file is of, if that is known.
    run: Option<checkpoint::Run>,
    /// Of what was read, if anything was.
    checksum: Option<String>,
    problems: Problems,
    notices: Vec<String>,
}

impl<'a> Reader<'a> {
    fn new(
        state: &'a StateFile,
        file: &'a ParticleFile,
        run: Option<checkpoint::Run>,
        checksum: Option<String>,
    ) -> Self {
        let mut counts = vec![0; file.species.len().max(1)];
        for kind in &file.types {
            counts[*kind as usize] += 1;
        }
        Self { state, file, counts, run, checksum, problems: Problems::default(), notices: Vec::new() }
    }

    /// Takes what the file says into the scene; stops where the rest would have no meaning.
    fn adopt(&mut self, scene: &mut Scene, given: &[Given]) {
        let Some(lengths) = self.adopt_box(scene) else { return };
        let dimension = scene.space.lengths.len();
        if !self.adopt_displacement(scene) {
            return;
        }
        let walled = scene.space.walls.of_axes().map(|walls| walls.is_some());
        let sheared = scene.space.shear.as_ref();
        let sheared = sheared.map(|shear| (shear.gradient as usize, shear.first_shift(&scene.space.lengths)));
        let wraps = self.state.outside == OutsidePositions::Wrap;
        refuse(self.state, self.file.mistakes(dimension, lengths, walled, wraps), &mut self.problems);
        if self.state.velocities == StateVelocities::File {
            refuse(self.state, self.file.mistakes_of_velocities(dimension), &mut self.problems);
        }
        let copies = number_of_copies(self.state.copies());
        let total = copies.saturating_mul(self.file.len() as u64);
        if total > MOST_PARTICLES {
            let found = format!("{} in {copies} copies of {}", counted(total, "particle"), self.file.len());
            let accepted = format!("at most {MOST_PARTICLES} particles, since they are numbered by 32-bit words");
            self.problems.refuse("state.replicate", found, accepted);
        }
        if self.state.velocities == StateVelocities::File && self.file.velocities.is_empty() && !self.file.is_empty() {
            let found = format!("\"file\", and no velocities in `{}`", self.state.file);
            let accepted = "\"thermal\" or \"rest\", or a file with velocities; GSD leaves out those that are all zero";
            self.problems.refuse("state.velocities", found, accepted);
        }
        let Some(species) = self.species(scene) else { return };
        self.adopt_types(scene, &species);
        self.adopt_counts(scene, &species);
        self.adopt_numbers(scene, given, &species);
        self.check_types(scene);
        if !self.problems.is_empty() {
            return;
        }
        let species_of_scene = SpeciesNames::of(scene).count();
        let mut start =
            places::start(self.file, self.state, &species, (dimension, walled, sheared), lengths, species_of_scene);
        start.surroundings = families::surroundings::of_start(scene, &start, &lengths[..dimension]);
        self.check_order(scene, &start);
        if let Some(found) = self.checksum.clone() {
            adopt_checksum(scene, self.state, found, &mut self.problems);
        }
        let mut unused = self.file.unused.clone();
        let start = match self.run.take() {
            Some(run) => self.continue_run(scene, start, &run, &mut unused),
            None => FileStart { origin: self.checksum.is_some().then_some(Origin::Anew), ..start },
        };
        self.note_what_is_not_used(scene, dimension, unused);
        self.note_missing_masses(scene, given, &species);
        scene.kept = KeptStart::of(shared(start));
    }

    /// A scene with the steps of the run before goes on with it, to the last bit; any other begins at its last report.
    fn continue_run(
        &mut self,
        scene: &mut Scene,
        mut start: FileStart,
        run: &checkpoint::Run,
        unused: &mut Vec<String>,
    ) -> FileStart {
        start.changes.clone_from(&run.changes);
        let moves_on = self.state.velocities == StateVelocities::File;
        if moves_on && start.copies == [1; 3] {
            let places = start.places.take();
            start.origin = Some(Origin::Earlier(run.earlier()));
            scene.kept = KeptStart::of(Arc::new(start.clone()));
            // The rule that is chosen where a scene names none follows from how dense the start is, which is no longer that of the run.
            let own = scene.system.clone();
            if let Some(integrator) = scene.system.particle_integrator_mut()
                && *integrator == (Integrator::Splitting { relaxation: None })
                && let theirs @ Integrator::Splitting { .. } = &run.scene.model().particles().integrator
            {
                integrator.clone_from(theirs);
            }
            // A model needs a scene that makes sense.
            let goes_on = semantics::check(scene).is_empty() && run.goes_on_with(scene.seed, &Model::new(scene));
            start.places = places.map(|places| FilePlaces { state: goes_on.then(|| run.state()), ..places });
            if goes_on {
                return start;
            }
            scene.system = own;
        }
        start.origin = Some(Origin::Anew);
        if moves_on {
            match run.velocities() {
                Ok(velocities) => places::set_in_motion(&mut start, &velocities, scene.space.lengths.len()),
                Err(mistake) => refuse(self.state, vec![mistake], &mut self.problems),
            }
        }
        unused.extend(run.forgotten().map(str::to_owned));
        start
    }

    /// The box of the file; that of the scene follows from it, or has to be the same.
    fn adopt_box(&mut self, scene: &mut Scene) -> Option<[f64; 3]> {
        let given = scene.space.lengths.len();
        let dimension = if given > 0 { given } else { self.file.dimension.unwrap_or(3) };
        let replicate = self.state.replicate.len();
        if replicate > 0 && replicate != dimension {
            let found = format!("a list of {replicate}");
            let accepted = format!("a number of copies for each of the {dimension} axes");
            self.problems.refuse("state.replicate", found, accepted);
            return None;
        }
        let copies = self.state.copies().map(f64::from);
        let Some(lengths) = self.file.lengths else {
            if given == 0 {
                let found = format!("missing, and `{}` has no box", self.state.file);
                self.problems.add("space", found, "an object with `box`, or a file with a `Lattice`");
                return None;
            }
            return Some(std::array::from_fn(|axis| {
                scene.space.lengths.get(axis).map_or(1.0, |edge| edge / copies[axis])
            }));
        };
        if given == 0 {
            scene.space.lengths = (0..dimension).map(|axis| lengths[axis] * copies[axis]).collect();
            return Some(lengths);
        }
        for axis in 0..dimension {
            let (found, expected) = (scene.space.lengths[axis], lengths[axis] * copies[axis]);
            if (found - expected).abs() > ROUNDING * expected {
                let copied = if copies[axis] > 1.0 { format!(" in {} copies", copies[axis]) } else { String::new() };
                let accepted = format!("{expected}, that of `{}`{copied}, or no `space` at all", self.state.file);
                self.problems.refuse(format!("space.box[{axis}]"), found, accepted);
            }
        }
        self.problems.is_empty().then_some(lengths)
    }

    /// How far boundaries that shear are displaced, which is where those of the file are. Copies would be displaced past each other.
    fn adopt_displacement(&mut self, scene: &mut Scene) -> bool {
        let edge = scene.space.lengths[0];
        let found = |axis: usize| self.file.displacements[axis];
        let gradient = scene.space.shear.as_ref().map(|shear| shear.gradient as usize);
        if let Some(axis) = (0..3).find(|axis| found(*axis) != 0.0 && gradient != Some(*axis)) {
            let name = ["x", "y", "z"][axis];
            let found = format!(
                "`{}`: found a triclinic box, whose copy above it along {name} is displaced by {} along x",
                self.state.file,
                found(axis)
            );
            let accepted = format!(
                "an orthogonal box; or `space.shear` with the `gradient` {name}, at a `rate` of 0 if the copy stays there"
            );
            self.problems.add("state.file", found, accepted);
            return false;
        }
        let Some(shear) = &mut scene.space.shear else { return true };
        let of_file = self.file.displacements[shear.gradient as usize];
        if shear.displacement == 0.0 {
            shear.displacement = of_file;
        }
        let displacement = shear.displacement;
        let apart = (displacement - of_file) / edge;
        if (apart - apart.round()).abs() > ROUNDING {
            let accepted = format!("{of_file}, as in `{}`, or no `displacement`", self.state.file);
            self.problems.refuse("space.shear.displacement", displacement, accepted);
        } else if displacement != 0.0 && number_of_copies(self.state.copies()) > 1 {
            let found = format!("copies of a box whose boundaries are displaced by {displacement}");
            self.problems.refuse("state.replicate", found, "one copy");
        }
        self.problems.is_empty()
    }

    /// The species of the scene for each type of the file; all that have particles have one.
    fn species(&mut self, scene: &Scene) -> Option<Vec<Option<u8>>> {
        let (file, names) = (self.file, SpeciesNames::of(scene));
        let types = self.types(scene, &names)?;
        let counts = self.counts.clone();
        let mut found = vec![None; file.species.len()];
        for (place, kind) in types.iter().enumerate().filter_map(|(place, kind)| Some((place, (*kind)?))) {
            let group = group_of(scene, names.names()[place]);
            if counts[kind] > 0 && scene.particles[group].is_frozen() {
                let accepted = "a species of its own for a layer, whose particles `behind-walls` places";
                let text = format!("`{}` has {} of it", self.state.file, counted(counts[kind], "particle"));
                self.problems.add(format!("particles[{group}].species"), text, accepted);
            }
            if let Some(other) = found[kind].replace(place as u8) {
                let [first, second] = [other.into(), place].map(|place: usize| names.names()[place]);
                let path = format!("particles[{}].type", group_of(scene, second));
                let text = format!("found the type `{}` for `{first}` and for `{second}`", file.species[kind]);
                self.problems.add(path, text, "a type of its own for every species");
            }
        }
        for kind in (0..counts.len()).filter(|kind| counts[*kind] > 0 && found.get(*kind).is_none_or(Option::is_none)) {
            let (name, count) = (file.species.get(kind).map_or("", String::as_str), counts[kind]);
            let what = if file.labelled { "the species" } else { "type" };
            let found = format!("`{}`: found {} of {what} `{name}`", self.state.file, counted(count, "particle"));
            let known = quoted(names.names().iter().copied());
            let accepted = if file.labelled {
                format!("the species of some particle group: {known}; or a group with that `type`")
            } else {
                format!(
                    "types 1 to {}, which are the species of the scene in their order: {known}; or labels of types, or a `type` in every \
                     group",
                    names.count()
                )
            };
            let suggestion = nearest(name, names.names().iter().copied()).filter(|_| file.labelled);
            self.problems.push(Problem::new("state.file", found, accepted).suggest(suggestion));
        }
        self.problems.is_empty().then_some(found)
    }

    /// The type of every species of the scene, if the file has it: the one that its groups say, else the one of its name, else, of types without
    /// names, the one in its place.
    fn types(&mut self, scene: &Scene, names: &SpeciesNames<'_>) -> Option<Vec<Option<usize>>> {
        let file = self.file;
        let called = |name: &str| {
            let is_called = |kind: &usize| {
                file.species[*kind] == name || file.numerals.get(*kind).is_some_and(|numeral| numeral == name)
            };
            (0..file.species.len()).find(is_called)
        };
        let known = || quoted(file.species.iter().map(String::as_str));
        let mut found: Vec<Option<usize>> = vec![None; names.count()];
        let (mut are_said, mut is_wrong) = (false, false);
        for (index, group) in scene.particles.iter().enumerate() {
            let Some(wanted) = group.file_type.as_ref().map(ToString::to_string) else { continue };
            let kind = &mut found[names.place(&group.species)?];
            are_said = true;
            let accepted = match called(&wanted) {
                None => format!("a type of `{}`: {}", self.state.file, known()),
                Some(said) if kind.is_some_and(|known| known != said) => {
                    format!("`{}`, as in another group of `{}`", file.species[kind.unwrap_or(said)], group.species)
                }
                Some(said) => {
                    *kind = Some(said);
                    continue;
                }
            };
            is_wrong = true;
            let problem = Problem::new(format!("particles[{index}].type"), format!("found `{wanted}`"), accepted);
            self.problems.push(problem.suggest(nearest(&wanted, file.species.iter().map(String::as_str))));
        }
        if is_wrong {
            return None;
        }
        for (place, name) in names.names().iter().enumerate() {
            if found[place].is_some() {
                continue;
            }
            if !file.labelled && are_said {
                let path = format!("particles[{}].type", group_of(scene, name));
                let accepted = format!("a type of `{}` in all groups, or in none: {}", self.state.file, known());
                self.problems.add(path, "missing, and found in another group", accepted);
                return None;
            }
            found[place] =
                if file.labelled { called(name) } else { Some(place).filter(|place| *place < file.species.len()) };
        }
        Some(found)
    }

    /// Says of every group which type its particles are of, where the order of groups has said it.
    fn adopt_types(&self, scene: &mut Scene, species: &[Option<u8>]) {
        if self.file.labelled {
            return;
        }
        let names = SpeciesNames::of(scene).to_owned();
        for group in &mut scene.particles {
            let is_its_own = |place: &Option<u8>| place.is_some_and(|place| names[usize::from(place)] == group.species);
            let kind = species.iter().position(is_its_own);
            group.file_type = kind.map(|kind| FileType::Number(kind as u32 + 1)).or(group.file_type.take());
        }
    }

    /// Numbers of particles; those that the scene gives have to be the same.
    fn adopt_counts(&mut self, scene: &mut Scene, species: &[Option<u8>]) {
        let copies = number_of_copies(self.state.copies());
        let names = SpeciesNames::of(scene).to_owned();
        let mut counts = vec![0_u64; names.len()];
        for (place, count) in species.iter().zip(&self.counts).filter_map(|(place, count)| Some(((*place)?, count))) {
            counts[usize::from(place)] += count;
        }
        for (name, count) in names.iter().zip(counts) {
            // A layer is placed beside what is in the file.
            if scene.particles[group_of(scene, name)].is_frozen() {
                continue;
            }
            let count = count.saturating_mul(copies);
            if count == 0 {
                self.notices.push(format!("`{}` has no particles of `{name}`", self.state.file));
            }
            let of_species = |group: &usize| scene.particles[*group].species == *name;
            let groups: Vec<usize> = (0..scene.particles.len()).filter(of_species).collect();
            let given = |group: &usize| {
                scene.particles[*group].count.is_some() || scene.particles[*group].number_density.is_some()
            };
            let found: Vec<u64> =
                groups.iter().map(|group| scene.particles[*group].resolved_count(&scene.space)).collect();
            let sum = found.iter().fold(0, |sum: u64, count| sum.saturating_add(*count));
            let first = groups[0];
            if groups.len() > 1 && !groups.iter().all(given) {
                let accepted =
                    format!("a `count` in each of the groups of `{name}`, {} in all", counted(count, "particle"));
                let found = format!("`{name}` in {} groups", groups.len());
                self.problems.refuse(format!("particles[{first}]"), found, accepted);
            } else if given(&first) && sum != count {
                let key = if scene.particles[first].count.is_some() { "count" } else { "number_density" };
                let accepted =
                    format!("{count}, the number of particles of `{name}` in `{}`, or no `{key}`", self.state.file);
                self.problems.refuse(format!("particles[{first}].{key}"), counted(sum, "particle"), accepted);
            }
            for (group, found) in groups.iter().zip(found) {
                let group = &mut scene.particles[*group];
                (group.count, group.number_density) = (Some(if groups.len() > 1 { found } else { count }), None);
            }
        }
    }

    /// Masses and charges that the scene leaves out are those of the file.
    fn adopt_numbers(&mut self, scene: &mut Scene, given: &[Given], species: &[Option<u8>]) {
        let names = SpeciesNames::of(scene).to_owned();
        let mass = Adopted { noun: "mass", is_given: |given| given.mass, number: |group| &mut group.mass };
        let charge = Adopted { noun: "charge", is_given: |given| given.charge, number: |group| &mut group.charge };
        self.check_charges(scene, given);
        let charges = if self.file.charge_mistakes.is_empty() { self.file.charges.as_slice() } else { &[] };
        for (adopted, numbers) in [(mass, self.file.masses.as_slice()), (charge, charges)] {
            for (kind, number) in numbers.iter().enumerate() {
                let (Some(number), Some(Some(place))) = (number, species.get(kind)) else { continue };
                let name = &names[usize::from(*place)];
                for (index, group) in scene.particles.iter_mut().enumerate().filter(|(_, group)| group.species == *name)
                {
                    let known = (adopted.number)(group);
                    if !given.get(index).is_some_and(adopted.is_given) {
                        *known = *number;
                    } else if (*known - number).abs() > ROUNDING * number.abs() {
                        let noun = adopted.noun;
                        self.notices.push(format!(
                            "the {noun} {number} of `{name}` is not used: particles[{index}] gives {known}"
                        ));
                    }
                }
            }
        }
    }

    /// Charges that differ within a species are a mistake where they matter: something depends on charges, and a group gives none.
    fn check_charges(&mut self, scene: &Scene, given: &[Given]) {
        let acts = |one: &Interaction| matches!(one, Interaction::Electrostatics(_) | Interaction::ElectricField(_));
        let is_counted = |output: &Output| output.structure_factor.as_ref().is_some_and(|factor| factor.charges);
        let is_counted = scene.outputs().iter().any(is_counted);
        let matters = is_counted || scene.interactions().iter().any(acts);
        if matters && !given.iter().all(|given| given.charge) {
            refuse(self.state, self.file.charge_mistakes.clone(), &mut self.problems);
        }
    }

    /// Says which species have no mass, neither in the file nor in the scene.
    fn note_missing_masses(&mut self, scene: &Scene, given: &[Given], species: &[Option<u8>]) {
        let names = SpeciesNames::of(scene);
        let is_given = |name: &str| {
            let mut groups = scene.particles.iter().zip(given);
            groups.any(|(group, given)| group.species == name && given.mass)
        };
        let lacking: Vec<&str> = (0..species.len())
            .filter(|kind| self.counts[*kind] > 0 && self.file.masses.get(*kind).copied().flatten().is_none())
            .filter_map(|kind| names.names().get(usize::from(species[kind]?)).copied())
            .filter(|name| !is_given(name))
            .collect();
        let (mass, be) = if lacking.len() == 1 { ("mass", "it is") } else { ("masses", "they are") };
        if !lacking.is_empty() {
            let (file, names) = (&self.state.file, quoted(lacking));
            self.notices.push(format!("`{file}` has no {mass} of {names}, and `particles` gives none: {be} 1"));
        }
    }

    /// Types of bonds and angles that interactions name have to be in the file.
    fn check_types(&mut self, scene: &Scene) {
        let bonds: Vec<&str> = self.file.bonds.iter().map(|links| links.name.as_str()).collect();
        let angles: Vec<&str> = self.file.angles.iter().map(|links| links.name.as_str()).collect();
        for (index, interaction) in scene.interactions().iter().enumerate() {
            let (types, known, noun) = match interaction {
                Interaction::Bonds(asked) => (&asked.types, &bonds, "bonds"),
                Interaction::Angles(asked) => (&asked.types, &angles, "angles"),
                _ => continue,
            };
            for (place, name) in types.iter().flatten().enumerate().filter(|(_, name)| !known.contains(&name.as_str()))
            {
                let accepted = match known.as_slice() {
                    [] => format!("no `types`: `{}` has no {noun}", self.state.file),
                    names => format!("a type of {noun} in `{}`: {}", self.state.file, quoted(names.iter().copied())),
                };
                let path = format!("interactions[{index}].types[{place}]");
                let problem = Problem::new(path, format!("found \"{name}\""), accepted);
                self.problems.push(problem.suggest(nearest(name, known.iter().copied())));
            }
        }
    }

    /// Chains are particles with consecutive numbers: with those, the file has to have the groups one after the other. Within one
    /// copy of the box such a chain would be bonded across the copy where the file bonds it across the boundary.
    fn check_order(&mut self, scene: &Scene, start: &FileStart) {
        let Some(chained) = scene.particles.iter().position(|group| group.chain.is_some()) else { return };
        if start.copies != [1; 3] {
            let found =
                format!("found, beside particles[{chained}].chain, whose beads follow each other in one box only");
            self.problems.add("state.replicate", found, "bonds of the file in place of chains; or one copy");
            return;
        }
        let names = SpeciesNames::of(scene);
        let groups = scene.particles.iter().flat_map(|group| {
            let place = names.place(&group.species).unwrap_or(0);
            std::iter::repeat_n(place, usize::try_from(group.count.unwrap_or(0)).unwrap_or(usize::MAX))
        });
        let astray = groups.zip(&start.species).position(|(place, species)| place != usize::from(*species));
        if let Some(particle) = astray {
            let found = format!(
                "found, and particle {} of `{}` is not where its group would have it",
                self.file.number(particle),
                self.state.file
            );
            let accepted = "a file with all particles of a group after each other, in the order of `particles`; or bonds of the \
                            file in place of chains";
            self.problems.add(format!("particles[{chained}].chain"), found, accepted);
        }
    }

    /// Says what is in the file, and nowhere in the scene.
    fn note_what_is_not_used(&mut self, scene: &Scene, dimension: usize, mut unused: Vec<String>) {
        let any = |asks: &dyn Fn(&Interaction) -> bool| scene.interactions().iter().any(asks);
        let bonds = unasked(&self.file.bonds, |kind| {
            any(&|one| matches!(one, Interaction::Bonds(bonds) if bonds.links(scene).include(kind, scene)))
        });
        let angles = unasked(&self.file.angles, |kind| {
            any(&|one| matches!(one, Interaction::Angles(angles) if angles.links(scene).include(kind, scene)))
        });
        for (noun, names) in [("bonds", bonds), ("angles", angles)] {
            if !names.is_empty() {
                unused.push(format!("{noun} of type {}", quoted(names)));
            }
        }
        if self.state.velocities != StateVelocities::File && !self.file.velocities.is_empty() {
            unused.push("velocities".to_owned());
        }
        if !self.file.charge_mistakes.is_empty() {
            unused.push("charges, which differ within a species".to_owned());
        }
        if !self.file.tethers.is_empty() && !any(&|one| matches!(one, Interaction::Tether(_))) {
            unused.push("the points that its particles are tied to".to_owned());
        }
        if !self.file.images.is_empty() && self.file.images.iter().any(|image| *image != [0; 3]) {
            let of_first = scene.outputs().into_iter().next().unwrap_or_default();
            if of_first.trajectory.is_none() {
                let stage = if scene.stages.is_empty() { "scene" } else { "first stage" };
                unused.push(format!("images, for the {stage} writes no trajectory"));
            } else if self.state.copies() != [1; 3] {
                unused.push("images, for copies of its box lie in one".to_owned());
            }
        }
        let beyond = |vectors: &[[f64; 3]]| (dimension..3).any(|axis| vectors.iter().any(|vector| vector[axis] != 0.0));
        if beyond(&self.file.positions) || beyond(&self.file.velocities) {
            let axes = &["x", "y", "z"][dimension..];
            unused.push(format!("what it says along {}, for the scene has {dimension} dimensions", axes.join(" and ")));
        }
        if !unused.is_empty() {
            self.notices.push(format!("not used of `{}`: {}", self.state.file, unused.join("; ")));
        }
    }
}

/// Names of types with links that nobody asks for.
fn unasked<const LENGTH: usize>(all: &[Links<LENGTH>], is_asked: impl Fn(&str) -> bool) -> Vec<&str> {
    let names = all.iter().filter(|links| !links.members.is_empty()).map(|links| links.name.as_str());
    names.filter(|name| !is_asked(name)).collect()
}
