//! The plan of a scene of shallow water.
//!
//! A step: particles are sorted by the cells of the mesh; every cell spreads its particles over the nodes, the depth is
//! smoothed, the bath takes its step; then every cell moves its particles by the slope of the surface.

use super::prefix_sum::PrefixSum;
use super::smoothing::{self, smoothing};
use super::{
    Hardware, Kernel, Measured, Options, PhysicsPlan, Plan, Quanta, Storage, Texture, Traversal, WATER, generator,
};
use crate::document::WaterIntegrator;
use crate::families::shallow_water::{Bins, WaterLayout, observables};
use crate::families::{Model, ShallowWater};
use crate::noise;
use crate::plan::switch;
use crate::shaders::{Array, Choices, Constant, Entry, arrays, grid, mesh, water};
use std::f64::consts::{FRAC_PI_2, TAU};

/// What rounding may take from the depth, relative to the mean depth and to that of a lone particle.
const DEPTH_ROUNDING: f64 = 1e-5;
/// Bytes that every adapter can bind.
const LARGEST_BINDING: u64 = 1 << 27;
/// Bytes of bins up to which they were found faster than sorting on two cores of lavapipe: at 64² nodes they are, at 128² not.
const CACHED_BINS: u64 = 1 << 24;

/// Rows of a strip of cells, as the shaders for eights of cells have it.
const STRIP: u64 = 4;
/// The fewest nodes for which eights of cells are worth their larger kernels, which take longer to compile.
const FEWEST_NODES: u64 = 1 << 12;

/// Makes the plan of a model of shallow water.
pub(crate) fn plan(
    model: &Model,
    water: &ShallowWater,
    measured: &Measured,
    hardware: Hardware,
    options: Options,
) -> PhysicsPlan {
    let by_lanes = options.butterflies_by_lanes.unwrap_or(!options.suits_serial_memory(hardware));
    let options = Options { butterflies_by_lanes: Some(by_lanes), ..options };
    let eights = takes_eights(water, hardware, options);
    // Particles that come from other ranks and go there lie in a buffer, in any order.
    let asked = if options.part.is_some() { Some(Storage::Sorted) } else { options.storage };
    let storage = asked.unwrap_or_else(|| best_storage(model, water, eights));
    let in_texels = options.part.is_none() && options.suits_serial_memory(hardware);
    let texels = in_texels && Texture::holds(places(model, water, storage), 4);
    let plan = empty_plan(model, water, storage, texels);
    let slots = water.carriers;
    let mut builder = Builder { model, water, options, storage, eights, texels, slots, stride: 0.5, plan };
    builder.plan_part();
    builder.constants();
    builder.ordering();
    builder.depth();
    builder.motion(measured);
    builder.buffers();
    PhysicsPlan {
        reported: None,
        ordered: None,
        texture_candidates: smoothing::texture_candidates(&builder.plan),
        followers: builder.followers(),
        stride: builder.stride,
        plan: builder.plan,
    }
}

/// Whether the lanes of a subgroup take eight cells side by side, row after row of a strip, share what they load and store for
/// them, and take their particles whichever their cells.
fn takes_eights(water: &ShallowWater, hardware: Hardware, options: Options) -> bool {
    let worthwhile = hardware.takes_eights() && water.nodes() >= FEWEST_NODES;
    let wanted = options.traversal.map_or(worthwhile, |asked| asked == Traversal::Clusters);
    let strips = water.mesh[0].is_multiple_of(8) && u64::from(water.mesh[1]).is_multiple_of(STRIP);
    wanted && strips && water.spline_order == 3 && options.workgroup() >= 8
}

