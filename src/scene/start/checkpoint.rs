//! The particles of an earlier run, from its last checkpoint.

use crate::families::{Angles, Bonds, Checked, Family, Link, Model};
use crate::scene::{Change, EarlierRun, FileStart, WrittenScene};
use crate::state::{State, StateArray};
use crate::state_file::checkpoint::{self, ContentError, FILE, MAGIC, START, VERSION};
use crate::state_file::{Fits, Links, Mistake, ParticleFile, frozen_layers, open_regular_file};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The checkpoint that a path means: that of a directory, or itself.
pub(super) fn of(path: &Path) -> Option<PathBuf> {
    if path.is_dir() {
        return Some(path.join(FILE));
    }
    let mut start = Vec::new();
    open_regular_file(path).ok()?.take(MAGIC.len() as u64).read_to_end(&mut start).ok()?;
    (start == MAGIC).then(|| path.to_path_buf())
}

/// An earlier run, as its checkpoint has it.
#[derive(Debug)]
pub(super) struct Run {
    pub scene: Checked,
    state: State,
    /// Changes between its steps, and before it.
    pub changes: Vec<Change>,
}

impl Run {
    /// What a scene has of it that goes on with it.
    pub(crate) fn earlier(&self) -> EarlierRun {
        EarlierRun {
            seed: self.scene.model().seed,
            steps: self.scene.model().clock(self.state.step),
            momentum_unit: self.scene.model().units.momentum,
            expected_velocity: self.scene.model().expected_velocity,
        }
    }

    /// Whether a scene has the seed, forces, baths and time step of it, so that it goes on with it: a model of the scene was made with
    /// [`Self::earlier`].
    pub(crate) fn goes_on_with(&self, seed: u64, model: &Model) -> bool {
        seed == self.scene.seed && model.has_the_steps_of(self.scene.model())
    }

    /// The state where the other run begins.
    pub(crate) fn state(&self) -> State {
        State { step: 0, ..self.state.clone() }
    }

    /// What of it a scene with other steps cannot take, in words.
    pub(crate) fn forgotten(&self) -> impl Iterator<Item = &'static str> {
        let there = StateArray::ALL.into_iter().filter(|array| self.state.length(*array) > 0);
        let mut lost: Vec<&str> = there.filter_map(lost).collect();
        // Arrays of one kind follow each other.
        lost.dedup();
        lost.into_iter()
    }

    /// Velocities at the report point, where those in a checkpoint are half a step behind: the float64 reference closes the step with
    /// the forces, baths and time step of the run itself.
    pub(crate) fn velocities(&self) -> Result<Vec<[f64; 3]>, Mistake> {
        let model = self.scene.model();
        let reference = model.physics().reference(model, &self.state);
        let momenta = reference.and_then(|reference| reference.reported_momenta().ok());
        let momenta = momenta.ok_or_else(|| damaged("the last step of its run cannot be completed"))?;
        let velocity = |(momentum, species): (&[i32; 3], &u32)| {
            model.units.momentum(*momentum).map(|part| part / model.species[*species as usize].mass)
        };
        Ok(momenta.iter().zip(&self.state.species).map(velocity).collect())
    }
}

/// The particles of a checkpoint, in the order that they have there, and the run. Their momenta are those with which they came to their
/// positions.
pub(super) fn particles(path: &Path, fits: &Fits<'_>) -> Result<(ParticleFile, Run), Mistake> {
    let run = run(path, fits)?;
    Ok((of_state(run.scene.model(), &run.state)?, run))
}

/// The run of a checkpoint.
pub(super) fn run(path: &Path, fits: &Fits<'_>) -> Result<Run, Mistake> {
    if !path.exists() {
        let found = format!("the directory has no `{FILE}`: no run has saved its state there");
        return Err(Mistake::new("", found, "the directory of a run with a checkpoint, or a file"));
    }
    let file = open_regular_file(path).map_err(ContentError::Io);
    // Its arrays are in the file, or it is refused: their number is no news to anyone but the adapter.
    let content = file.and_then(|file| checkpoint::read(file, |_, _, count| fits(count)));
    let content = content.map_err(|error| refusal(&error))??;
    let start = content.sections.iter().find(|(name, _)| name == START);
    let start = start.and_then(|(_, bytes)| FileStart::from_bytes(bytes)).map(Arc::new);
    let written = WrittenScene::new("its scene", content.scene);
    let scene = written.check_kept(start).map_err(|error| damaged(&format!("its scene is refused ({error})")))?;
    let scene =
        scene.part_of(content.state.step).map_err(|error| damaged(&format!("its scene is refused ({error})")))?;
    let before = scene.start().map(|start| start.changes.clone()).unwrap_or_default();
    let changes = before.into_iter().chain(Change::from_sections(&content.sections)).collect();
    Ok(Run { scene, state: content.state, changes })
}

