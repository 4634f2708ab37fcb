//! Particles of a step in units of the scene.

use super::analyses::needs;
use crate::families::{Checked, Kinematics, Model};
use crate::plan::Need;
use crate::state::{Reported, State};
use std::sync::Arc;

/// The current step, as far as it has been looked at.
pub(super) struct Here {
    /// The state that steps are taken from.
    pub state: Arc<State>,
    /// The particles as they are reported.
    pub reported: Reported,
}

/// Particles at a step in units of the scene, in the order of their numbers: as trajectories have them.
///
/// ```
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::{Simulation, scene};
///
/// let scene = scene::load("harmonic-chain", &["output={}".to_owned()])?;
/// let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
/// let frame = simulation.frame()?;
/// assert_eq!(frame.positions.len(), frame.velocities.len());
/// assert_eq!(frame.unwrapped(0), Some(frame.positions[0]), "nothing has left the box");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Frame {
    /// The step.
    pub step: u64,
    /// Its time, in time units.
    pub time: f64,
    /// Edges of the box, in length units, one for each dimension.
    pub lengths: Vec<f64>,
    /// True for axes without walls across them.
    pub periodic: Vec<bool>,
    /// How far the copies of the box above it are displaced along x, of boxes whose boundaries shear: axis and length.
    pub displacement: Option<(usize, f64)>,
    /// Positions in the box, in length units; the third component is zero in two dimensions, and the second on a line.
    /// Particles of frozen layers lie outside of the box.
    pub positions: Vec<[f64; 3]>,
    /// Velocities at the full step, in units of length over time.
    pub velocities: Vec<[f64; 3]>,
    /// Species, as places of the names of [`Model::species`].
    pub species: Vec<u32>,
    /// How often each particle has gone round the box along every axis since the start, or since the checkpoint of a run
    /// that did not count it; zeros where boundaries shear.
    pub images: Vec<[i32; 3]>,
    /// Masses, in mass units; of shallow water in those of its depth, zero for tracers.
    pub masses: Vec<f64>,
}

impl Frame {
    pub(super) fn new(reported: &Reported, model: &Model) -> Self {
        let kinematics = Kinematics::new(model);
        let (units, step) = (model.units, reported.step);
        let particles = 0..reported.len();
        let edges = units.edges();
        let displacement = model.particles().shear.map(|shear| {
            let shift = shear.shift(model.clock(step).wrapping_mul(2));
            (shear.gradient, f64::from(shift) / 4_294_967_296.0 * units.lengths[0])
        });
        Self {
            step,
            time: model.time.at(step),
            lengths: edges[..units.dimension].to_vec(),
            periodic: units.gaps[..units.dimension].iter().map(|gap| *gap == 0.0).collect(),
            displacement,
            positions: reported
                .positions
                .iter()
                .map(|position| in_dimensions(units.position(*position), units.dimension))
                .collect(),
            velocities: particles.clone().map(|particle| kinematics.velocity(reported, particle)).collect(),
            species: reported.species.clone(),
            images: particles.clone().map(|particle| reported.image(particle)).collect(),
            masses: particles.map(|particle| kinematics.mass(reported, particle)).collect(),
        }
    }

    /// The position of a particle without turns at the boundaries: its way from the start is a difference of these. None
    /// where boundaries shear, for there a turn is no whole number of boxes.
    #[must_use]
    pub fn unwrapped(&self, particle: usize) -> Option<[f64; 3]> {
        let edge = |axis: usize| self.lengths.get(axis).copied().unwrap_or(0.0);
        let (position, image) = (self.positions.get(particle)?, self.images.get(particle)?);
        let turned = |axis: usize| position[axis] + f64::from(image[axis]) * edge(axis);
        self.displacement.is_none().then(|| std::array::from_fn(turned))
    }
}

fn in_dimensions(position: [f64; 3], dimension: usize) -> [f64; 3] {
    std::array::from_fn(|axis| if axis < dimension { position[axis] } else { 0.0 })
}

/// Adds the momenta of the linear profile that analyses of a sheared box leave out of those of split steps.
pub(super) fn with_flow(frame: &mut Reported, scene: &Checked) {
    let model = scene.model();
    let particles = model.particles();
    let Some(shear) =
        particles.shear.as_ref().filter(|_| particles.splits() && needs(&scene.output).contains(&Need::Momenta))
    else {
        return;
    };
    for ((momentum, position), species) in frame.momenta.iter_mut().zip(&frame.positions).zip(&frame.species) {
        momentum[0] += shear.flow(*species as usize, position[shear.gradient], model).round_ties_even() as i32;
    }
}
