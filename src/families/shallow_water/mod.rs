//! Rotating shallow water by the Hamiltonian particle-mesh method.

mod carried;
pub(crate) mod checks;
pub mod circulation;
mod description;
mod fields;
pub mod flow;
mod layout;
pub(crate) mod model;
mod observables;
mod plan;
pub mod reference;
mod small_scene;
mod spectra;
mod start;
mod steady;
pub mod surface;
mod warnings;
mod waves;

pub use layout::{Bins, WaterLayout};
pub use plan::smoothing;

use super::pictures::{EnergyChart, MeshPictures};
use super::reference::Stepper;
use super::{
    BathStep, Beyond, Checked, Column, ExactMean, KeptQuantity, KeptSum, Limit, MaterialLoops, Model, Observables,
    Physics, PictureKind, ShallowWater, Species, WaveShell, column, conservation, speeds,
};
use crate::document::{
    FieldQuantity, ParticleGroup, Problems, Scene, SmoothingSolver, Warning, WaterIntegrator, brief,
};
use crate::numbers::{grouped, with_error};
use crate::plan::{Hardware, Measured, Options, PhysicsPlan, Plan, Rows};
use crate::quantity::Quantity;
use crate::shaders::Constant;
use crate::state::{Reported, State};
use plan::Arithmetic;
use reference::ShallowWaterReference;
use std::ops::Range;

/// Units of the largest velocity, with one bit to spare.
const VELOCITY_RANGE: f64 = 1_073_741_824.0;

impl Physics for ShallowWater {
    fn momentum_unit(&self, scene: &Scene, _: &[Species]) -> f64 {
        velocity_unit(scene, self)
    }

    /// Half round the box, by a path that bends.
    fn reach(&self, model: &Model) -> f64 {
        let [ahead, aside] = self.path(model.time_step);
        0.5 * model.units.shortest_length() * model.time_step / (ahead.abs() + aside.abs())
    }

