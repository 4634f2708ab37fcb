//! The plan of a scene of particles: how they are ordered, what adds impulses to them, and what ends a step.

mod gathered;
mod list;
mod part;
mod reported;
mod scheme;
mod sorted;

pub(crate) use gathered::GatheringKernels;
pub(crate) use scheme::stages;
use sorted::Sorted;

use super::bonded::Scales;
use super::prefix_sum::PrefixSum;
use super::quanta::quanta;
use super::serial_memory::TURNS;
use super::species::Species;
use super::{
    Grid, Hardware, Kernel, Measured, Need, Options, PARTICLE, PhysicsPlan, Plan, Quanta, Traversal, generator,
    predicted, texture_candidates,
};
use crate::document::Integrator;
use crate::families::particles::space::shear::plan as shear;
use crate::families::particles::space::walls::plan as walls;
use crate::families::particles::terms::body_forces::plan as external;
use crate::families::particles::terms::langevin;
use crate::families::particles::terms::pairs::law::{self, ranges};
use crate::families::particles::{CoupledLayout, ListLayout, ParticleLayout};
use crate::families::{Model, PairForce};
use crate::noise;
use crate::plan::{Cells, Layout, switch};
use crate::shaders::{Array, Choices, Constant, Entry, arrays, couplings, grid, pairs, space};

/// How particles are ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    /// By cell at every step: pairs are found in cells.
    EveryStep,
    /// By cell whenever neighbours are listed: pairs persist from step to step.
    WithList,
    /// Not at all: there are no pairs.
    Never,
}

impl Order {
    fn new(model: &Model, options: Options) -> Self {
        let particles = model.particles();
        let pairs = particles.pair_force.as_ref().is_some_and(PairForce::acts);
        // Pairs without memory may be listed too, where a step visits them once.
        let may_be_listed = particles.shear.is_none() && !particles.have_local_densities() && !particles.splits();
        if particles.list_pairs(model) || (options.listed && pairs && may_be_listed) {
            Self::WithList
        } else if pairs || options.part.is_some() {
            Self::EveryStep
        } else {
            Self::Never
        }
    }
}

/// Makes the plan of a model.
pub(crate) fn plan(model: &Model, measured: &Measured, hardware: Hardware, options: Options) -> PhysicsPlan {
    let particles = model.particle_count();
    let free = PairForce::none(&model.units, model.species.len());
    let force = model.particles().pair_force.as_ref().unwrap_or(&free);
    let order = Order::new(model, options);
    let mut least = [1; 3];
    if let Some(shear) = &model.particles().shear {
        // Between boundaries that shear there are rows that are next to one of them only.
        least[shear.gradient] = 3;
    }
    let range = if order == Order::EveryStep { force.cutoff } else { force.cutoff + force.skin };
    let grid = Grid::with_least(&model.units, range, particles, least);
    let traversal = match (order, force.acts(), options.traversal) {
        (Order::WithList | Order::Never, ..) | (_, false, _) => Traversal::Alone,
        (_, true, Some(traversal)) => traversal,
        (_, true, None) if hardware.takes_eights() => Traversal::Clusters,
        (_, true, None) if hardware.queues_pairs => Traversal::Queue,
        (_, true, None) => Traversal::Rows,
    };
    let mut builder = Builder {
        model,
        measured,
        force,
        grid,
        particles,
        slots: particles,
        order,
        traversal,
        options,
        species: Species::of(model),
        sorted: Sorted::default(),
        scan: Vec::new(),
        passed_on: Vec::new(),
        inner: None,
        passed_on_early: Vec::new(),
        plan: empty_plan(model, &grid, order, options),
    };
    builder.plan_part();
    builder.sorted = Sorted::new(&builder, hardware);
    builder.constants();
    builder.ordering();
    builder.integration();
    builder.buffers();
    let groups = builder.slots.div_ceil(builder.workgroup_size());
    PhysicsPlan {
        reported: Some(builder.reported()),
        ordered: builder.ordered(),
        texture_candidates: texture_candidates(&builder.plan),
        followers: vec![Kernel::new("follow", Entry::FollowParticles, builder.choices(), groups)],
        stride: model.physics().reach(model) / model.units.shortest_length(),
        plan: builder.plan,
    }
}

