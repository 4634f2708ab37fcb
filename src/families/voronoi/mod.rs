//! Voronoi DPD: particles that are the cells of a tessellation.

pub(crate) mod checks;
mod description;
mod layout;
pub(crate) mod model;
mod observables;
mod pictures;
mod plan;
pub mod reference;
mod start;
mod tally;
mod time_scales;
mod warnings;

pub use layout::CellLayout;

use super::pictures::{CellValues, EnergyChart};
use super::reference::Stepper;
use super::{
    Checked, Column, KeptQuantity, KeptSum, Limit, Model, NETWORK_VISCOSITY, Observables, Physics, PictureKind,
    Species, Tally, Voronoi, conservation, units,
};
use crate::document::{InitialMasses, ParticleGroup, Problems, Scene, SnapshotColor, Warning};
use crate::plan::{Hardware, Measured, Options, PhysicsPlan, Plan};
use crate::shaders::Sum;
use crate::state::{Reported, State};
use crate::tessellation::Tessellation;
use reference::VoronoiReference;
use std::ops::Range;

impl Physics for Voronoi {
    fn momentum_unit(&self, scene: &Scene, species: &[Species]) -> f64 {
        // Cells that come close throw each other apart, at steps that are too long for them by hundreds of these momenta.
        units::momentum_unit(scene, species, None, 20.0)
    }

    /// Those that jump over many others see nothing of them, and none may go round the box.
    fn reach(&self, model: &Model) -> f64 {
        (8.0 * Self::mean_volume(model).sqrt()).min(0.4 * model.units.shortest_length())
    }

    fn reach_in_words(&self) -> &'static str {
        "eight widths of a cell or what is safe in this box"
    }

    fn longest_step(&self, model: &Model) -> f64 {
        self.longest_resolved_step(model)
    }

    fn has_potential(&self) -> bool {
        // Pressures that follow from the gradient of a free energy.
        !self.exchanges_mass() && !self.keeps_energy()
    }

    fn is_free(&self) -> bool {
        true
    }

    fn is_conservative(&self, _: &Model) -> bool {
        self.viscosity == 0.0 && self.has_potential()
    }

    fn has_thermostat(&self, model: &Model) -> bool {
        self.viscosity > 0.0 && model.temperature > 0.0 && !self.keeps_energy()
    }

    fn mass_unit(&self) -> Option<f64> {
        Some(self.mass_unit)
    }

    fn changes_masses(&self) -> bool {
        self.exchanges_mass()
    }

    fn limits(&self, scene: &Checked) -> Vec<Limit> {
        warnings::limits(self, scene)
    }

    fn warnings(&self, scene: &Checked) -> Vec<Warning> {
        warnings::warnings(self, scene)
    }

    fn set_in_motion(&self, state: &mut State, _: &ParticleGroup, ids: Range<usize>, _: &Model) {
        // Masses differ from cell to cell, and are known only once all are.
        state.momenta.resize(ids.end, [0; 3]);
    }

    fn complete_start(&self, state: &mut State, scene: &Checked, _: &[Range<usize>]) {
        start::fill(state, scene, self);
    }

    fn may_refuse_starts(&self) -> bool {
        self.initial_masses != InitialMasses::Equal || self.keeps_energy()
    }

    fn check_start(&self, scene: &Checked, state: &State, problems: &mut Problems) {
        start::check_masses(scene, self, &state.masses, problems);
        start::check_places(self, state, problems);
    }

    fn check_step(&self, scene: &Checked, problems: &mut Problems) {
        time_scales::check(self, scene, problems);
    }

    fn plan(&self, model: &Model, measured: &Measured, _: Hardware, options: Options) -> PhysicsPlan {
        self::plan::plan(model, self, measured, options)
    }

    fn description(&self, scene: &Checked, _: &Plan, cells: &str) -> Vec<(&'static str, String)> {
        let mut rows = vec![("search grid", cells.to_owned())];
        rows.extend(description::fluid(self, scene.model()));
        rows
    }

    fn known_viscosities(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("viscosity_of_friction", self.viscosity),
            ("viscosity_of_the_network", NETWORK_VISCOSITY * self.viscosity),
        ]
    }

    fn tally(&self) -> Option<&dyn Tally> {
        Some(self)
    }

    fn energy_chart(&self, model: &Model) -> EnergyChart {
        let temperature = Some(model.temperature).filter(|_| !self.keeps_energy());
        EnergyChart { temperature, ..EnergyChart::of("cell", model.particle_count(), model.units.dimension) }
    }

    fn cell_values(
        &self,
        color: SnapshotColor,
        state: &Reported,
        tessellation: &Tessellation,
        model: &Model,
    ) -> Option<CellValues> {
        pictures::cell_values(self, color, state, tessellation, model)
    }

    fn picture(&self) -> PictureKind {
        PictureKind::Cells
    }

    fn observables(&self, step: u64, sums: &[i64], plan: &Plan, model: &Model) -> Observables {
        observables::observables(step, sums, plan, model, self)
    }

    fn columns(&self, model: &Model) -> Vec<Column> {
        observables::columns(self, model)
    }

    fn kept(&self, model: &Model, state: &State) -> Vec<KeptSum> {
        let sums = observables::sums(self, model);
        let mut kept: Vec<KeptSum> =
            conservation::mass(state, KeptQuantity::Mass, &sums, self.mass_unit).into_iter().collect();
        kept.extend(conservation::momentum(state, &sums, model.units.dimension, model.units.momentum));
        if let Some(place) = sums.place(Sum::TotalEnergy) {
            let total = state.energies.iter().map(|energy| i64::from(*energy)).sum();
            let (quantity, unit) = (KeptQuantity::Energy, self.energy_unit);
            kept.push(KeptSum { quantity, direction: "", unit, parts: vec![(place, 1)], total });
        }
        kept
    }

    fn fate_of_energy(&self, model: &Model) -> String {
        let fate = match (self.viscosity > 0.0, model.temperature > 0.0) {
            (true, true) => "exchanged with the fluid inside the cells, which is at the temperature of the scene",
            (true, false) => "taken away by friction",
            (false, _) if self.exchanges_mass() => "exchanging mass is no motion in a potential",
            (false, _) => conservation::INTEGRATED,
        };
        fate.to_owned()
    }

    fn momentum_out_of_range(&self, _: &Plan) -> String {
        "a momentum is more than 1024 times its natural scale".to_owned()
    }

    fn crowd(&self, _: &Model) -> &'static str {
        "a cell has more corners than its capacity"
    }

    fn reference(&self, model: &Model, state: &State) -> Option<Box<dyn Stepper>> {
        Some(Box::new(VoronoiReference::new(model.clone(), state.clone())?))
    }
}
