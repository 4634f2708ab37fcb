//! Positions and velocities for other tools: OVITO, freud, `MDAnalysis`, ASE.

mod extended_xyz;
mod gsd;

use super::{Extent, Id, OutputError, files, own_file};
use crate::families::{Angles, Bonds, Kinematics, Model, ShearedBox, Species, TimeAxis};
use crate::scene::TrajectoryFormat;
use crate::state::{Reported, Units};
use std::fmt::Debug;
use std::path::Path;

/// A trajectory, open for writing. Frames reach the disk at [`flush`](Self::flush), always whole.
///
/// ```
/// use mesoscope::output::{Id, TrajectoryWriter};
/// use mesoscope::families;
/// use mesoscope::scene;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("trajectory.xyz");
/// let small = ["space.box=[3,3,3]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let model = scene.model();
/// let state = mesoscope::families::initial_state(&scene);
/// let format = scene::TrajectoryFormat::ExtendedXyz;
/// let mut trajectory = TrajectoryWriter::create(&path, format, model, Id::of_run(&scene))?;
/// trajectory.append(&state.into())?;
/// trajectory.flush()?;
/// let text = std::fs::read_to_string(&path)?;
/// assert!(text.starts_with("81\n") && text.lines().count() == 2 + 81);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct TrajectoryWriter {
    description: Description,
    /// The species that are written, if not all are.
    shown: Option<Vec<bool>>,
    file: Box<dyn Frames>,
}

/// What is known of a format.
struct Format {
    /// Name of the file.
    file: &'static str,
    /// Bytes of a particle in a frame.
    bytes_per_particle: u64,
    create: fn(&Path) -> Opened,
    resume: fn(&Path, Extent) -> Opened,
    /// The id of the run that wrote a file; none where it cannot be read.
    id_of: fn(&Path) -> Option<Id>,
}

type Opened = Result<Box<dyn Frames>, OutputError>;

/// The registry of formats.
fn format_of(format: TrajectoryFormat) -> &'static Format {
    match format {
        TrajectoryFormat::Gsd => &gsd::FORMAT,
        TrajectoryFormat::ExtendedXyz => &extended_xyz::FORMAT,
    }
}

/// The name of a trajectory in this format.
///
/// ```
/// use mesoscope::output::files;
/// use mesoscope::scene::TrajectoryFormat;
///
/// assert_eq!(files::trajectory(TrajectoryFormat::Gsd), "trajectory.gsd");
/// ```
#[must_use]
pub fn trajectory(format: TrajectoryFormat) -> &'static str {
    format_of(format).file
}

/// Bytes of a particle in a frame of this format.
pub(crate) fn bytes_per_particle(format: TrajectoryFormat) -> u64 {
    format_of(format).bytes_per_particle
}

/// The file of a format, open for writing.
trait Frames: Debug + Send {
    /// What has been written until the last flush.
    fn extent(&self) -> Extent;
    /// Looks whether the file under this name is still the one that was written.
    fn check(&self) -> Result<(), OutputError>;
    /// Adds a frame.
    fn append(&mut self, description: &Description, state: &Reported) -> Result<(), OutputError>;
    /// Hands all frames to the disk.
    fn flush(&mut self) -> Result<(), OutputError>;
}

/// What a frame needs to know besides the state.
#[derive(Debug, Clone)]
struct Description {
    run: Id,
    units: Units,
    time: TimeAxis,
    species: Vec<Species>,
    kinematics: Kinematics,
    /// Whether particles exchange mass.
    changing_masses: bool,
    /// Boundaries that shear, if there are any, and how far their clock is ahead of the steps.
    shear: Option<(ShearedBox, u64)>,
    /// Numbers of bonded particles and kind of the bond.
    bonds: Vec<([u32; 2], u32)>,
    /// The same of angles.
    angles: Vec<([u32; 3], u32)>,
    /// Numbers in the scene of the particles of a frame, where it does not have all of them.
    numbers: Option<Vec<u32>>,
}