fn empty_plan(model: &Model, grid: &Grid, order: Order, options: Options) -> Plan {
    let particles = ParticleLayout {
        dimension: model.units.dimension,
        predicted: predicted(model),
        account: external::rows(model, options.workgroup()) as usize,
        walls: walls::count(model),
    };
    let force = model.particles().pair_force.as_ref().filter(|_| order == Order::WithList);
    let layout = CoupledLayout {
        particles,
        list: force.map(|force| ListLayout {
            capacity: list::capacity(model, force, options) as usize,
            memory: force.remembers(),
        }),
        kept: model.particles().kept(model),
    };
    let plan = model.empty_plan(grid.cells, layout, quanta(model), noise::stream::PAIR);
    if order == Order::EveryStep {
        return plan;
    }
    // What is reported has no predicted momentum.
    let reported = Layout::new(ParticleLayout { predicted: false, account: 0, walls: 0, ..particles });
    Plan { reported: Some((Array::Reported, reported)), ..plan }
}

/// What a traversal does with the hits of the prefilter.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Masks {
    /// Finds and forgets them.
    Unkept,
    /// Finds and keeps them.
    Keep,
    /// Visits those that were kept.
    Kept,
}

pub(crate) struct Builder<'a> {
    pub model: &'a Model,
    pub measured: &'a Measured,
    pub force: &'a PairForce,
    pub grid: Grid,
    pub particles: u64,
    /// Places for particles as they are stored.
    pub slots: u64,
    order: Order,
    /// How passes over particles visit their pairs.
    pub traversal: Traversal,
    pub options: Options,
    pub species: Species,
    /// Where sorted particles lie.
    sorted: Sorted,
    /// The kernels of that sum on their own.
    scan: Vec<usize>,
    /// The kernels of one of several ranks that exchange particles where others follow them.
    passed_on: Vec<usize>,
    /// Of one of several ranks: cells of which no other has to know, if the device goes on with them during an exchange.
    inner: Option<Cells>,
    /// The kernels that exchange particles then.
    passed_on_early: Vec<usize>,
    pub plan: Plan,
}

/// Units of a rate of relaxation, and the mean of the fluid up to which their sums fit.
const RATE_UNIT: f64 = 65536.0;
const EVEN_RELAXATION: f64 = 20.0;

/// Workgroups that fill an adapter.
const ENOUGH: u64 = 8192;

