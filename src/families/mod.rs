//! The families of models: particles, shallow water, Voronoi cells.
//!
//! A [`Model`] is the physics that a scene asks for in numbers: species, coefficients, units. What belongs to one family is in
//! its folder: what a scene says about it and has to fulfil, its numbers, its start, and its float64 [`mod@reference`].

mod bath;
mod checked;
mod checks;
pub(crate) mod column;
pub(crate) mod conservation;
mod field;
mod fit;
pub(crate) mod fourier;
mod instability;
mod kinematics;
mod limits;
mod model;
mod observables;
pub mod particles;
pub(crate) mod pictures;
pub mod reference;
mod registry;
pub mod shallow_water;
mod speeds;
mod start;
mod tally;
mod time_axis;
mod units;
pub mod voronoi;
mod warnings;

pub use crate::document::NETWORK_VISCOSITY;
pub use bath::BathStep;
pub use checked::Checked;
pub use checks::check_start;
pub(crate) use checks::{StepCheck, check};
pub use column::Column;
pub use conservation::{KeptQuantity, KeptSum};
pub use field::{Field, FieldError};
pub use instability::Instability;
pub(crate) use kinematics::Kinematics;
pub use limits::{Beyond, LargestStep, Limit, largest_steps, limits};
pub use model::{Model, Species};
pub use observables::{BathProducts, CellObservables, Observables, OnWalls, Transfer};
pub(crate) use particles::chains::mirrored;
pub(crate) use particles::model::Alike;
pub use particles::model::{Angle, Bond, ChainGroup, Link, Walks};
pub(crate) use particles::reference::close_pairs;
pub use particles::space::shear::ShearedBox;
pub use particles::space::walls::PlaneWalls;
pub use particles::terms::angles::Angles;
pub use particles::terms::body_forces::{BodyForces, FixedImpulse};
pub use particles::terms::bonds::{BondKind, Bonds};
pub use particles::terms::coloured_noise::{ColouredNoise, Jump};
pub use particles::terms::electrostatics::{Cloud, Electrostatics};
pub use particles::terms::harmonic_chain::{ChainTrios, HarmonicChain, Likeness, SpringChain, Strand};
pub use particles::terms::langevin::PositionBath;
pub(crate) use particles::terms::pairs::surroundings;
pub(crate) use particles::terms::pairs::{FREQUENCY_LIMIT, MOST_RELAXATION, TOLERANCE};
pub use particles::terms::pairs::{ManyBodyForce, PairForce, SoftRepulsion};
pub use particles::terms::tethers::Tethers;
pub use particles::{Particles, combinations};
pub(crate) use pictures::WaveShell;
pub use pictures::{EnergyChart, PictureKind};
pub use registry::Family;
pub(crate) use registry::{check_system, complete, settle};
pub(crate) use shallow_water::model::{LARGEST_DEPTH, chebyshev_iterations};
pub use shallow_water::model::{ShallowWater, Tracers};
pub use start::{initial_state, start_in_words};
pub(crate) use tally::{Counted, Tally};
pub use time_axis::TimeAxis;
pub use voronoi::model::Voronoi;
pub use warnings::warnings;

use crate::document::{FieldQuantity, ParticleGroup, Problems, Scene, SnapshotColor, Warning};
use crate::numbers::grouped;
use crate::plan::{Hardware, Measured, Options, PhysicsPlan, Plan, Rows};
use crate::quantity::Quantity;
use crate::state::{Reported, State};
use crate::tessellation::Tessellation;
use pictures::{CellValues, MeshPictures};
use std::ops::Range;

/// Closed loops of tracers that move with the flow.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MaterialLoops {
    /// Number of all tracers, on closed loops or not.
    pub tracers: u64,
    /// Coriolis parameter.
    pub rotation: f64,
    /// Neighbours on a loop that are further apart than this have lost each other.
    pub spacing: f64,
    /// Name and place among the tracers.
    pub loops: Vec<(String, Range<usize>)>,
}

/// The mean of a column of the table of energies in equilibrium, where it is known exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ExactMean {
    /// The column.
    pub column: &'static str,
    /// The mean of the continuous motion.
    pub continuous: f64,
    /// The mean of the scheme with its time step, where that is known.
    pub discrete: Option<f64>,
}

/// What the program asks of the physics of a family.
pub(crate) trait Physics {
    /// Value of one unit of integer momentum; a power of two.
    fn momentum_unit(&self, scene: &Scene, species: &[Species]) -> f64;