impl Description {
    fn new(model: &Model, run: Id) -> Self {
        let particles = model.particles();
        Self {
            run,
            units: model.units,
            time: model.time,
            species: model.species.clone(),
            kinematics: Kinematics::new(model),
            changing_masses: model.physics().changes_masses(),
            shear: particles.shear.map(|shear| (shear, model.clock(0))),
            bonds: particles.bonds.iter().flat_map(Bonds::iter).map(|bond| (bond.ends, bond.kind)).collect(),
            angles: particles.angles.iter().flat_map(Angles::iter).map(|angle| (angle.ends, angle.kind)).collect(),
            numbers: None,
        }
    }

    /// Leaves the particles of these numbers, of so many, and the bonds and angles between them.
    fn select(&mut self, numbers: Vec<u32>, count: usize) {
        let mut places = vec![None; count];
        for (place, number) in (0..).zip(&numbers) {
            places[*number as usize] = Some(place);
        }
        self.bonds = selected(&self.bonds, &places);
        self.angles = selected(&self.angles, &places);
        self.numbers = Some(numbers);
    }

    /// The axis across which boundaries shear, and how far the copy of the box above is displaced along x at a step, in edges from -½ to ½:
    /// a shorter vector of the cell does for the same copies.
    fn displaced(&self, step: u64) -> Option<(usize, f64)> {
        let (shear, ahead) = self.shear.as_ref()?;
        let shift = shear.shift(ahead.wrapping_add(step).wrapping_mul(2)).cast_signed();
        Some((shear.gradient, f64::from(shift) / 4_294_967_296.0))
    }

    /// The components along x of the second and the third vector of the cell.
    fn tilts(&self, step: u64) -> [f64; 3] {
        let mut tilts = [0.0; 3];
        if let Some((axis, edges)) = self.displaced(step) {
            tilts[axis] = edges * self.units.lengths[0];
        }
        tilts
    }

    /// True if particles have charges.
    fn are_charged(&self) -> bool {
        self.species.iter().any(|species| species.charge != 0.0)
    }

    /// Particles in layers behind walls, if there are any.
    fn frozen_particles(&self, state: &Reported) -> Option<usize> {
        let frozen = state.species.iter().filter(|species| self.species[**species as usize].frozen).count();
        (frozen > 0).then_some(frozen)
    }

    /// Frames index the arrays of a state by particle and the species by the state: both must fit.
    fn check(&self, path: &Path, state: &Reported) -> Result<(), OutputError> {
        let wrong = |problem| OutputError::State { path: path.to_path_buf(), step: state.step, problem };
        if state.momenta.len() != state.len() || state.species.len() != state.len() {
            return Err(wrong("the arrays of the state differ in length"));
        }
        if state.species.iter().any(|index| *index as usize >= self.species.len()) {
            return Err(wrong("a particle belongs to a species the model does not have"));
        }
        Ok(())
    }
}

impl TrajectoryWriter {
    /// Creates the trajectory of a run; one that exists is emptied.
    ///
    /// # Errors
    /// [`OutputError::Io`] when the file cannot be created.
    pub fn create(path: &Path, format: TrajectoryFormat, model: &Model, run: Id) -> Result<Self, OutputError> {
        Ok(Self { description: Description::new(model, run), shown: None, file: (format_of(format).create)(path)? })
    }

    /// Continues the trajectory of an earlier run after what [`extent`](Self::extent) said was written of it; later frames
    /// are dropped. Extended XYZ is cut in place. A GSD file with anything later is copied without it and then replaced,
    /// which takes its size once more on the disk for a moment.
    ///
    /// # Errors
    /// [`OutputError::OtherRun`] when it has the id of another run, [`OutputError::Altered`] when its frames are not those that
    /// were written, [`OutputError::Trajectory`] when the file is no trajectory, [`OutputError::Io`] when it cannot be read or
    /// written.
    pub fn resume(
        path: &Path,
        format: TrajectoryFormat,
        model: &Model,
        run: Id,
        written: Extent,
    ) -> Result<Self, OutputError> {
        let format = format_of(format);
        own_file::check_to_continue(path).map_err(OutputError::io("continue", path))?;
        run.check(path, (format.id_of)(path), files::CHECKPOINT)?;
        Ok(Self { description: Description::new(model, run), shown: None, file: (format.resume)(path, written)? })
    }

