//! The plan of a scene whose couplings add their impulses up: listed pairs with or without memory, bonds, angles, tethers,
//! baths on coordinates, coloured noise.
//!
//! Every coupling leaves the impulses of half a step in the buffer `kicks`, in integers; the kernel `move` applies them twice
//! and drifts. That is the scheme (14)-(17) of Cotter and Reich, doi:10.1209/epl/i2003-00621-8.

mod exclusions;
mod list;
mod motion;
mod pairs;
mod reported;
mod tethers;

use super::bonded::{self, Scales};
use super::external;
use super::own;
use super::predicted;
use super::quanta;
use super::species::Species;
use super::stress;
use super::walls;
use super::{
    Grid, Kernel, Measured, Need, Options, Ordered, PARTICLE, PhysicsPlan, Plan, Reported, deviate, texture_candidates,
    words,
};
use crate::document::Integrator;
use crate::families::particles::sums::sums;
use crate::families::particles::{CoupledLayout, ListLayout, ParticleLayout};
use crate::families::{Model, PairForce};
use crate::noise::stream;
use crate::plan::Layout;
use crate::shaders::noise::Deviate;
use crate::shaders::{Array, Choices, Constant, Entry, couplings, grid, space};

/// Makes the plan of a model.
pub(crate) fn plan(model: &Model, measured: &Measured, options: Options) -> PhysicsPlan {
    let particles = model.particle_count();
    let free = PairForce::none(&model.units, model.species.len());
    let force = model.particles().pair_force.as_ref().unwrap_or(&free);
    let grid = Grid::new(&model.units, force.cutoff + force.skin, particles);
    let plan = empty_plan(model, &grid, options);
    let species = Species::of(model);
    let mut builder = Builder { model, measured, force, grid, particles, options, species, plan, report_groups: 0 };
    builder.constants();
    builder.buffers();
    builder.list();
    builder.begin_stress();
    builder.pairs();
    builder.bonded();
    builder.tethers();
    builder.body_forces();
    builder.motion();
    builder.observables();
    PhysicsPlan {
        reported: Some(builder.reported()),
        ordered: builder.ordered(),
        texture_candidates: texture_candidates(&builder.plan),
        followers: vec![Kernel::new("follow", Entry::FollowParticles, builder.choices(), builder.groups(particles))],
        stride: model.physics().reach(model) / model.units.shortest_length(),
        plan: builder.plan,
    }
}

fn empty_plan(model: &Model, grid: &Grid, options: Options) -> Plan {
    let list = model.particles().pair_force.as_ref().filter(|force| force.acts()).map(|force| ListLayout {
        capacity: list::capacity(model, force, options) as usize,
        memory: force.remembers(),
    });
    let particles = ParticleLayout {
        dimension: model.units.dimension,
        predicted: predicted(model),
        account: external::rows(model, options.workgroup()) as usize,
        walls: walls::count(model),
    };
    let layout = CoupledLayout {
        particles,
        list,
        position_baths: model.particles().position_bath.as_ref().is_some_and(|bath| bath.memory),
        bond_baths: model
            .particles()
            .bonds
            .as_ref()
            .filter(|bonds| bonds.have_memory())
            .map_or(0, |bonds| bonds.count() as usize),
        holds: model.particles().coloured_noise.is_some(),
        tethers: model.particles().tether.is_some(),
    };
    let plan = model.empty_plan(grid.cells, layout, quanta::quanta(model), stream::PAIR);
    // What is reported has no predicted momentum.
    let reported = Layout::new(ParticleLayout { predicted: false, account: 0, walls: 0, ..particles });
    Plan { reported: Some((Array::Reported, reported)), ..plan }
}

struct Builder<'a> {
    model: &'a Model,
    measured: &'a Measured,
    force: &'a PairForce,
    grid: Grid,
    particles: u64,
    options: Options,
    species: Species,
    plan: Plan,
    /// Rows of partial sums that the kernels of the report fill so far.
    report_groups: u64,
}