    /// Empty space behind walls on each axis, where there are any: see [`crate::state::Units::gaps`].
    fn gaps(&self, _: &Scene) -> [f64; 3] {
        [0.0; 3]
    }

    /// How far along an axis a particle may move in a step, without which a run ends.
    fn reach(&self, model: &Model) -> f64;

    /// What goes as far as that, in words.
    fn reach_in_words(&self) -> &'static str;

    /// Mass of the particles of a group; their mean where masses differ.
    fn mean_mass(&self, group: &ParticleGroup) -> f64 {
        group.mass
    }

    /// The longest time step worth trying after one that failed.
    fn longest_step(&self, model: &Model) -> f64;

    /// Value of one unit of integer mass, where particles have masses of their own.
    fn mass_unit(&self) -> Option<f64> {
        None
    }

    /// Whether momenta are per unit of mass.
    fn has_specific_momenta(&self) -> bool {
        false
    }

    /// Whether masses change.
    fn changes_masses(&self) -> bool {
        false
    }

    /// Whether any force derives from a potential.
    fn has_potential(&self) -> bool;

    /// Whether any bath has a memory.
    fn has_memory(&self) -> bool {
        false
    }

    /// Whether nothing but a random force couples particles that can move to what is fixed in space.
    fn is_free(&self) -> bool;

    /// Whether means of a run are those of an equilibrium at the temperature of the scene, as far as its length allows.
    fn reaches_equilibrium(&self) -> bool {
        false
    }

    /// Whether the motion is one in a potential, whose energy is constant if it is computed exactly.
    fn is_conservative(&self, model: &Model) -> bool;

    /// Whether a heat bath keeps what moves at the temperature of the scene.
    fn has_thermostat(&self, _: &Model) -> bool {
        false
    }

    /// The laws that bound a scene, and how near to their bounds it is. Those without meaning for the scene have a share of 0.
    fn limits(&self, scene: &Checked) -> Vec<Limit>;

    /// Whether particles only say how finely a continuum is resolved, so that more of them are the same scene.
    fn is_resolved_by_particles(&self) -> bool {
        false
    }

    /// Whether heat baths take what moves to their temperature, sooner or later.
    fn is_heated(&self, model: &Model) -> bool {
        self.has_thermostat(model)
    }

    /// Means in equilibrium that are known exactly, of the motion and of the scheme.
    fn exact_means(&self, _: &Model) -> Vec<ExactMean> {
        Vec::new()
    }

    /// What is expected of the errors that a step of the scene makes, measure by measure, in words.
    fn estimates(&self, _: &Model) -> Vec<String> {
        Vec::new()
    }

    /// A field on the nodes at all times, the index of x first, where a scene starts with a flow that is steady if it is computed
    /// exactly; of [`PictureKind::Fields`] only.
    fn steady_field(&self, _: FieldQuantity, _: &Checked) -> Option<Vec<f64>> {
        None
    }

    /// Choices of a scene that take time and change nothing that is likely to be measured, in words.
    fn unneeded(&self, _: &Checked) -> Vec<String> {
        Vec::new()
    }

    /// Warnings about a scene without mistakes.
    fn warnings(&self, scene: &Checked) -> Vec<Warning>;

    /// Gives the particles of a group momenta, and masses where they have their own. The state has their places.
    fn set_in_motion(&self, state: &mut State, group: &ParticleGroup, ids: Range<usize>, model: &Model) {
        start::set_in_motion(state, group, ids, model);
    }

    /// Completes a state at step 0 whose particles are placed and move; `thermal` are those of thermal velocities.
    fn complete_start(&self, state: &mut State, scene: &Checked, thermal: &[Range<usize>]);

    /// Whether some starts are refused.
    fn may_refuse_starts(&self) -> bool {
        false
    }

    /// Refuses a start that integers or forces cannot hold.
    fn check_start(&self, _: &Checked, _: &State, _: &mut Problems) {}

    /// Refuses what integers or kernels cannot hold, which would go wrong without a sign of it.
    fn check_capacity(&self, _: &Checked, _: &mut Problems) {}

    /// Refuses a time step that is certainly unstable.
    fn check_step(&self, _: &Checked, _: &mut Problems) {}

    /// What of it several ranks cannot share, in words; nothing where they can share all.
    fn unshared(&self, _: &Scene) -> Vec<String> {
        vec!["scenes of this kind: on one rank only".to_owned()]
    }