    /// The same trajectory with the particles of these species only; an empty list stands for all.
    pub(crate) fn of_species(self, names: &[String]) -> Self {
        let shown = self.description.species.iter().map(|species| names.contains(&species.name)).collect();
        Self { shown: (!names.is_empty()).then_some(shown), ..self }
    }

    /// What has been written of the trajectory: all frames until the last [`flush`](Self::flush).
    #[must_use]
    pub fn extent(&self) -> Extent {
        self.file.extent()
    }

    /// Looks whether the trajectory under this name is still the one that was written.
    ///
    /// # Errors
    /// [`OutputError::Lost`] says what became of it.
    pub fn check(&self) -> Result<(), OutputError> {
        self.file.check()
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// [`OutputError::State`] when the state does not fit the model; [`OutputError::Io`] when a full buffer cannot be
    /// written.
    pub fn append(&mut self, state: &Reported) -> Result<(), OutputError> {
        // The file refuses arrays that differ in length.
        let is_whole = state.species.len() == state.len() && state.momenta.len() == state.len();
        let Some(shown) = self.shown.as_ref().filter(|_| is_whole) else {
            return self.file.append(&self.description, state);
        };
        if self.description.numbers.is_none() {
            let is_shown = |species: &u32| shown.get(*species as usize).copied().unwrap_or_default();
            let numbers = (0..).zip(&state.species).filter(|(_, species)| is_shown(species)).map(|(number, _)| number);
            self.description.select(numbers.collect(), state.len());
        }
        let part = state.of_particles(self.description.numbers.as_deref().unwrap_or_default());
        self.file.append(&self.description, &part)
    }

    /// Hands all frames to the disk: call it at the end of a batch, and before a checkpoint that counts on them.
    ///
    /// # Errors
    /// [`OutputError::Io`] when they cannot be written; the file then ends with the frames of the last flush that
    /// worked.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.file.flush()
    }
}

/// The links whose particles all have a place, between these places.
fn selected<const LENGTH: usize>(links: &[([u32; LENGTH], u32)], places: &[Option<u32>]) -> Vec<([u32; LENGTH], u32)> {
    let place = |number: u32| places.get(number as usize).copied().flatten();
    let placed = links.iter().filter(|(ends, _)| ends.iter().all(|end| place(*end).is_some()));
    placed.map(|(ends, kind)| (ends.map(|end| place(end).unwrap_or_default()), *kind)).collect()
}

