//! The plan of a scene of Voronoi DPD: Flekkøy, Coveney and De Fabritiis, doi:10.1103/PhysRevE.62.2140.
//!
//! Particles are brought into an order that depends on their positions and numbers only, every cell clips its polygon, the
//! owner of each face computes what crosses it and hands it to both cells in integers, and the cells take it up. What is
//! summed in single precision, for the solver of the friction, is summed in that order: a run depends neither on the order
//! of storage before nor on the size of workgroups.

mod tessellation;

use super::{Buffer, Contents, Grid, Kernel, Layout, Options, Plan, Quanta};
use crate::model::{Model, Voronoi};
use crate::noise::stream;
use crate::scene::Output;

/// Makes the plan of a model of Voronoi cells.
pub(super) fn plan(model: &Model, cells: &Voronoi, _output: &Output, options: Options) -> Plan {
    let particles = model.particle_count();
    let grid = grid(model, particles);
    let layout = Layout::Cells { energies: cells.keeps_energy() };
    let plan = Plan::new(model, grid.cells, layout, quanta(model), stream::FACE);
    let mut builder = Builder { model, cells, grid, particles, options, plan };
    builder.constants();
    builder.buffers();
    let geometry = builder.geometry();
    builder.plan.report = geometry;
    builder.plan
}

/// About one particle a cell: a Voronoi cell then sees about thirty candidates for its neighbours.
fn grid(model: &Model, particles: u64) -> Grid {
    let width = (model.units.volume() / particles.max(1) as f64).sqrt();
    Grid::new(&model.units, width, particles)
}

fn quanta(_model: &Model) -> Quanta {
    Quanta {
        energy: 1.0,
        pair_energy: 1.0,
        force_squared: 0.0,
        curvature: 0.0,
        length_squared: 0.0,
        velocity_squared: 0.0,
        bath_squared: 0.0,
    }
}

struct Builder<'a> {
    model: &'a Model,
    cells: &'a Voronoi,
    grid: Grid,
    particles: u64,
    options: Options,
    plan: Plan,
}

impl Builder<'_> {
    fn constants(&mut self) {
        let units = self.model.units;
        let unit = |axis: usize| units.lengths[axis] / 4_294_967_296.0;
        self.plan.constants = vec![
            ("UNIT_X", unit(0)),
            ("UNIT_Y", unit(1)),
            ("CELLS_X", f64::from(self.grid.cells[0])),
            ("CELLS_Y", f64::from(self.grid.cells[1])),
            ("CELLS", self.grid.count() as f64),
            ("PARTICLES", self.particles as f64),
            ("WORKGROUP", self.options.workgroup() as f64),
        ];
    }

    /// Workgroups with a lane for each of some things.
    fn groups(&self, things: u64) -> u64 {
        things.div_ceil(self.options.workgroup()).max(1)
    }

    /// Adds a kernel of the plane with further modules.
    fn kernel(&mut self, name: &'static str, modules: &[&'static str], workgroups: u64) -> usize {
        let space = ["common/space2", "common/particle", "common/control", "common/dispatch"];
        self.bare_kernel(name, [&space[..], modules].concat(), workgroups)
    }

    fn bare_kernel(&mut self, name: &'static str, modules: Vec<&'static str>, workgroups: u64) -> usize {
        self.plan.kernels.push(Kernel {
            name,
            modules,
            workgroups: workgroups.max(1) as u32,
            demand: None,
            constants: Vec::new(),
            renamed: Vec::new(),
        });
        self.plan.kernels.len() - 1
    }

    fn buffer(&mut self, name: &'static str, purpose: &'static str, bytes: u64) {
        let bytes = bytes.max(64).next_multiple_of(16);
        self.plan.buffers.push(Buffer { name, purpose, bytes, contents: Contents::Zeros });
    }

    fn buffers(&mut self) {
        self.buffer("control", "clock, key of the step's random words, failures", 64);
        self.buffer("particles", "cells: place, mass, number, momentum, energy, species", 32 * self.particles);
    }
}
