//! The scene as a whole: box, clock, noise.

use super::defaults::whole;
use super::{
    Change, DpdInteraction, EarlierRun, FileStart, Generator, Interaction, KeptStart, MeshFields, Molecule,
    NumberedGroup, Origin, Output, ParticleGroup, Shear, Stage, StateFile, StateVelocities, System, Walls,
};
use crate::noise::seed_from_state;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A simulation scene: everything a run needs to know.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = amounts_or_a_file)]
pub struct Scene {
    /// Where an editor finds the schema of this file; ignored by the program.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Version of the scene format.
    #[serde(default = "whole::<1>")]
    #[schemars(range(min = 1, max = 1))]
    pub version: u32,
    /// One line that names the scene; it heads every plot.
    #[schemars(length(min = 1))]
    pub title: String,
    /// What the scene is for and what to expect of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Seed of every random number in the run.
    #[serde(default)]
    pub seed: u64,
    /// The simulation box; left out, that of the file of `state`.
    #[serde(default)]
    pub space: Space,
    /// A file that the particles start from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles", "shallow-water"], "x-instead" = {
        "voronoi": "no `state` in Voronoi DPD: its cells have masses and energies, which files of particles do not have",
    }))]
    pub state: Option<StateFile>,
    /// Molecules, in place of numbers of particles in groups: all particles of the scene are beads of one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1024), extend("x-of" = ["particles"]))]
    pub molecules: Vec<Molecule>,
    /// Time step and duration.
    pub time: Time,
    /// Temperature kT of the heat bath, in units of energy. Zero switches the noise off.
    #[schemars(range(min = 0.0))]
    pub temperature: f64,
    /// How random numbers are generated.
    #[serde(default)]
    pub noise: Noise,
    /// Groups of particles.
    #[schemars(length(max = 1024))]
    pub particles: Vec<ParticleGroup>,
    /// The kind of the system, with its interactions and its integrator.
    #[serde(flatten)]
    pub system: System,
    /// What the run writes.
    #[serde(default)]
    pub output: Output,
    /// Numbers that a program will change between the steps of a simulation: units are chosen for the largest values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1024))]
    pub announced: Vec<Announced>,
    /// Stages of the run, one after the other, which share its steps among them: `time.steps` is the sum of theirs. Analyses are of the
    /// last one, and means too; the table of energies, frames and pictures are of all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256))]
    pub stages: Vec<Stage>,
    /// The largest force of a bond in all of the run; a stage may have one of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-of" = ["particles"]))]
    pub push_off: Option<f64>,
    /// What was read of the file of `state`, or follows from `molecules`.
    #[serde(skip)]
    pub kept: KeptStart,
}

/// A number of a scene that will change between steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Announced {
    /// Its path, as in overrides: `temperature`, `interactions.0.repulsion`.
    #[schemars(length(min = 1))]
    pub key: String,
    /// The value of the largest magnitude that it will have.
    pub largest: f64,
}

/// Takes zero, which is no default of anybody, out of the schema.
fn without_default(schema: &mut schemars::Schema) {
    if let Some(steps) = schema.pointer_mut("/properties/steps").and_then(serde_json::Value::as_object_mut) {
        steps.remove("default");
    }
}

/// States in the schema that a scene says how large its box is and how many particles are in a group, or that a file or molecules do; and
/// how many steps there are, or that stages do.
fn amounts_or_a_file(schema: &mut schemars::Schema) {
    let listed = serde_json::json!({
        "required": ["placement"],
        "properties": {"placement": {"properties": {"type": {"const": "listed"}}}},
    });
    let given = |key: &str| serde_json::json!({"required": [key], "properties": {key: {"type": "number"}}});
    let amount = serde_json::json!({
        "if": listed,
        "then": {"properties": {"number_density": {"type": "null"}}},
        "else": {"oneOf": [given("count"), given("number_density")]},
    });
    schema.insert(
        "if".to_owned(),
        serde_json::json!({"required": ["state"], "properties": {"state": {"type": "object"}}}),
    );
    let otherwise = serde_json::json!({
        "required": ["space"],
        "if": {"required": ["molecules"]},
        "else": {"properties": {"particles": {"items": amount}}},
    });
    schema.insert("else".to_owned(), otherwise);
    // The steps of stages are those of the run.
    let steps = serde_json::json!({
        "if": {"required": ["stages"]},
        "else": {"properties": {"time": {"required": ["steps"]}}},
    });
    schema.insert("allOf".to_owned(), serde_json::json!([steps]));
    if let Some(space) = schema.pointer_mut("/properties/space").and_then(serde_json::Value::as_object_mut) {
        // A box of no edges is none.
        space.remove("default");
    }
}

impl Scene {
    /// The interactions of particles, of which scenes of other kinds have none.
    #[must_use]
    pub fn interactions(&self) -> &[Interaction] {
        self.system.interactions()
    }

    /// Nodes along x and y of the mesh that it has fields on, if it has one.
    pub(crate) fn mesh(&self) -> Option<[u32; 2]> {
        self.system.shallow_water().map(|water| water.mesh)
    }

    /// Places of the interactions of this name in the list.
    pub(crate) fn places_of(&self, name: &'static str) -> impl Iterator<Item = usize> {
        let all = self.interactions().iter().enumerate();
        all.filter(move |(_, interaction)| interaction.name() == name).map(|(place, _)| place)
    }

    /// The `dpd` interactions, with their places in the list.
    pub(crate) fn pair_interactions(&self) -> impl Iterator<Item = (usize, &DpdInteraction)> {
        self.interactions().iter().enumerate().filter_map(|(index, interaction)| match interaction {
            Interaction::Dpd(dpd) => Some((index, dpd)),
            _ => None,
        })
    }