    /// Rows of cells of a mesh, of which each of several ranks has whole ones; without a mesh the box is divided anywhere.
    fn rows(&self) -> Option<Rows> {
        None
    }

    /// The part of the arithmetic of a step that each of several ranks does for itself, as if it were alone.
    fn undivided(&self) -> f64 {
        0.0
    }

    /// The same kind of scene with a few particles, from which ranks find out whether they compute alike; a small fluid where there is none.
    fn small_scene(&self, _: &Scene) -> Option<Scene> {
        None
    }

    /// The plan of steps and reports, with what is measured.
    fn plan(&self, model: &Model, measured: &Measured, hardware: Hardware, options: Options) -> PhysicsPlan;

    /// The particles of a model, with their number.
    fn particles_in_words(&self, count: u64) -> String {
        grouped(count)
    }

    /// What `check` says of it, name by name, beside what all families have; `cells` are those of the plan in words.
    fn description(&self, scene: &Checked, plan: &Plan, cells: &str) -> Vec<(&'static str, String)>;

    /// What the particles of a file or of molecules are, and what acts on which of them, name by name.
    fn composition(&self, _: &Checked) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// The kind of pictures that a run draws.
    fn picture(&self) -> PictureKind {
        PictureKind::Particles
    }

    /// What the chart of energies is of.
    fn energy_chart(&self, model: &Model) -> EnergyChart {
        let of = EnergyChart::of("particle", model.particle_count(), model.units.dimension);
        EnergyChart { temperature: Some(model.temperature), is_conserved: self.is_conservative(model), ..of }
    }

    /// Values of cells for a colour, if that is not the one of the species; of [`PictureKind::Cells`] only.
    fn cell_values(&self, _: SnapshotColor, _: &Reported, _: &Tessellation, _: &Model) -> Option<CellValues> {
        None
    }

    /// Fields of a state with such a depth on the nodes; of [`PictureKind::Fields`] only.
    fn mesh_pictures(&self, _: &[FieldQuantity], _: &Reported, _: &[f64], _: &Model) -> Option<MeshPictures> {
        None
    }

    /// The quantities of the fields that a scene asks for, and the nodes along x and y that they have values on.
    fn fields(&self, _: &Scene) -> Option<([usize; 2], Vec<Quantity>)> {
        None
    }

    /// Shells of wave numbers of fields on a mesh; of [`PictureKind::Fields`] only.
    fn wave_shells(&self, _: &Model) -> Vec<WaveShell> {
        Vec::new()
    }

    /// Kinetic and potential energy, potential enstrophy and enstrophy of every shell.
    fn spectra(&self, _: &Model, _: &Reported) -> Option<Vec<[f64; 4]>> {
        None
    }

    /// What the device counts from the upload of a state on, if anything.
    fn tally(&self) -> Option<&dyn Tally> {
        None
    }

    /// Loops that move with the flow, if the family has them.
    fn material_loops(&self, _: &Model) -> Option<MaterialLoops> {
        None
    }

    /// Shear viscosities that follow from the parameters, by their names in a result.
    fn known_viscosities(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Nodes of a mesh.
    fn nodes(&self) -> u64 {
        0
    }

    /// The observables of a step from the sums of its report, those of the first sampler of a plan.
    fn observables(&self, step: u64, sums: &[i64], plan: &Plan, model: &Model) -> Observables;

    /// The columns of the table of energies after `step`; those without meaning for the model are left out.
    fn columns(&self, model: &Model) -> Vec<Column>;

    /// The integer sums that never change, with what they are in a state.
    fn kept(&self, model: &Model, state: &State) -> Vec<KeptSum>;

    /// What is conserved because nothing changes it.
    fn never_changes(&self) -> &'static [&'static str] {
        &[]
    }

    /// What is conserved to rounding.
    fn kept_to_rounding(&self, _: &Model) -> Option<&'static str> {
        None
    }

    /// What becomes of the total energy, where that is not kept.
    fn fate_of_energy(&self, model: &Model) -> String;

    /// What changes the total momentum, if anything.
    fn fate_of_momentum(&self, _: &Model) -> Vec<&'static str> {
        Vec::new()
    }

    /// What a momentum out of its range is, in words.
    fn momentum_out_of_range(&self, plan: &Plan) -> String;

    /// What crowds where arrays of the plan are too small.
    fn crowd(&self, _: &Model) -> &'static str;

    /// The float64 reference from a state; none for a state without what the model needs.
    fn reference(&self, model: &Model, state: &State) -> Option<Box<dyn reference::Stepper>>;
}
