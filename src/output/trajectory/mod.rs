//! Positions and velocities for other tools: OVITO, freud, `MDAnalysis`.

mod extended_xyz;
mod gsd;

use super::OutputError;
use crate::model::{Model, Species};
use crate::scene::TrajectoryFormat;
use crate::state::{State, Units};
use std::path::Path;

/// A trajectory, open for writing. Frames reach the disk at [`flush`](Self::flush), always whole.
#[derive(Debug)]
pub struct TrajectoryWriter {
    description: Description,
    file: Format,
}

#[derive(Debug)]
enum Format {
    Gsd(Box<gsd::GsdTrajectory>),
    ExtendedXyz(extended_xyz::ExtendedXyz),
}

/// What a frame needs to know beside the state.
#[derive(Debug, Clone)]
struct Description {
    units: Units,
    time_step: f64,
    species: Vec<Species>,
    /// Value of one unit of integer mass, where every particle has a mass of its own.
    mass_unit: Option<f64>,
    /// Numbers of bonded particles and kind of the bond.
    bonds: Vec<([u32; 2], u32)>,
}

impl Description {
    fn new(model: &Model) -> Self {
        Self {
            units: model.units,
            time_step: model.time_step,
            species: model.species.clone(),
            mass_unit: model.shallow_water.as_ref().map(|water| water.mass_unit),
            bonds: model.bonds.iter().flat_map(|bonds| &bonds.bonds).map(|bond| (bond.ends, bond.kind)).collect(),
        }
    }

    fn species_of(&self, state: &State, particle: usize) -> &Species {
        &self.species[state.species[particle] as usize]
    }

    fn mass(&self, state: &State, particle: usize) -> f64 {
        match (self.mass_unit, state.masses.get(particle)) {
            (Some(unit), Some(mass)) => f64::from(*mass) * unit,
            _ => self.species_of(state, particle).mass,
        }
    }

    /// In shallow water momenta are per unit of mass, and the mass of the species is 1.
    fn velocity(&self, state: &State, particle: usize) -> [f64; 3] {
        let mass = self.species_of(state, particle).mass;
        self.units.momentum(state.momenta[particle]).map(|momentum| momentum / mass)
    }

    /// Frames index the arrays of a state by particle and the species by the state: both must fit.
    fn check(&self, path: &Path, state: &State) -> Result<(), OutputError> {
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
    /// Creates the trajectory; one that exists is emptied.
    ///
    /// # Errors
    /// [`OutputError::Io`] when the file cannot be created.
    pub fn create(path: &Path, format: TrajectoryFormat, model: &Model) -> Result<Self, OutputError> {
        let file = match format {
            TrajectoryFormat::Gsd => Format::Gsd(Box::new(gsd::GsdTrajectory::create(path)?)),
            TrajectoryFormat::ExtendedXyz => Format::ExtendedXyz(extended_xyz::ExtendedXyz::create(path)?),
        };
        Ok(Self { description: Description::new(model), file })
    }

    /// Continues the trajectory of an earlier run after its last frame whose step is at most `step`; later frames are
    /// dropped. Extended XYZ is cut in place. A GSD file with later frames is copied without them and then replaced,
    /// which takes its size once more on the disk for a moment.
    ///
    /// # Errors
    /// [`OutputError::Trajectory`] or [`OutputError::Line`] when the file is not such a trajectory,
    /// [`OutputError::Io`] when it cannot be read or written.
    pub fn resume(path: &Path, format: TrajectoryFormat, model: &Model, step: u64) -> Result<Self, OutputError> {
        let file = match format {
            TrajectoryFormat::Gsd => Format::Gsd(Box::new(gsd::GsdTrajectory::resume(path, step)?)),
            TrajectoryFormat::ExtendedXyz => Format::ExtendedXyz(extended_xyz::ExtendedXyz::resume(path, step)?),
        };
        Ok(Self { description: Description::new(model), file })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// [`OutputError::State`] when the state does not fit the model; [`OutputError::Io`] when a full buffer cannot be
    /// written.
    pub fn append(&mut self, state: &State) -> Result<(), OutputError> {
        match &mut self.file {
            Format::Gsd(file) => file.append(&self.description, state),
            Format::ExtendedXyz(file) => file.append(&self.description, state),
        }
    }

    /// Hands all frames to the disk: call it at the end of a batch, and before a checkpoint that counts on them.
    ///
    /// # Errors
    /// [`OutputError::Io`] when they cannot be written; the file then ends with the frames of the last flush that
    /// worked.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        match &mut self.file {
            Format::Gsd(file) => file.flush(),
            Format::ExtendedXyz(file) => file.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::{self, placement::initial_state};

    #[test]
    fn particles_of_water_have_masses_of_their_own_and_tracers_none() {
        let scene = scene::load("jet-instability", &[]).unwrap();
        let model = Model::new(&scene);
        let state = initial_state(&scene, &model);
        let description = Description::new(&model);
        let masses: Vec<f64> = (0..state.len()).map(|particle| description.mass(&state, particle)).collect();
        let nodes = 128.0 * 128.0;
        assert!((masses.iter().sum::<f64>() - nodes).abs() < 1e-9);
        assert!(masses[..262_144].iter().all(|mass| *mass > 0.0) && masses[262_144..].iter().all(|mass| *mass == 0.0));
    }
}