/// Places of a bin, for particles that stay and for those that arrive in a step: more than enough for particles spread at
/// random at a speed of a third of that of waves, and twice as many spare places as that where they can be bound.
fn bin_places(model: &Model, water: &ShallowWater) -> (u64, u64) {
    let mean = water.carriers as f64 / water.nodes() as f64;
    let crossing = (0.3 * water.wave_speed * model.time_step / water.spacing(model.units.lengths)).min(1.0);
    let places = |deviations: f64| {
        let capacity = mean + (4.0 + 0.5 * deviations) * mean.sqrt() + 8.0;
        let arrivals = crossing * mean + deviations * mean.sqrt() + 5.0;
        (capacity.ceil() as u64, arrivals.ceil() as u64)
    };
    let roomy = places(4.0);
    if bin_bytes(water, roomy) <= LARGEST_BINDING { roomy } else { places(2.0) }
}

fn bin_bytes(water: &ShallowWater, (capacity, arrivals): (u64, u64)) -> u64 {
    WATER * (capacity + 2 * arrivals) * water.nodes()
}

/// Bins where they cost not much more memory than sorting and stay within what every adapter can bind; where cells are taken
/// in eights, which suits sorted particles more, only as long as bins stay in the caches of a processor.
fn best_storage(model: &Model, water: &ShallowWater, eights: bool) -> Storage {
    let bins = bin_bytes(water, bin_places(model, water));
    let sorted = 2 * WATER * water.carriers;
    let most = if eights { CACHED_BINS } else { LARGEST_BINDING };
    if bins <= 4 * sorted && bins <= most { Storage::Bins } else { Storage::Sorted }
}

/// Places for particles.
fn places(model: &Model, water: &ShallowWater, storage: Storage) -> u64 {
    match storage {
        Storage::Sorted => water.carriers,
        Storage::Bins => bin_bytes(water, bin_places(model, water)) / WATER,
    }
}

fn empty_plan(model: &Model, water: &ShallowWater, storage: Storage, texels: bool) -> Plan {
    let bath_nodes = if water.bath.is_some() { water.nodes() as usize } else { 0 };
    let layout = WaterLayout {
        carriers: water.carriers as usize,
        tracers: (model.particle_count() - water.carriers) as usize,
        bath_nodes,
        texels,
        bins: match storage {
            Storage::Sorted => None,
            Storage::Bins => {
                let (capacity, arrivals) = bin_places(model, water);
                Some(Bins {
                    cells: water.mesh,
                    capacity: capacity as usize,
                    arrivals: arrivals as usize,
                    centred: water.spline_order == 2,
                })
            }
        },
    };
    let cells = [water.mesh[0], water.mesh[1], 1];
    model.empty_plan(cells, layout, quanta(model, water), noise::stream::MESH)
}

/// Units of the sums: small against the 24 bits of a single term, and large enough for 64 bits to hold all of them. The
/// scales are a particle at the speed of waves or of heat, a node with its energy at the speed of waves, and a bath variable
/// at rest or driven by a change of the depth by a hundredth.
fn quanta(model: &Model, water: &ShallowWater) -> Quanta {
    let model = model.of_scales();
    let water = model.shallow_water().unwrap_or(water);
    let power_of_two = |value: f64| value.log2().ceil().exp2();
    let speed_squared = water.wave_speed * water.wave_speed;
    let mass = water.nodes() as f64 / water.carriers.max(1) as f64;
    let fastest = water.wave_speed.max(2_f64.powi(28) * model.units.momentum);
    let bath = water.bath.as_ref().map_or(0.0, |bath| {
        let at_rest = bath.deviation(model.temperature).powi(2) / speed_squared;
        at_rest.max((0.01 * bath.coupling).powi(2))
    });
    Quanta {
        energy: power_of_two(mass * fastest * fastest) * 2_f64.powi(-36),
        pair_energy: power_of_two(speed_squared) * 2_f64.powi(-36),
        bath_squared: power_of_two(bath.max(1e-24)) * 2_f64.powi(-32),
        ..Quanta::default()
    }
}