impl<'a> Builder<'a> {
    fn constants(&mut self) {
        let units = self.model.units;
        let half = 0.5 * self.model.time_step;
        let cutoff = self.force.cutoff;
        let Quanta { energy, pair_energy, force_squared, curvature, .. } = self.plan.quanta;
        let to_force = units.momentum / half;
        let capacity = self.frame_capacity();
        let mut constants = self.grid.constants(&units).to_vec();
        constants.extend([
            (Constant::WindowX, f64::from(self.grid.windows[0])),
            (Constant::WindowY, f64::from(self.grid.windows[1])),
            (Constant::WindowZ, f64::from(self.grid.windows[2])),
            (Constant::ProbeY, self.grid.ratios[1]),
            (Constant::ProbeZ, self.grid.ratios[2]),
            (Constant::ProbeReach, self.grid.reach_squared),
            (Constant::BytesX, f64::from(self.grid.bytes.count[0])),
            (Constant::BytesY, f64::from(self.grid.bytes.count[1])),
            (Constant::BytesZ, f64::from(self.grid.bytes.count[2])),
            (Constant::BytesReach, f64::from(self.grid.bytes.reach)),
            (Constant::Particles, self.slots as f64),
            (Constant::Workgroup, self.workgroup_size() as f64),
            (Constant::Capacity, (self.slots + capacity) as f64),
            (Constant::Cutoff, cutoff),
            (Constant::Species, self.model.species.len() as f64),
            (Constant::DisplacementLimit, self.model.physics().reach(self.model)),
            (Constant::PairEnergy, to_force * cutoff / (4.0 * pair_energy)),
            (Constant::PairVirial, to_force / (2.0 * pair_energy)),
            (Constant::Gradient, to_force * to_force / force_squared),
            (Constant::Laplacian, to_force / curvature),
        ]);
        if self.splits() {
            constants.push((Constant::RateUnit, self.rate_unit()));
        } else {
            constants.push((Constant::Halves, 0.0));
        }
        if self.model.has_memory() {
            constants.push((Constant::BathSquare, langevin::plan::inverse(self.plan.quanta.bath_squared)));
        }
        let (sees, lambda) = if let Integrator::GrootWarren { lambda } = self.model.particles().integrator {
            (1.0, lambda)
        } else {
            (0.0, 0.5)
        };
        constants.extend([(Constant::FrictionSees, sees), (Constant::Prediction, 2.0 * lambda - 1.0)]);
        constants.extend([
            switch(Constant::BathsRemember, self.model.has_memory()),
            switch(Constant::Gathers, self.gathers()),
            (Constant::CouplingsConserve, self.conservative_gathered()),
        ]);
        constants.push(switch(Constant::OwnActs, self.model.particles().acts_on_particles()));
        constants.push(generator(self.model.generator));
        constants.extend(law::constants(self.model, self.force));
        constants.extend(self.species.constants());
        let mass = self.species.mass();
        constants.extend([
            (Constant::Drift, self.model.time_step * units.momentum / mass),
            (Constant::Kinetic, units.momentum * units.momentum / (2.0 * mass * energy)),
            (Constant::InverseMass, 1.0 / mass),
            (Constant::FrictionPerLength, mass / (self.model.time_step * units.momentum)),
        ]);
        if !self.species.have_table() {
            let [repulsion, friction, noise] = self.impulses(0, 0);
            constants.extend([
                (Constant::Repulsion, repulsion),
                (Constant::Friction, friction),
                (Constant::Noise, noise),
            ]);
        }
        self.plan.constants = constants;
        self.particle_constants();
        for term in self.model.particles().terms() {
            term.add_constants(&self.scales(), &mut self.plan);
        }
        walls::add_constants(self.model, &mut self.plan);
        self.density_constants();
    }

    /// Integer units of the rates at which pairs relax, whose sums have 24 bits. One stage hardly tells one large rate from another; two
    /// need to know all of them.
    fn rate_unit(&self) -> f64 {
        let (rate, _) = self.model.largest_friction_rate(self.force);
        let excess = rate * self.model.time_step / EVEN_RELAXATION;
        if self.relaxes_in_two_stages() && excess > 1.0 { RATE_UNIT / excess.log2().ceil().exp2() } else { RATE_UNIT }
    }