impl<'a> Builder<'a> {
    fn constants(&mut self) {
        let (model, units, quanta) = (self.model, self.model.units, self.plan.quanta);
        let half = 0.5 * model.time_step;
        let to_force = units.momentum / half;
        let cutoff = self.force.cutoff;
        let reach = model.physics().reach(model);
        let mass = self.species.mass();
        let mut constants = self.grid.constants(&units).to_vec();
        constants.extend([
            (Constant::Particles, self.particles as f64),
            (Constant::Workgroup, self.options.workgroup() as f64),
            (Constant::Species, model.species.len() as f64),
            (Constant::Cutoff, cutoff),
            (Constant::WeightRootExponent, 0.5 * self.force.common_weight_exponent().unwrap_or(0.0)),
            (Constant::DisplacementLimit, reach),
            (Constant::PairEnergy, to_force * cutoff / (2.0 * quanta.pair_energy)),
            (Constant::PairVirial, to_force / quanta.pair_energy),
            (Constant::Gradient, to_force * to_force / quanta.force_squared),
            (Constant::Laplacian, 2.0 * to_force / quanta.curvature),
            (Constant::Drift, model.time_step * units.momentum / mass),
            (Constant::Kinetic, units.momentum * units.momentum / (2.0 * mass * quanta.energy)),
            (Constant::InverseMass, 1.0 / mass),
            (Constant::FrictionPerLength, mass / (model.time_step * units.momentum)),
            (Constant::BathSquare, own::inverse(quanta.bath_squared)),
        ]);
        self.plan.constants = constants;
        if !self.species.have_table() {
            let [repulsion, friction, noise] = self.pair_impulses(0, 0);
            self.plan.constants.extend([
                (Constant::Repulsion, repulsion),
                (Constant::Friction, friction),
                (Constant::Noise, noise),
            ]);
        }
        if let Integrator::GrootWarren { lambda } = model.integrator {
            self.plan.constants.push((Constant::Prediction, 2.0 * lambda - 1.0));
        }
        walls::add_constants(model, &mut self.plan);
    }

    /// Whether any pair of particles has a force on each other.
    fn visits_pairs(&self) -> bool {
        self.force.acts()
    }

