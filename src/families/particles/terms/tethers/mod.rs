//! A spring from every particle to where it started: V = K d²/2.

mod plan;
pub(crate) mod reference;

use super::{SceneTerm, Springs, Term};
use crate::document::{Scene, TetherInteraction};
use crate::families::particles::KeptArray;
use crate::families::particles::combinations::Feature;
use crate::families::particles::model::forces::{self, RESOLUTION};
use crate::families::{Model, Particles, Species};
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// Springs from all particles to where they started.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tethers {
    /// Spring constant K.
    pub stiffness: f64,
}

impl SceneTerm for TetherInteraction {
    fn acts(&self) -> bool {
        self.stiffness > 0.0
    }

    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(Feature::Tethers, "")]
    }

    fn at_most_once(&self) -> Option<[&'static str; 2]> {
        let accepted = "one `tether` interaction; two springs to the same place are one of their summed stiffness";
        Some(["ties the same particles again", accepted])
    }

    fn is_unsplit(&self, paired: bool) -> bool {
        !paired
    }

    fn add(&self, _: &Scene, _: &mut Vec<Species>, particles: &mut Particles) {
        particles.tethers = Some(Tethers { stiffness: self.stiffness });
    }

    fn momentum(&self, particles: &forces::Particles<'_>) -> f64 {
        (particles.heaviest_mobile() * self.stiffness).sqrt() * RESOLUTION * particles.longest_edge()
    }

    fn springs(&self) -> Option<Springs> {
        Some(Springs { stiffness: self.stiffness, length: Some(0.0) })
    }
}

impl Term for Tethers {
    fn has_potential(&self) -> bool {
        true
    }

    fn is_tied_to_space(&self) -> bool {
        true
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn momentum_source(&self) -> Option<&'static str> {
        Some("every particle is tied to a point fixed in space")
    }

    fn keeps(&self, model: &Model) -> Option<KeptArray> {
        Some(KeptArray::new(Array::Tethers, StateArray::Tethers, model.particle_count()))
    }

    fn complete_start(&self, state: &mut State, _: &Model) {
        if state.tethers.is_empty() {
            state.tethers.clone_from(&state.positions);
        }
    }
}