fn refusal(error: &ContentError) -> Mistake {
    let accepted = "a checkpoint as this version of the program writes it";
    match error {
        ContentError::Io(error) => Mistake::new("", format!("it cannot be read ({error})"), accepted),
        ContentError::Magic => Mistake::new("", "it is no checkpoint", accepted),
        ContentError::Version { found } => {
            Mistake::new("", format!("found a checkpoint of format {found}"), format!("format {VERSION}"))
        }
        ContentError::Length { expected, found } => {
            damaged(&format!("it should have {expected} bytes and has {found}: it was cut short or altered"))
        }
        ContentError::Checksum => damaged("its checksum does not match its content"),
        ContentError::Malformed(problem) => damaged(problem),
    }
}

fn damaged(problem: &str) -> Mistake {
    Mistake::new("", problem, "a checkpoint as a run has left it")
}

/// The particles of a state of a model.
fn of_state(model: &Model, state: &State) -> Result<ParticleFile, Mistake> {
    if !matches!(model.family, Family::Particles(_)) || model.particles().side_by_side {
        let found = "found a run whose particles have more than a species, a position and a momentum";
        return Err(Mistake::new("", found, "a run of particles with forces between them"));
    }
    let species = |particle: usize| model.species.get(state.species[particle] as usize);
    if state.len() as u64 != model.particle_count() || (0..state.len()).any(|particle| species(particle).is_none()) {
        return Err(damaged("its particles are not those of its scene"));
    }
    if model.frozen_particles() > 0 {
        return Err(frozen_layers("", model.frozen_particles()));
    }
    let mass = |particle: usize| species(particle).map_or(1.0, |species| species.mass);
    let velocity = |particle: usize| model.units.momentum(state.momenta[particle]).map(|part| part / mass(particle));
    Ok(ParticleFile {
        species: model.species.iter().map(|species| species.name.clone()).collect(),
        labelled: true,
        types: state.species.clone(),
        masses: model.species.iter().map(|species| Some(species.mass)).collect(),
        charges: model.species.iter().map(|species| Some(species.charge)).collect(),
        dimension: Some(model.units.dimension),
        lengths: Some(model.units.edges()),
        displacements: displacements(model, model.clock(state.step)),
        positions: state.positions.iter().map(|position| model.units.position(*position)).collect(),
        velocities: (0..state.len()).map(velocity).collect(),
        images: state.images.clone(),
        bonds: by_kind("bond", model.particles().bonds.iter().flat_map(Bonds::iter)),
        angles: by_kind("angle", model.particles().angles.iter().flat_map(Angles::iter)),
        tethers: state.tethers.iter().map(|tether| model.units.position(*tether)).collect(),
        ..ParticleFile::default()
    })
}

/// How far copies of the box above it are displaced along x after so many steps of the clock.
fn displacements(model: &Model, clock: u64) -> [f64; 3] {
    let mut displacements = [0.0; 3];
    if let Some(shear) = &model.particles().shear {
        let boxes = f64::from(shear.shift(clock.wrapping_mul(2))) / 4_294_967_296.0;
        displacements[shear.gradient] = boxes * model.units.lengths[0];
    }
    displacements
}

/// What another run cannot take from an array of a state.
const fn lost(array: StateArray) -> Option<&'static str> {
    match array {
        // Tethers and images are taken; neighbours are listed anew, and what is put in is counted from the start of such a run.
        StateArray::Tethers
        | StateArray::Images
        | StateArray::Anchors
        | StateArray::Account
        | StateArray::Walls
        | StateArray::Predicted => None,
        StateArray::PairBaths | StateArray::PositionBaths | StateArray::BondBaths => Some("what its baths remember"),
        StateArray::Holds => Some("its coloured noise"),
        StateArray::Masses | StateArray::Energies => Some("masses and energies of single particles"),
        StateArray::NodeMasses | StateArray::NodeBath => Some("what its mesh remembers"),
    }
}

/// Bonds or angles by their kind, which trajectories name so too.
fn by_kind<const LENGTH: usize>(noun: &str, all: impl Iterator<Item = Link<LENGTH>>) -> Vec<Links<LENGTH>> {
    let mut found: Vec<Links<LENGTH>> = Vec::new();
    for Link { ends, kind } in all {
        while found.len() <= kind as usize {
            found.push(Links { name: format!("{noun} {}", found.len()), members: Vec::new() });
        }
        found[kind as usize].members.push(ends);
    }
    found
}