    /// True if kernels load their numbers from the start: numbers are announced or change in stages, or were changed in the simulation that
    /// it goes on with.
    pub(crate) fn loads_numbers(&self) -> bool {
        let changed = self.start().is_some_and(|start| start.changes.iter().any(Change::is_of_number));
        changed || !self.announced.is_empty() || !self.stages.is_empty()
    }

    /// The scene with the largest numbers that are announced or that stages have, if there are any: units are chosen for these. A path
    /// without a number, which a check refuses, leaves none.
    pub(crate) fn as_announced(&self) -> Option<Self> {
        let announced = self.announced_in_all();
        if announced.is_empty() {
            return None;
        }
        let mut document = serde_json::to_value(self).ok()?;
        for Announced { key, largest } in &announced {
            let place = document.pointer_mut(&format!("/{}", key.replace('.', "/")))?;
            *place = place.is_number().then(|| (*largest).into())?;
        }
        let scene: Self = serde_json::from_value(document).ok()?;
        Some(Self { kept: self.kept.clone(), announced: Vec::new(), stages: Vec::new(), ..scene })
    }

    /// What was read of the file that the particles start from, or what follows from molecules, if there are any.
    #[must_use]
    pub fn start(&self) -> Option<&Arc<FileStart>> {
        self.kept.get().filter(|_| self.has_start())
    }

    /// The fields on nodes that its particles carry at the start, where a file has them.
    pub(crate) fn fields_of_start(&self) -> Option<&MeshFields> {
        self.start()?.places.as_ref()?.fields.as_deref()
    }

    /// Whether a file or molecules say which particles there are, and where they start.
    pub(crate) fn has_start(&self) -> bool {
        self.state.is_some() || !self.molecules.is_empty()
    }

    /// Where the velocities of such particles come from.
    pub(crate) fn start_velocities(&self) -> Option<StateVelocities> {
        let thermal = (!self.molecules.is_empty()).then_some(StateVelocities::Thermal);
        self.state.as_ref().map(|state| state.velocities).or(thermal)
    }

    /// The largest component of the velocities that a species starts with, where a file says so.
    pub(crate) fn speed_from_file(&self, species: &str) -> Option<f64> {
        match self.start_velocities()? {
            StateVelocities::Thermal => None,
            StateVelocities::Rest => Some(0.0),
            StateVelocities::File => {
                let index = super::SpeciesNames::of(self).place(species)?;
                self.start()?.fastest.get(index).copied()
            }
        }
    }

    /// The earlier run that it goes on with, to the last bit, if it does.
    pub(crate) fn earlier_run(&self) -> Option<EarlierRun> {
        match self.start()?.origin? {
            Origin::Anew => None,
            Origin::Earlier(run) => Some(run),
        }
    }

    /// The seed of the noise: that of the scene, unless particles are from a file.
    pub(crate) fn noise_seed(&self) -> u64 {
        let checksum = || u32::from_str_radix(self.state.as_ref()?.checksum.as_ref()?, 16).ok();
        match self.start().and_then(|start| start.origin) {
            None => self.seed,
            Some(Origin::Anew) => checksum().map_or(self.seed, |checksum| seed_from_state(self.seed, checksum)),
            Some(Origin::Earlier(run)) => run.seed,
        }
    }

    /// Its groups with the numbers of their particles.
    pub(crate) fn numbered_groups(&self) -> impl Iterator<Item = NumberedGroup<'_>> {
        let mut next = 0_u64;
        self.particles.iter().map(move |group| {
            let (first, count) = (next, group.resolved_count(&self.space));
            next = first.saturating_add(count);
            NumberedGroup { group, first, count }
        })
    }
}

/// An orthogonal box, periodic but for axes with walls; shear displaces what is across a face.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Space {
    /// Edge lengths, one for each dimension of the scene: one, two or three.
    #[serde(rename = "box")]
    #[schemars(length(min = 1, max = 3), extend("items" = serde_json::json!({"type": "number", "exclusiveMinimum": 0})))]
    pub lengths: Vec<f64>,
    /// Plane walls at the faces of the box.
    #[serde(default, skip_serializing_if = "Walls::is_empty")]
    #[schemars(extend("x-of" = ["particles"]))]
    pub walls: Walls,
    /// Shear flow by periodic boundaries that move past each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"]))]
    pub shear: Option<Shear>,
}

/// Time step and duration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = without_default)]
pub struct Time {
    /// Time step.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub step: f64,
    /// Number of steps; of a run with stages the sum of theirs, which may be left out.
    #[serde(default)]
    pub steps: u64,
    /// Steps at the start that averages and correlations leave out.
    #[serde(default)]
    pub equilibration: u64,
}

/// How random numbers are generated.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// The counter-based generator.
    #[serde(default)]
    pub generator: Generator,
    /// The distribution of the noise on a pair without memory whose velocity relaxes in one stage; all other noise is Gaussian.
    #[serde(default)]
    pub distribution: Distribution,
}

/// The distribution of a pair's noise; both have zero mean and unit variance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Uniform on (-√3, √3): sufficient for a sum over many pairs and steps, and the cheapest (default). At long steps it is less accurate: it
    /// raises the configurational temperature of `groot-warren` by 0.003 at a step of 0.06.
    #[default]
    Uniform,
    /// Gaussian, by Box and Muller's transform; a step takes 7 to 17 % longer.
    Gaussian,
}

impl Space {
    /// Volume of the box (area in two dimensions).
    pub(crate) fn volume(&self) -> f64 {
        self.lengths.iter().product()
    }

    /// The shortest edge of the box.
    pub(crate) fn shortest_length(&self) -> f64 {
        self.lengths.iter().copied().fold(f64::INFINITY, f64::min)
    }
}