    fn reach_in_words(&self) -> &'static str {
        "half round the box"
    }

    /// That of the carriers, each of which has the mass of some nodes.
    fn mean_mass(&self, group: &ParticleGroup) -> f64 {
        if group.tracer { 0.0 } else { self.nodes() as f64 / self.carriers.max(1) as f64 }
    }

    fn longest_step(&self, model: &Model) -> f64 {
        let [x, y, _] = model.units.lengths;
        self.advisable_step([x, y], model.time_step)
    }

    fn has_potential(&self) -> bool {
        true
    }

    fn has_memory(&self) -> bool {
        self.bath.is_some_and(|bath| bath.remembers())
    }

    fn is_free(&self) -> bool {
        false
    }

    fn is_conservative(&self, _: &Model) -> bool {
        self.bath.is_none()
    }

    /// A flow that a bath slows down is far from its temperature for as long as it flows.
    fn has_thermostat(&self, model: &Model) -> bool {
        self.starts_still && self.is_heated(model)
    }

    /// ⟨s²⟩ = kT λ/c₀² of the continuous motion of baths that remember and forget.
    fn exact_means(&self, model: &Model) -> Vec<ExactMean> {
        let forgets = |bath: &BathStep| bath.remembers() && bath.persistence < 1.0;
        let bath = self.bath.filter(|bath| forgets(bath) && self.has_thermostat(model));
        let mean = |bath: BathStep| ExactMean {
            column: column::BATH_SQUARE.name,
            continuous: model.temperature * bath.continuous_coupling / self.wave_speed.powi(2),
            discrete: None,
        };
        bath.map(mean).into_iter().collect()
    }

    fn is_resolved_by_particles(&self) -> bool {
        true
    }

    fn is_heated(&self, model: &Model) -> bool {
        self.bath.is_some_and(|bath| bath.coupling > 0.0) && model.temperature > 0.0
    }

    fn steady_field(&self, quantity: FieldQuantity, scene: &Checked) -> Option<Vec<f64>> {
        steady::field(self, scene, quantity)
    }

    fn mass_unit(&self) -> Option<f64> {
        Some(self.mass_unit)
    }

    fn has_specific_momenta(&self) -> bool {
        true
    }

    fn limits(&self, scene: &Checked) -> Vec<Limit> {
        let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
        let share = self.stability(lengths, scene.time.step);
        vec![
            Limit { law: "p = 1, water spread evenly", share, beyond: Beyond::Unstable },
            Limit { law: "p at random places", share: share / self.clean_share(), beyond: Beyond::Unstable },
        ]
    }

    fn unneeded(&self, _: &Checked) -> Vec<String> {
        let iterates = matches!(self.smoothing.solver, SmoothingSolver::Chebyshev { .. });
        let transformable = self.mesh.iter().all(|nodes| nodes.is_power_of_two());
        let [x, y] = self.mesh;
        let found =
            format!("the smoothing solver `chebyshev`: on {x} × {y} nodes `fft` is exact and cheaper at any tolerance");
        (iterates && transformable).then_some(found).into_iter().collect()
    }

    fn warnings(&self, scene: &Checked) -> Vec<Warning> {
        warnings::warnings(self, scene)
    }

    fn set_in_motion(&self, state: &mut State, group: &ParticleGroup, ids: Range<usize>, model: &Model) {
        start::set_in_motion(self, state, group, ids, model);
    }

    fn complete_start(&self, state: &mut State, scene: &Checked, thermal: &[Range<usize>]) {
        start::complete(self, state, scene, thermal);
    }

    fn check_start(&self, scene: &Checked, state: &State, problems: &mut Problems) {
        if let Some(fields) = scene.fields_of_start() {
            carried::check(self, scene, state, fields, problems);
        }
    }

    fn plan(&self, model: &Model, measured: &Measured, hardware: Hardware, options: Options) -> PhysicsPlan {
        self::plan::plan(model, self, measured, hardware, options)
    }

    fn unshared(&self, _: &Scene) -> Vec<String> {
        Vec::new()
    }

    fn rows(&self) -> Option<Rows> {
        Some(Self::rows(self))
    }

    fn undivided(&self) -> f64 {
        let arithmetic = Arithmetic::of(self);
        arithmetic.transforms / arithmetic.sum()
    }

    fn small_scene(&self, scene: &Scene) -> Option<Scene> {
        Some(small_scene::of(scene))
    }

    fn particles_in_words(&self, count: u64) -> String {
        description::particles(self, count)
    }

    fn description(&self, scene: &Checked, plan: &Plan, cells: &str) -> Vec<(&'static str, String)> {
        description::mesh(self, scene, plan, cells)
    }

    fn picture(&self) -> PictureKind {
        PictureKind::Fields
    }

    fn material_loops(&self, model: &Model) -> Option<MaterialLoops> {
        let first = self.carriers as usize;
        let place = |range: Range<usize>| range.start - first..range.end - first;
        let loops = self.closed_loops().map(|(name, range)| (name.to_owned(), place(range))).collect();
        let tracers = model.particle_count() - self.carriers;
        Some(MaterialLoops { tracers, rotation: self.rotation, spacing: self.spacing(model.units.lengths), loops })
    }

    fn energy_chart(&self, model: &Model) -> EnergyChart {
        let [columns, rows] = self.mesh;
        let subtitle = format!(
            "{} particles, mesh {columns} × {rows}, wave speed {}, rotation {}",
            grouped(self.carriers),
            with_error(self.wave_speed, None),
            with_error(self.rotation, None)
        );
        EnergyChart {
            subtitle,
            unit: Some("mass of a node × (length units/time unit)²"),
            dimension: 2,
            is_athermal: !self.has_thermostat(model),
            temperature: Some(model.temperature),
            is_conserved: self.is_conservative(model),
            ..EnergyChart::default()
        }
    }

    fn mesh_pictures(
        &self,
        quantities: &[FieldQuantity],
        state: &Reported,
        depth: &[f64],
        model: &Model,
    ) -> Option<MeshPictures> {
        Some(fields::pictures(self, quantities, state, depth, model))
    }

    fn fields(&self, scene: &Scene) -> Option<([usize; 2], Vec<Quantity>)> {
        let asked = scene.output.fields.clone().unwrap_or_default();
        let quantities = asked.quantities.iter().map(|field| fields::described(*field)).collect();
        Some((self.mesh.map(|nodes| nodes as usize), quantities))
    }

    fn nodes(&self) -> u64 {
        Self::nodes(self)
    }

    fn wave_shells(&self, model: &Model) -> Vec<WaveShell> {
        spectra::shells(self, model)
    }

    fn spectra(&self, model: &Model, state: &Reported) -> Option<Vec<[f64; 4]>> {
        (self.carriers > 0).then(|| spectra::of_state(self, model, state))
    }

    fn observables(&self, step: u64, sums: &[i64], plan: &Plan, model: &Model) -> Observables {
        observables::observables(step, sums, plan, model, self)
    }

    fn columns(&self, model: &Model) -> Vec<Column> {
        observables::columns(self, model)
    }

    fn kept(&self, _: &Model, state: &State) -> Vec<KeptSum> {
        conservation::mass(state, KeptQuantity::MeshMass, &observables::sums(), self.mass_unit).into_iter().collect()
    }

    fn kept_to_rounding(&self, _: &Model) -> Option<&'static str> {
        let loops = self.closed_loops().next().is_some();
        (loops && self.integrator == (WaterIntegrator::Gyro {})).then_some("the circulation of material loops")
    }

    fn fate_of_energy(&self, _: &Model) -> String {
        match self.bath {
            Some(_) => "exchanged with the bath on the mesh, which also slows a uniform flow down".to_owned(),
            None => conservation::INTEGRATED.to_owned(),
        }
    }

    fn fate_of_momentum(&self, _: &Model) -> Vec<&'static str> {
        vec!["the mesh is fixed in space, and a rotation turns it"]
    }

    fn momentum_out_of_range(&self, plan: &Plan) -> String {
        let limit = plan.constants.iter().find(|(name, _)| *name == Constant::VelocityLimit);
        let limit = limit.map_or(VELOCITY_RANGE, |(_, limit)| *limit);
        let reason = if limit < VELOCITY_RANGE {
            "which may go half round the box in one step"
        } else {
            "more than twice the largest expected in this scene"
        };
        format!("a velocity is above {}, {reason}", brief(limit * plan.units.momentum))
    }

    fn crowd(&self, _: &Model) -> &'static str {
        "too many particles are in one cell of the mesh"
    }

    fn reference(&self, model: &Model, state: &State) -> Option<Box<dyn Stepper>> {
        Some(Box::new(ShallowWaterReference::new(model.clone(), state.clone())?))
    }
}

/// A power of two near 2⁻²⁹ of the largest velocity expected in shallow water, where the speed of waves is a high one.
fn velocity_unit(scene: &Scene, water: &ShallowWater) -> f64 {
    let mass = water.nodes() as f64 / water.carriers.max(1) as f64;
    let scale = water.wave_speed.max(8.0 * (scene.temperature / mass).sqrt());
    let scale = scene.particles.iter().filter_map(|group| speeds::given(scene, group)).fold(scale, f64::max);
    (scale.log2().ceil() - 29.0).exp2()
}
