//! The plan of a scene of Voronoi DPD: Flekkøy, Coveney and De Fabritiis, doi:10.1103/PhysRevE.62.2140.
//!
//! Particles are brought into an order that depends on their positions and numbers only, every cell clips its polygon, the
//! owner of each face computes what crosses it and hands it to both cells in integers, and the cells receive it. What is
//! summed in single precision, for the solver of the friction, is summed in that order: a run depends neither on the order
//! of storage before nor on the size of workgroups.

mod exchange;
mod friction;
mod motion;
mod report;
mod tessellation;

pub(super) use friction::SOLVER;

use crate::document::{CellIntegrator, VoronoiForm};
use crate::families::particles::plan::quanta;
use crate::families::voronoi::CellLayout;
use crate::families::{Model, Voronoi};
use crate::noise::stream;
use crate::plan::{Grid, Kernel, Measured, Options, PhysicsPlan, Plan, Quanta, generator, switch};
use crate::shaders::exchange::{Form, Limit, Sweep, SweptEnergy, TurnBound, Twist};
use crate::shaders::{Array, Choices, Constant, Entry, grid, space, voronoi};

/// Makes the plan of a model of Voronoi cells.
pub(crate) fn plan(model: &Model, cells: &Voronoi, measured: &Measured, options: Options) -> PhysicsPlan {
    let particles = model.particle_count();
    let grid = grid(model, particles);
    let layout = CellLayout { energies: cells.keeps_energy() };
    let plan = model.empty_plan(grid.cells, layout, quanta(model), stream::FACE);
    let mut builder = Builder { model, cells, measured, grid, particles, options, plan };
    builder.constants();
    builder.buffers();
    builder.steps();
    builder.observables();
    PhysicsPlan {
        reported: builder.reported(),
        ordered: None,
        texture_candidates: texture_candidates(),
        followers: vec![Kernel::new("follow", Entry::FollowParticles, plane(), builder.groups(particles))],
        stride: model.physics().reach(model) / model.units.shortest_length(),
        plan: builder.plan,
    }
}

/// About one particle a cell: a Voronoi cell then sees about thirty candidates for its neighbours.
fn grid(model: &Model, particles: u64) -> Grid {
    let width = (model.units.volume() / particles.max(1) as f64).sqrt();
    Grid::new(&model.units, width, particles)
}

/// Units of the sums: those of pairs, and areas in 2⁻³² of that of a cell.
fn quanta(model: &Model) -> Quanta {
    Quanta {
        length_squared: Voronoi::mean_volume(model).log2().ceil().exp2() * 2_f64.powi(-32),
        ..quanta::quanta(model)
    }
}

/// The plane and the cells in it.
fn plane() -> Choices {
    Choices::new().with(space::Dimension::Two).with(space::MassOfParticle::Own)
}

/// Buffers that may be held in textures.
fn texture_candidates() -> Vec<Array> {
    vec![Array::Cells, Array::Ranks, Array::Particles, Array::Sorted]
}

struct Builder<'a> {
    model: &'a Model,
    cells: &'a Voronoi,
    measured: &'a Measured,
    grid: Grid,
    particles: u64,
    options: Options,
    plan: Plan,
}

impl Builder<'_> {
    fn constants(&mut self) {
        let (units, cells) = (self.model.units, self.cells);
        let unit = |axis: usize| units.lengths[axis] / 4_294_967_296.0;
        self.plan.constants = vec![
            generator(self.model.generator),
            switch(Constant::AsPrinted, cells.form == VoronoiForm::Paper),
            switch(Constant::Held, false),
            (Constant::UnitX, unit(0)),
            (Constant::UnitY, unit(1)),
            (Constant::CellsX, f64::from(self.grid.cells[0])),
            (Constant::CellsY, f64::from(self.grid.cells[1])),
            (Constant::Cells, self.grid.count() as f64),
            (Constant::Particles, self.particles as f64),
            (Constant::Workgroup, self.options.workgroup() as f64),
            (Constant::MassUnit, cells.mass_unit),
            (Constant::MomentumUnit, units.momentum),
            (Constant::EnergyUnit, cells.energy_unit),
            (Constant::ImpulseSteps, 1.0 / units.momentum),
            (Constant::MassSteps, 1.0 / cells.mass_unit),
            (Constant::EnergySteps, 1.0 / cells.energy_unit),
            // Rounding of single precision at a few hundred times what a cell usually has of it in a step.
            (Constant::EnergySlack, 4096.0 * cells.energy_unit),
            (Constant::Temperature, self.model.temperature),
            (Constant::MolecularMass, cells.molecular_mass),
            (Constant::ExchangeLimit, cells.exchange_limit),
            (Constant::Viscosity, cells.viscosity * self.model.time_step),
            (Constant::Conductivity, cells.conductivity.unwrap_or(0.0) * self.model.time_step),
            (Constant::DisplacementLimit, self.model.physics().reach(self.model)),
        ];
    }

    /// Whether friction acts.
    fn rubs(&self) -> bool {
        self.cells.viscosity > 0.0
    }

    /// Whether friction has noise: cells with energies have temperatures of their own.
    fn rubs_at_random(&self) -> bool {
        self.rubs() && (self.model.temperature > 0.0 || self.cells.keeps_energy())
    }

    /// Whether heat is conducted.
    fn conducts(&self) -> bool {
        self.cells.conductivity.is_some_and(|conductivity| conductivity > 0.0)
    }

    /// Whether the limit on what crosses a face may act: on mass, heat and the volume that a turning face sweeps over.
    fn has_limits(&self) -> bool {
        self.cells.has_limits(self.model.temperature)
    }

    fn is_explicit(&self) -> bool {
        self.cells.integrator == CellIntegrator::Euler {}
    }

    /// Workgroups with a lane for each of some things.
    fn groups(&self, things: u64) -> u64 {
        things.div_ceil(self.options.workgroup()).max(1)
    }

    /// What is chosen for every kernel: the plane, the grid in it, and what cells are.
    fn choices(&self) -> Choices {
        let gas = if self.cells.keeps_energy() { voronoi::Gas::Energy } else { voronoi::Gas::Isothermal };
        plane().with(grid::Dimension::Plane).with(grid::Rows::Plain).with(gas)
    }

    /// The form of pressures and mass exchange.
    fn form(&self) -> Choices {
        let keeps_energy = self.cells.keeps_energy();
        let turned = Choices::new().with(Twist::OfFaces);
        let exchanging =
            || turned.clone().with(Form::Exchange).with_if(keeps_energy, SweptEnergy::Limited).with(Limit::Counted);
        match self.cells.form {
            VoronoiForm::Gradient if self.has_limits() => turned
                .with(Form::Gradient)
                .with(TurnBound::Bounded)
                .with(if keeps_energy { Sweep::Limited } else { Sweep::Bounded })
                .with(Limit::Counted),
            VoronoiForm::Gradient => turned.with(Form::Gradient),
            VoronoiForm::Consistent | VoronoiForm::Paper => exchanging(),
        }
    }

    /// Adds a kernel.
    fn kernel(&mut self, name: &'static str, entry: Entry, choices: &Choices, workgroups: u64) -> usize {
        self.plan.add_kernel(Kernel::new(name, entry, self.choices().and(choices), workgroups))
    }

    fn buffers(&mut self) {
        self.plan.add_buffer(Array::Control, 64);
        self.plan.add_buffer(Array::Particles, 32 * self.particles);
    }
}