pub(super) struct Builder<'a> {
    pub(super) model: &'a Model,
    pub(super) water: &'a ShallowWater,
    pub(super) options: Options,
    storage: Storage,
    /// Whether the lanes of a subgroup take eight cells side by side.
    eights: bool,
    /// Whether particles are texels.
    texels: bool,
    /// Places for particles, where they are sorted.
    pub(super) slots: u64,
    /// The largest share of the box that a particle may go in a step.
    stride: f64,
    pub(super) plan: Plan,
}

impl Builder<'_> {
    pub(super) fn tracers(&self) -> u64 {
        self.model.particle_count() - self.water.carriers
    }

    fn constants(&mut self) {
        let (water, units, step) = (self.water, self.model.units, self.model.time_step);
        let spacing: [f64; 2] = std::array::from_fn(|axis| units.lengths[axis] / f64::from(water.mesh[axis]));
        let kick = |axis: usize| -0.5 * step * water.wave_speed.powi(2) / (spacing[axis] * units.momentum);
        let fraction = |axis: usize| units.momentum * 4_294_967_296.0 / units.lengths[axis];
        let angle = water.rotation * step;
        let [chord, sagitta] = water.path(step);
        // Velocities have one bit to spare for a kick; no step may go half round the box.
        let way = (chord.abs() + sagitta.abs()) * fraction(0).max(fraction(1));
        let velocity_limit = (2_f64.powi(31) / way).min(2_f64.powi(30)).floor();
        self.stride = velocity_limit * way / 2_f64.powi(32);
        let quanta = self.plan.quanta;
        let squared = water.wave_speed.powi(2);
        let carriers = water.carriers as f64;
        let mut constants = vec![
            (Constant::Workgroup, self.options.workgroup() as f64),
            (Constant::CellsX, f64::from(water.mesh[0])),
            (Constant::CellsY, f64::from(water.mesh[1])),
            (Constant::Particles, self.slots as f64),
            (Constant::Tracers, self.tracers() as f64),
            (Constant::FirstTracer, carriers),
            (Constant::KickX, kick(0)),
            (Constant::KickY, kick(1)),
            switch(Constant::Gyrates, self.gyrates()),
            (Constant::ChordX, chord * fraction(0)),
            (Constant::ChordY, chord * fraction(1)),
            (Constant::SagittaX, sagitta * fraction(0)),
            (Constant::SagittaY, sagitta * fraction(1)),
            (Constant::VelocityLimit, velocity_limit),
            (Constant::LeastDepth, -1.0 - DEPTH_ROUNDING * (1.0 + water.nodes() as f64 / carriers.max(1.0))),
            (Constant::MeanMass, water.mean_mass() as f64),
            (Constant::Kinetic, 0.5 * water.mass_unit * units.momentum.powi(2) / quanta.energy),
            (Constant::Momentum, water.mass_unit * units.momentum * water.wave_speed / quanta.energy),
            (Constant::Potential, 0.5 * squared * water.mass_unit / quanta.pair_energy),
            (Constant::BathSquare, 1.0 / quanta.bath_squared),
        ];
        let turn = if self.gyrates() { angle } else { 0.5 * angle };
        let quarters = (turn / FRAC_PI_2).round();
        let rest = (turn - quarters * FRAC_PI_2).rem_euclid(TAU);
        let rest = if rest > 0.5 * TAU { rest - TAU } else { rest };
        constants.extend([
            // Not a negative zero.
            (Constant::QuarterTurns, quarters.rem_euclid(4.0) + 0.0),
            (Constant::TurnTangent, (0.5 * rest).tan()),
            (Constant::TurnSine, rest.sin()),
        ]);
        if let Some(bath) = &water.bath {
            constants.extend([
                generator(self.model.generator),
                (Constant::Distribution, 2.0),
                (Constant::BathPersistence, bath.persistence),
                (Constant::BathResponse, bath.response() * water.mass_unit),
                (Constant::BathNoise, bath.noise(self.model.temperature) / water.wave_speed),
            ]);
        }
        self.plan.constants = constants;
    }

    /// A kernel that visits the cells.
    fn cell_kernel(&mut self, name: &'static str, choices: &Choices) -> usize {
        let rows = self.visited_rows();
        let (entry, lines) = if self.eights {
            (Entry::VisitMeshStrips, rows.end.div_ceil(STRIP) - rows.start / STRIP)
        } else {
            (Entry::VisitMeshCells, rows.end - rows.start)
        };
        self.kernel(name, entry, choices, lines * u64::from(self.water.mesh[0]))
    }

    fn gyrates(&self) -> bool {
        self.water.integrator != WaterIntegrator::Rotate {}
    }

    /// What is chosen for every kernel.
    fn choices(&self) -> Choices {
        self.choices_of_one_rank().and(&self.of_rank())
    }

    /// What is chosen however many ranks there are: the splines, where particles are kept, and what drives them.
    fn choices_of_one_rank(&self) -> Choices {
        let (spline, nodes) = match self.water.spline_order {
            1 => (mesh::Spline::Linear, mesh::Nodes::Linear),
            2 => (mesh::Spline::Quadratic, mesh::Nodes::Quadratic),
            _ => (mesh::Spline::Cubic, mesh::Nodes::Cubic),
        };
        let choices = Choices::new()
            .with(spline)
            .with(nodes)
            .with_if(self.water.bath.is_some(), mesh::Surface::Bath)
            .with_if(self.texels, arrays::Order::Texture);
        match self.storage {
            Storage::Sorted => {
                let in_place = if self.texels { water::Particles::InPlaceTextures } else { water::Particles::InPlace };
                choices.with(water::Storage::Sorted).with(water::Sorted::BySort).with(in_place)
            }
            Storage::Bins => {
                let bins = if self.texels { water::Particles::BinsTextures } else { water::Particles::Bins };
                choices.with(water::Storage::Bins).with(bins)
            }
        }
    }

    /// A kernel with a lane for each of some things.
    pub(super) fn kernel(&mut self, name: &'static str, entry: Entry, choices: &Choices, things: u64) -> usize {
        let workgroups = things.div_ceil(self.options.workgroup());
        self.plan.add_kernel(Kernel::new(name, entry, self.choices().and(choices), workgroups))
    }

    /// Counting sort by cell, where bins do not keep the order.
    fn ordering(&mut self) {
        if self.storage == Storage::Bins {
            return;
        }
        let slots = self.slots;
        let none = Choices::new();
        let bin = self.kernel("bin", Entry::BinWater, &none, slots);
        self.plan.prepare.push(bin);
        let paired = self.water.mesh[0].is_multiple_of(2);
        let rows = if paired { grid::Rows::MeshInPairs } else { grid::Rows::Mesh };
        let choices = Choices::new().with(grid::Dimension::Plane).with(rows);
        let sum = PrefixSum { choices: &choices, rows: u64::from(self.water.mesh[1]), cells: self.water.nodes() };
        self.plan.add_row_sums(sum.rows, sum.cells, self.options);
        for kernel in sum.kernels(self.options) {
            let kernel = self.plan.add_kernel(kernel);
            self.plan.sort.push(kernel);
        }
        let entry = if self.eights { Entry::OrderWaterOfEight } else { Entry::OrderWater };
        let order = self.kernel("order", entry, &none, slots);
        self.plan.sort.push(order);
        let tidied = Choices::new().with(if self.texels { water::Tidied::Textures } else { water::Tidied::Buffers });
        let tidy = self.kernel("tidy", Entry::TidyWater, &tidied, slots);
        let keep = self.kernel("keep_tidied", Entry::KeepTidiedWater, &tidied, slots);
        let back = [(Array::Particles, Array::Tidied), (Array::Tidied, Array::Particles)];
        self.plan.kernels[keep].renamed.extend(back);
        if self.texels {
            let back = [(Array::ParticleMasses, Array::TidiedMasses), (Array::TidiedMasses, Array::ParticleMasses)];
            self.plan.kernels[keep].renamed.extend(back);
        }
        self.plan.tidy = vec![tidy, keep];
    }

    /// From particles to the surface that drives them.
    fn depth(&mut self) {
        let nodes = self.water.nodes();
        let deposit = Choices::new().with(mesh::Pass::Deposit).with(match self.water.spline_order {
            1 => mesh::Spread::Linear,
            2 => mesh::Spread::Quadratic,
            _ if self.eights => mesh::Spread::CubicOfEight,
            _ => mesh::Spread::Cubic,
        });
        let deposit = self.cell_kernel("deposit", &deposit);
        let none = Choices::new();
        let gather = if self.eights {
            self.kernel("gather_nodes", Entry::GatherNodesOfEight, &none, nodes / STRIP)
        } else {
            self.kernel("gather_nodes", Entry::GatherNodes, &none, nodes)
        };
        self.plan.before_report.extend([deposit, gather]);
        self.add_up_nodes(gather);
        let lengths = [self.model.units.lengths[0], self.model.units.lengths[1]];
        let smoothing = smoothing(self.water, lengths, self.options);
        self.plan.buffers.extend(smoothing.buffers);
        let first = self.plan.kernels.len();
        self.plan.kernels.extend(smoothing.kernels);
        self.plan.before_report.extend(smoothing.order.iter().map(|kernel| first + kernel));
        let Some(bath) = &self.water.bath else { return };
        let noisy = bath.noise(self.model.temperature) > 0.0;
        let noise = Choices::new().with_if(noisy, mesh::BathNoise::Gaussian);
        let bath = self.kernel("mesh_bath", Entry::StepMeshBath, &noise, nodes);
        self.plan.before_report.push(bath);
    }

    fn motion(&mut self, measured: &Measured) {
        let groups = self.water.nodes().div_ceil(self.options.workgroup());
        let (moving, eight) = match self.storage {
            Storage::Sorted => (water::Moving::Sorted, water::Eight::Sorted),
            Storage::Bins => (water::Moving::Bins, water::Eight::Bins),
        };
        let push = Choices::new().with(moving);
        let push = if self.eights {
            push.with(mesh::Nodes::CubicOfEight).with(mesh::Pass::PushOfEight).with(eight)
        } else {
            push.with(mesh::Pass::Push)
        };
        let (push, push_on) = (self.cell_kernel("push", &push), self.cell_kernel("push_from_report", &push));
        let report = self.kernel("report", Entry::ReportWater, &Choices::new(), self.water.nodes());
        self.ends_steps([push, push_on, report]);
        self.plan.sample_observables(measured.every, &observables::sums(), groups);
        if self.tracers() > 0 {
            self.drifting();
        }
        self.exchange(measured.follows);
        self.plan.operations_per_particle = Arithmetic::of(self.water).sum();
    }

    fn drifting(&mut self) {
        let tracers = self.tracers();
        let none = Choices::new();
        let push = self.kernel("push_tracers", Entry::PushTracers, &none, tracers);
        let push_on = self.kernel("push_tracers_from_report", Entry::PushTracers, &none, tracers);
        let report = self.kernel("report_tracers", Entry::ReportTracers, &none, tracers);
        self.ends_steps([push, push_on, report]);
        self.plan.add_buffer(Array::Tracers, WATER * tracers);
    }

    /// Ends steps with the first of these kernels, reported ones with the second; the third makes the report.
    fn ends_steps(&mut self, [push, push_on, report]: [usize; 3]) {
        self.plan.kernels[push].constants.push((Constant::Closes, 1.0));
        self.plan.kernels[push_on].constants.push((Constant::Closes, 0.0));
        self.plan.advance.push(push);
        self.plan.finish_report.push(push_on);
        self.plan.report.push(report);
    }

    /// Kernels that follow particles and tracers.
    fn followers(&self) -> Vec<Kernel> {
        let groups = |things: u64| things.div_ceil(self.options.workgroup());
        let (entry, followed) = match self.storage {
            Storage::Sorted => (Entry::FollowWater, self.slots),
            Storage::Bins => (Entry::FollowBins, self.water.nodes()),
        };
        let mut kernels = vec![Kernel::new("follow", entry, self.choices(), groups(followed))];
        // Tracers, which all ranks have, the first follows.
        if self.tracers() > 0 && self.options.part.is_none_or(|part| part.rank == 0) {
            let stored = self.choices_of_one_rank().with(water::Particles::InPlace);
            let follow = Kernel::new("follow_tracers", Entry::FollowWater, stored, groups(self.tracers()));
            let count = vec![(Constant::Particles, self.tracers() as f64)];
            kernels.push(follow.with(count).renamed(vec![(Array::Particles, Array::Tracers)]));
        }
        kernels
    }

    /// A buffer of so many particles, or two textures: of their motion, and of their masses and numbers.
    fn add_water(&mut self, [water, masses]: [Array; 2], particles: u64) {
        if self.texels {
            self.plan.add_texture(water, particles);
            self.plan.add_texture(masses, particles);
        } else {
            self.plan.add_buffer(water, WATER * particles);
        }
    }

    fn buffers(&mut self) {
        let (particles, nodes, rows) = (self.slots, self.water.nodes(), u64::from(self.water.mesh[1]));
        let width = u64::from(self.water.spline_order + 1);
        self.plan.add_buffer(Array::Control, 64);
        match self.storage {
            Storage::Sorted => {
                self.add_water([Array::Particles, Array::ParticleMasses], particles);
                self.add_water([Array::Tidied, Array::TidiedMasses], particles);
                if self.texels {
                    self.plan.add_texture(Array::Order, particles);
                } else {
                    self.plan.add_buffer(Array::Order, 4 * particles);
                }
                self.plan.add_buffer(Array::Counts, 4 * nodes);
                self.plan.add_buffer(Array::Cells, 4 * (nodes + 1 + rows));
            }
            Storage::Bins => {
                let (capacity, arrivals) = bin_places(self.model, self.water);
                self.plan
                    .constants
                    .extend([(Constant::Capacity, capacity as f64), (Constant::Arrivals, arrivals as f64)]);
                let places = places(self.model, self.water, self.storage);
                self.add_water([Array::Bins, Array::BinMasses], places);
                self.plan.add_buffer(Array::Stayed, 4 * nodes);
                self.plan.add_buffer(Array::Arrived, 8 * nodes);
            }
        }
        // Seven rows of a strip of four, and one that fills up the last word.
        let shares = if self.eights { 2 * (nodes + 3 * nodes / 8) } else { width * width * nodes };
        self.plan.add_buffer(Array::Contributions, 4 * shares);
        self.plan.add_buffer(Array::NodeMasses, 4 * nodes);
        self.plan.add_buffer(Array::Depths, 4 * nodes);
        if self.water.bath.is_some() {
            self.plan.add_buffer(Array::NodeBath, 4 * nodes);
            self.plan.add_buffer(Array::PreviousMasses, 4 * nodes);
            self.plan.add_buffer(Array::Surface, 4 * nodes);
        }
    }
}

/// Operations of a step, per particle.
pub(in crate::families::shallow_water) struct Arithmetic {
    /// Moments and gradient of a particle.
    particle: f64,
    /// Polynomials and contributions of a cell.
    cell: f64,
    /// Transforms, for each node.
    pub transforms: f64,
}

impl Arithmetic {
    pub(in crate::families::shallow_water) fn of(water: &ShallowWater) -> Self {
        let width = f64::from(water.spline_order + 1);
        let per_cell = water.nodes() as f64 / water.carriers.max(1) as f64;
        Self {
            particle: 4.0 * width * width + 70.0,
            cell: per_cell * 8.0 * width.powi(3),
            transforms: per_cell * 150.0,
        }
    }

    pub(in crate::families::shallow_water) fn sum(&self) -> f64 {
        self.particle + self.cell + self.transforms
    }
}