    fn scales(&self) -> Scales<'a> {
        Scales { model: self.model, species: self.species, quanta: self.plan.quanta }
    }

    /// Impulse of half a step by a unit force, in momentum units.
    fn impulse(&self) -> f64 {
        self.scales().impulse()
    }

    /// Forgets the stresses of the last report, where an analysis needs them.
    fn begin_stress(&mut self) {
        if stress::is_needed(self.measured) {
            let clear = stress::begin(self.model, self.options.workgroup(), &mut self.plan);
            self.plan.report.push(clear);
        }
    }

    /// Bonds and angles.
    fn bonded(&mut self) {
        let stressed = stress::is_needed(self.measured);
        for bonded in bonded::all(&self.scales()) {
            let groups = self.groups(bonded.count);
            self.plan.constants.extend(bonded.constants);
            let advance = self.kernel(bonded.name, bonded.entry, &bonded.choices, groups);
            self.plan.advance.push(advance);
            let seen = bonded.observed.choices.with_any(self.forces());
            self.report_kernel(bonded.reports[0], bonded.entry, &seen, groups);
            if stressed {
                let (name, choices) = &bonded.stress;
                self.stress_kernel(name, bonded.entry, choices, groups);
            }
            self.plan.operations_per_particle += bonded.operations * bonded.count as f64 / self.particles.max(1) as f64;
        }
        let model = self.model;
        bonded::add_tables(&self.scales(), &mut self.plan);
        let Some(bonds) = model.particles().bonds.as_ref() else { return };
        if bonds.have_friction() {
            self.scales().add_bath_impulse(&mut self.plan);
        }
        if bonds.have_memory() {
            if !model.particles().walls.is_empty() && self.species.have_table() && model.has_potential() {
                // Ends that a wall may have reflected are followed back, by what their species are: beside forces one buffer too many.
                self.plan.storage_buffers = self.plan.storage_buffers.max(9);
            }
            self.plan.add_buffer(Array::BondBaths, 4 * bonds.count());
        }
    }

    /// Body forces.
    fn body_forces(&mut self) {
        if external::profile(self.model).is_none() {
            return;
        }
        let groups = self.groups(self.particles);
        let push = self.kernel("push_external", Entry::PushExternal, &Choices::new(), groups);
        self.plan.advance.push(push);
        self.plan.report.push(push);
        let (choices, workgroup, first) = (self.choices(), self.options.workgroup(), self.report_groups);
        self.report_groups += external::add_account(self.model, &choices, workgroup, first, &mut self.plan);
    }

    /// Workgroups with a lane for each of some things.
    fn groups(&self, things: u64) -> u64 {
        things.div_ceil(self.options.workgroup()).max(1)
    }

    /// What is chosen for every kernel: the space, the grid in it, the species, who draws random words, and how impulses are added.
    fn choices(&self) -> Choices {
        self.choices_without_kicks().and(&bonded::kicks(self.model.units.dimension))
    }

    fn choices_without_kicks(&self) -> Choices {
        let volume = self.model.units.dimension == 3;
        self.dimension()
            .with(if volume { grid::Dimension::Volume } else { grid::Dimension::Plane })
            .with(grid::Rows::Plain)
            .with(if predicted(self.model) { space::Particle::Predicted } else { space::Particle::Plain })
            .and(&self.species.choices())
            .with(words(self.model.generator))
            .with_any(external::profile(self.model))
            .and(&walls::choices(self.model))
    }

    /// The vector space.
    fn dimension(&self) -> Choices {
        Choices::new().with(match self.model.units.dimension {
            1 => space::Dimension::One,
            2 => space::Dimension::Two,
            _ => space::Dimension::Three,
        })
    }

    /// Gathers conservative forces at a report, if there are any.
    fn forces(&self) -> Option<couplings::Forces> {
        self.model.has_potential().then_some(match self.model.units.dimension {
            3 => couplings::Forces::Volume,
            _ => couplings::Forces::Plane,
        })
    }

    /// The noise of a pair.
    fn pair_noise(&self) -> Deviate {
        // A bath that remembers keeps the shape of its noise: only a Gaussian one has the right law.
        if self.force.remembers() { Deviate::Gaussian } else { deviate(self.model.distribution) }
    }

    /// Adds a kernel.
    fn kernel(&mut self, name: &'static str, entry: Entry, choices: &Choices, workgroups: u64) -> usize {
        self.plan.add_kernel(Kernel::new(name, entry, self.choices().and(choices), workgroups))
    }

    /// Adds a kernel of the report, which leaves its sums in rows of its own.
    fn report_kernel(&mut self, name: &'static str, entry: Entry, choices: &Choices, workgroups: u64) {
        let kernel = self.kernel(name, entry, choices, workgroups);
        self.plan.kernels[kernel].constants.push((Constant::FirstGroup, self.report_groups as f64));
        self.report_groups += u64::from(self.plan.kernels[kernel].workgroups);
        self.plan.report.push(kernel);
    }

    /// Adds a kernel that adds stresses at a report, and no impulses.
    fn stress_kernel(&mut self, name: &'static str, entry: Entry, choices: &Choices, workgroups: u64) {
        let choices = self.choices_without_kicks().and(choices);
        let kernel = self.plan.add_kernel(Kernel::new(name, entry, choices, workgroups));
        self.plan.report.push(kernel);
    }

    fn buffers(&mut self) {
        self.plan.add_buffer(Array::Control, 64);
        self.plan.add_buffer(Array::Particles, PARTICLE * self.particles);
        self.plan.add_buffer(Array::Kicks, 16 * self.particles);
        self.plan.add_buffer(Array::Reported, PARTICLE * self.particles);
        if self.species.have_table() {
            let mut table = self.coefficient_table();
            external::add_constants(self.model, Some(table.len() / 4), &mut self.plan);
            table.extend(external::entries(self.model));
            self.plan.add_table(Array::Coefficients, bytemuck::cast_slice(&table).to_vec());
        } else {
            external::add_constants(self.model, None, &mut self.plan);
        }
    }

    /// Kernels that take what the report has left, and the sampler of the observables.
    fn observables(&mut self) {
        let (choices, first_row) = (self.choices(), self.report_groups);
        self.report_groups += walls::add_account(self.model, &choices, first_row, &mut self.plan);
        self.plan.sample_observables(self.measured.every, &sums(self.model), self.report_groups);
        self.plan.finish_report.clone_from(&self.plan.advance);
    }
}