    pub(crate) fn scales(&self) -> Scales<'a> {
        Scales { model: self.model, species: self.species, quanta: self.plan.quanta }
    }

    /// Impulses of half a step in momentum units: the first repulsion at contact, and without memory friction per unit
    /// velocity (where all have one mass, momentum) and noise, with memory the response of the bath to its coupling
    /// function and its deviation at rest.
    fn impulses(&self, a: usize, b: usize) -> [f64; 3] {
        if self.model.species.is_empty() {
            return [0.0; 3];
        }
        let half = 0.5 * self.model.time_step;
        let first = self.force.repulsions(a, b).next().map_or(0.0, |own| own.strength);
        let repulsion = first * self.repulsion_impulse();
        if self.force.remembers() {
            let step = self.force.bath_step(a, b, self.model.time_step);
            return [repulsion, step.response(), step.deviation(self.force.temperature)];
        }
        let friction = self.force.friction(a, b);
        let amplitude = (2.0 * friction * self.force.temperature / self.model.time_step).sqrt();
        [repulsion, friction * half / self.species.mass(), amplitude * half / self.model.units.momentum]
    }

    /// The impulse of half a step, in momentum units, of a unit force.
    fn repulsion_impulse(&self) -> f64 {
        0.5 * self.model.time_step / self.model.units.momentum
    }

    /// A kernel with a lane for each of some things.
    pub(crate) fn kernel(&mut self, name: &'static str, entry: Entry, choices: Choices, things: u64) -> usize {
        self.plan.add_kernel(Kernel::new(name, entry, choices, things.div_ceil(self.workgroup_size())))
    }

    /// What is chosen for every kernel: the space, the species, where particles are and how they are ordered.
    pub(crate) fn choices(&self) -> Choices {
        self.space()
            .and(&self.species.choices())
            .and(&self.sorted.choices())
            .with_if(self.keeps_slots() && self.order == Order::EveryStep, couplings::Slots::Kept)
            .and(&walls::choices(self.model))
            .and(&shear::choices(self.model))
            .and(&self.of_order())
            .and(&self.of_rank())
    }

    /// The vector space and the grid in it.
    fn space(&self) -> Choices {
        let by_lanes = self.traversal != Traversal::Clusters;
        let (space, grid, prefilter) = match self.model.units.dimension {
            3 => (space::Dimension::Three, grid::Dimension::Volume, pairs::Prefilter::Volume),
            2 => (space::Dimension::Two, grid::Dimension::Plane, pairs::Prefilter::Plane),
            _ => (space::Dimension::One, grid::Dimension::Plane, pairs::Prefilter::Plane),
        };
        Choices::new().with(space).with(grid).with(if by_lanes { pairs::Prefilter::Bytes } else { prefilter })
    }

    /// What kernels choose by the order of particles.
    fn of_order(&self) -> Choices {
        let choices = Choices::new();
        if self.order == Order::EveryStep {
            return choices.with(grid::Rows::Framed).with(grid::Next::Cells);
        }
        choices
            .with(grid::Rows::Plain)
            .with(arrays::Sorted::Stored)
            .with(pairs::Reporting::Aside)
            .with_if(self.order == Order::WithList && !self.lists_always(), grid::Next::Anchors)
            .with_if(self.order == Order::WithList && self.force.remembers(), couplings::Lists::ByTurns)
    }

    fn ordering(&mut self) {
        match self.order {
            Order::EveryStep => self.order_every_step(),
            Order::WithList => self.order_with_list(),
            Order::Never => {
                self.plan.sort = vec![self.kernel("tick", Entry::BeginPlainStep, self.choices(), 1)];
                if self.keeps_slots() {
                    self.plan.prepare = vec![self.take_stock()];
                }
            }
        }
    }

    fn order_every_step(&mut self) {
        let bin = self.kernel("bin", Entry::BinParticles, self.choices(), self.slots);
        self.plan.prepare.push(bin);
        self.plan.sort = self.sorting(&self.choices());
        self.exchange(bin);
        if self.sorted.scans_at_end() {
            // Every step is begun by the one before, but for the first.
            let scatter = self.plan.sort.split_off(self.plan.sort.len() - 1);
            self.scan = std::mem::replace(&mut self.plan.sort, scatter);
            self.plan.prepare.extend(&self.scan);
        }
    }

    /// Counting sort by cell.
    fn sorting(&mut self, choices: &Choices) -> Vec<usize> {
        let copied = self.sorted.copied(self.splits());
        if self.sorted.is_in_one_workgroup() {
            return vec![self.kernel("sort", Entry::SortInOneWorkgroup, choices.clone().with(copied), 1)];
        }
        let sum = PrefixSum { choices, rows: self.grid.rows(), cells: self.grid.count() };
        let mut kernels: Vec<usize> =
            sum.kernels(self.options).into_iter().map(|kernel| self.plan.add_kernel(kernel)).collect();
        let choices = self.choices().with(copied);
        kernels.push(self.kernel("scatter", Entry::ScatterParticles, choices, self.slots.max(self.grid.count())));
        kernels
    }

    /// Whether steps are split: friction needs a second pass over the pairs.
    pub(crate) fn splits(&self) -> bool {
        self.model.particles().splits()
    }

    /// Buffers of the kernel that ends a step beyond those of all: impulses that were gathered, what walls absorb, and
    /// of several ranks the domain in which they do, a table of species, and local densities.
    fn more_buffers(&self) -> u32 {
        let (walled, dense) = (walls::count(self.model) > 0, self.model.particles().have_local_densities());
        let booked = self.options.part.is_some() && (walled || self.is_sheared());
        let remembers = langevin::plan::remembers(self.model);
        let holds = self.model.particles().coloured_noise.is_some();
        let there = [self.gathers(), walled, booked, self.species.have_table(), dense, remembers, holds];
        there.into_iter().map(u32::from).sum()
    }

    /// Whether boundaries shear.
    pub(crate) fn is_sheared(&self) -> bool {
        self.model.particles().shear.is_some()
    }

    /// Whether steps relax the momentum of every particle by itself.
    pub(crate) fn relaxes_particles(&self) -> bool {
        self.model.particles().relaxes_particles()
    }

    /// Whether a split step visits its pairs once: without friction there is nothing to do in a second visit but to
    /// repeat the kick, which only an analysis of forces looks at.
    fn visits_once(&self) -> bool {
        self.force.acts() && self.splits() && !self.relaxes_pairs() && !self.measured.needs(Need::Forces)
    }

    pub(crate) fn relaxes_pairs(&self) -> bool {
        self.model.particles().relaxes_pairs()
    }

    /// Whether friction has two stages.
    pub(crate) fn relaxes_in_two_stages(&self) -> bool {
        self.model.particles().relaxes_in_two_stages()
    }

    /// From where pairs are looked for.
    fn prefilter_source(&self) -> Choices {
        let source = Choices::new().with(self.sorted.prefilter_source());
        source.with_if(self.is_sheared(), pairs::PrefilterSource::Sheared)
    }

    /// How reports visit pairs: their sums are more than a word, which no queue adds up, and they are few.
    pub(crate) fn traversal_of_reports(&self) -> Traversal {
        if self.traversal == Traversal::Queue { Traversal::Rows } else { self.traversal }
    }

    /// A kernel that visits all pairs.
    pub(crate) fn traversal(
        &mut self,
        name: &'static str,
        traversal: Traversal,
        masks: Masks,
        pass: &Choices,
    ) -> usize {
        let visits = self.prefilter_source().and(&shear::of_visits(self.model));
        let choices = self.choices().and(&visits).and(pass).with_any(match masks {
            Masks::Unkept => self.is_sheared().then_some(pairs::Hits::Sheared),
            Masks::Keep => Some(pairs::Hits::Keep),
            Masks::Kept => Some(pairs::Hits::Kept),
        });
        if self.order != Order::EveryStep {
            let groups = self.particles.div_ceil(self.workgroup_size()).max(1);
            return self.plan.add_kernel(Kernel::new(name, Entry::VisitStored, choices, groups));
        }
        let entry = match traversal {
            Traversal::Alone => Entry::VisitAlone,
            Traversal::Rows => Entry::VisitRows,
            Traversal::Queue => Entry::VisitQueue,
            Traversal::Clusters => Entry::VisitClusters,
        };
        let rows = self.grid.rows();
        let segments = self.segments(traversal, rows);
        let of_rows = (Constant::Segments, segments as f64);
        let shares = |groups: u64| (Constant::Shares, groups as f64);
        let (groups, constants) = match traversal {
            Traversal::Alone => (rows * segments, vec![of_rows]),
            Traversal::Rows | Traversal::Queue => {
                let groups = self.options.segments.map_or_else(|| self.chunks_at_once(), |_| rows * segments);
                let of_lanes = |each: u64| (each * self.workgroup_size()) as f64;
                let queued = [(Constant::QueueEntries, of_lanes(8)), (Constant::HitPlaces, of_lanes(10))];
                (groups, [&[shares(groups)][..], if traversal == Traversal::Queue { &queued } else { &[] }].concat())
            }
            Traversal::Clusters => {
                let wanted = (self.particles / 256).clamp(32, 1024).max(self.least_groups(8));
                let groups = (rows * segments).min(wanted.next_multiple_of(32));
                (groups, vec![of_rows, shares(groups)])
            }
        };
        self.plan.add_kernel(Kernel::new(name, entry, choices, groups).with(constants))
    }

    /// Workgroups that visit chunks of sorted particles: enough of them to fill an adapter, with as many chunks for each.
    fn chunks_at_once(&self) -> u64 {
        let lanes = self.workgroup_size();
        let chunks = (self.slots + self.frame_capacity()).div_ceil(lanes).max(1);
        chunks.div_ceil(chunks.div_ceil(ENOUGH.max(self.least_groups(lanes))))
    }

    /// Workgroups that share a row, where so many rows are visited: enough of them to fill the adapter, none with less than one round of
    /// work on average. Subgroups of eight are those of processors, whose few cores are filled by a few workgroups, and to which a workgroup
    /// is dear: some hundred particles each, and as many of them for every core.
    fn segments(&self, traversal: Traversal, rows: u64) -> u64 {
        let (lanes, enough) = match traversal {
            Traversal::Clusters => (8, 64),
            Traversal::Alone | Traversal::Rows | Traversal::Queue => (self.workgroup_size(), ENOUGH),
        };
        let rounds = (self.particles / self.grid.rows()).div_ceil(lanes).max(1);
        let chosen = self.options.segments.filter(|segments| *segments > 0).map(u64::from);
        chosen.unwrap_or_else(|| rounds.min((enough.max(self.least_groups(lanes)) / rows).max(1)))
    }

    /// The fewest workgroups whose invocations make no more turns of loops than software adapters allow: of a cluster about half of
    /// its candidates, and once more as many pairs.
    fn least_groups(&self, lanes: u64) -> u64 {
        let crowd = (self.particles / self.grid.count()).max(1);
        let turns = (self.particles / lanes * 3_u64.pow(self.grid.dimension as u32)).saturating_mul(crowd);
        turns.div_ceil(TURNS)
    }

    /// How often a step visits all pairs, but for local densities.
    fn visits(&self) -> f64 {
        match (self.splits() && !self.visits_once(), self.relaxes_in_two_stages()) {
            (false, _) => 1.0,
            (true, false) => 2.0,
            (true, true) => 3.0,
        }
    }

    /// Arithmetic of a particle and step: the prefilter of the candidates of up to 27 (9) cells, then the pairs inside the cutoff, as
    /// often as they are visited, with the forces that there are.
    fn operations(&self) -> f64 {
        const MOTION: f64 = 60.0;
        if self.traversal == Traversal::Alone {
            return MOTION;
        }
        let (density, cutoff) = (self.model.density_around(), self.force.cutoff);
        let ball =
            if self.grid.dimension == 3 { 4.18879 * cutoff.powi(3) } else { std::f64::consts::PI * cutoff.powi(2) };
        // Where few particles are in a large box, cells are wider than the cutoff, and a crowd may be in one of them.
        let searched = self.grid.cells.iter().map(|cells| f64::from(*cells).recip() * f64::from((*cells).min(3)));
        let searched = searched.product::<f64>() * self.model.units.lengths.iter().product::<f64>();
        let (candidates, pairs) = ((density * searched).min(self.particles as f64), density * ball);
        let relaxations = if self.relaxes_in_two_stages() { 2.0 } else { 1.0 };
        let visits = self.visits();
        let cost = |there: bool, operations: f64| if there { operations } else { 0.0 };
        let frictional = self.force.largest_friction() > 0.0;
        let dense = self.force.many_body.is_some();
        let pair = visits * (22.0 + cost(self.force.is_conservative(), 8.0) + cost(dense, 8.0))
            + cost(dense, 22.0)
            + cost(frictional, 15.0 * visits)
            + cost(frictional && self.force.temperature > 0.0, if self.splits() { 40.0 * relaxations } else { 25.0 });
        12.0 * candidates + pair * pairs + MOTION
    }

    fn buffers(&mut self) {
        self.plan.add_buffer(Array::Control, 64);
        self.plan.add_buffer(Array::Particles, PARTICLE * self.slots);
        for kept in self.model.particles().kept(self.model) {
            self.plan.add_buffer(kept.array, kept.bytes());
        }
        if self.order == Order::EveryStep {
            self.buffers_of_order();
        } else {
            self.plan.add_buffer(Array::Reported, PARTICLE * self.particles);
        }
        self.coefficients();
    }

    /// Buffers of particles that are ordered at every step.
    fn buffers_of_order(&mut self) {
        let (rows, cells) = (self.grid.rows(), self.grid.count());
        let width = u64::from(self.grid.cells[0]) + if self.grid.framed() { 2 } else { 0 };
        let count = self.slots + self.frame_capacity();
        let stages = self.relaxes_in_two_stages();
        self.sorted.add_arrays(&mut self.plan, count, stages);
        self.plan.add_buffer(Array::Cells, 4 * (rows * width + 1 + rows));
        self.plan.add_buffer(Array::Counts, 4 * cells);
        self.plan.add_buffer(Array::Ranks, 4 * self.slots);
        self.plan.add_row_sums(rows, cells, self.options);
    }

    /// The coefficients of pairs and species: constants, or a table.
    fn coefficients(&mut self) {
        let parts = if self.splits() { 2 } else { 1 };
        if self.species.have_table() {
            let count = self.model.species.len();
            let mut table: Vec<f32> = Vec::with_capacity(4 * count * count);
            for a in 0..count {
                for b in 0..count {
                    table.extend(self.impulses(a, b).map(|value| value as f32));
                    table.push(Species::inverse_mass(&self.model.species[b]) as f32);
                }
            }
            let ranges = ranges(self.force, count, self.repulsion_impulse());
            if self.relaxes_particles() {
                table.extend(self.particle_entries());
            } else if langevin::plan::bath(self.model).is_some() {
                for species in 0..count {
                    table.extend(langevin::plan::coefficients(&self.scales(), species).map(|value| value as f32));
                    table.push(0.0);
                }
            } else if !ranges.is_empty() {
                // In the place of the baths of particles.
                table.resize(4 * count * (count + 1), 0.0);
            }
            table.extend(ranges);
            external::add_constants(self.model, Some(table.len() / 4), &mut self.plan);
            table.extend(external::entries(self.model));
            shear::add_constants(self.model, parts, Some(table.len() / 4), &mut self.plan);
            table.extend(shear::entries(self.model));
            let bytes = bytemuck::cast_slice(&table).to_vec();
            self.plan.add_table(Array::Coefficients, bytes);
        } else {
            external::add_constants(self.model, None, &mut self.plan);
            shear::add_constants(self.model, parts, None, &mut self.plan);
        }
    }

    pub(crate) fn workgroup_size(&self) -> u64 {
        self.options.workgroup()
    }

    /// Room for the copies in the frames: a quarter more than the share of the end cells, and never more than all particles.
    pub(crate) fn frame_capacity(&self) -> u64 {
        if self.order == Order::EveryStep && self.grid.framed() {
            self.options.copies.unwrap_or(5 * self.slots / (2 * u64::from(self.grid.cells[0])) + 512).min(self.slots)
        } else {
            0
        }
    }
}