/// The id of the run that wrote a trajectory of this name; none for another name, or where it cannot be read.
pub(super) fn id_of(name: &str, path: &Path) -> Option<Id> {
    let all = TrajectoryFormat::ALL.map(format_of);
    (all.iter().find(|format| format.file == name)?.id_of)(path)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::initial_state;
    use crate::scene;

    #[test]
    fn cells_have_velocities_by_masses_of_their_own() {
        let scene = r#"{"title": "t", "space": {"box": [9, 9]}, "time": {"step": 0.1, "steps": 1}, "temperature": 1,
            "particles": [{"species": "A", "mass": 2, "placement": {"type": "listed", "positions": [[1, 1], [4, 1], [5, 5]]},
                "velocities": {"type": "listed", "velocities": [[1, 0], [0, 2], [-1, 0.5]]}}],
            "interactions": [{"type": "voronoi", "form": "paper", "initial_masses": "uniform-density"}]}"#;
        let scene = scene::parse("t", scene, &[]).unwrap();
        let state: Reported = initial_state(&scene).into();
        let description = Description::new(scene.model(), Id::of_run(&scene));
        assert!(description.changing_masses);
        let masses = [0, 1, 2].map(|cell| description.kinematics.mass(&state, cell));
        assert!((masses.iter().sum::<f64>() - 6.0).abs() < 1e-9 && masses[0] != masses[1], "{masses:?}");
        for (cell, expected) in [[1.0, 0.0], [0.0, 2.0], [-1.0, 0.5]].iter().enumerate() {
            let found = description.kinematics.velocity(&state, cell);
            assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-5), "{cell}: {found:?}");
        }
    }

    #[test]
    fn a_trajectory_of_a_species_has_its_particles_its_bonds_and_their_numbers() {
        let scene = scene::load("surfactants", &["output={}".to_owned()]).unwrap();
        let state: Reported = initial_state(&scene).into();
        let names: Vec<&str> = scene.model().species.iter().map(|species| species.name.as_str()).collect();
        let kept = names.iter().position(|name| *name == "tail").unwrap() as u32;
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("trajectory.xyz");
        let writer =
            TrajectoryWriter::create(&path, TrajectoryFormat::ExtendedXyz, scene.model(), Id::of_run(&scene)).unwrap();
        let mut writer = writer.of_species(&["tail".to_owned()]);
        writer.append(&state).unwrap();
        writer.flush().unwrap();
        let numbers = writer.description.numbers.clone().unwrap();
        let expected: Vec<u32> =
            (0..state.len() as u32).filter(|number| state.species[*number as usize] == kept).collect();
        assert_eq!(numbers, expected);
        let all = Description::new(scene.model(), Id::of_run(&scene));
        let within = all.bonds.iter().filter(|(ends, _)| ends.iter().all(|end| numbers.contains(end)));
        let within: Vec<([u32; 2], u32)> = within.copied().collect();
        assert!(!within.is_empty() && within.len() < all.bonds.len(), "{} of {}", within.len(), all.bonds.len());
        let back = writer.description.bonds.iter().map(|(ends, kind)| (ends.map(|end| numbers[end as usize]), *kind));
        assert_eq!(back.collect::<Vec<_>>(), within);
        let text = std::fs::read_to_string(&path).unwrap();
        let ids = text.lines().skip(2).map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            (words[words.len() - 2].parse::<u32>().unwrap(), words[words.len() - 1].to_owned())
        });
        let (ids, species): (Vec<u32>, Vec<String>) = ids.unzip();
        assert_eq!(ids, numbers);
        assert!(species.iter().all(|name| name == "tail"));
    }

    #[test]
    fn a_species_without_particles_leaves_empty_frames() {
        let directory = tempfile::tempdir().unwrap();
        let none = r#"particles=[{"species":"A","count":8},{"species":"B","count":0}]"#;
        let scene = scene::load("dpd-fluid", &[none.to_owned(), "output={}".to_owned()]).unwrap();
        let state: Reported = initial_state(&scene).into();
        for format in TrajectoryFormat::ALL {
            let path = directory.path().join(trajectory(format));
            let id = Id::of_run(&scene);
            let mut writer =
                TrajectoryWriter::create(&path, format, scene.model(), id).unwrap().of_species(&["B".to_owned()]);
            writer.append(&state).unwrap();
            writer.append(&state).unwrap();
            writer.flush().unwrap();
            let written = writer.extent();
            TrajectoryWriter::resume(&path, format, scene.model(), id, written).unwrap();
        }
    }

    #[test]
    fn particles_of_water_have_masses_of_their_own_and_tracers_none() {
        let scene = scene::load("jet-instability", &[]).unwrap();
        let state: Reported = initial_state(&scene).into();
        let description = Description::new(scene.model(), Id::of_run(&scene));
        let masses: Vec<f64> = (0..state.len()).map(|particle| description.kinematics.mass(&state, particle)).collect();
        let nodes = 128.0 * 128.0;
        assert!((masses.iter().sum::<f64>() - nodes).abs() < 1e-9);
        assert!(masses[..262_144].iter().all(|mass| *mass > 0.0) && masses[262_144..].iter().all(|mass| *mass == 0.0));
    }
}
