//! The plan of a scene whose particles interact in pairs without memory, by bonds and angles without a bath, and by tethers; in split steps
//! with baths without memory on particles and along bonds, in others with baths on particles and a coloured noise.

mod bond_baths;
mod bonded;
mod density;
mod part;
mod particle_bath;
mod stress;
mod tethers;

use super::bonded::Scales;
use super::external;
use super::law::{law, ranges};
use super::own;
use super::prefix_sum::{PrefixSum, needs_levels};
use super::quanta::quanta;
use super::serial_memory::TURNS;
use super::shear;
use super::species::Species;
use super::walls;
use super::{
    Grid, Hardware, Kernel, Measured, Need, Options, Ordered, PARTICLE, PhysicsPlan, Plan, Quanta, Reported, Texture,
    Traversal, deviate, predicted, texture_candidates, words,
};
use crate::document::Integrator;
use crate::families::particles::sums::sums;
use crate::families::particles::{CoupledLayout, ParticleLayout};
use crate::families::{Model, PairForce};
use crate::noise;
use crate::plan::Cells;
use crate::shaders::{Array, Choices, Constant, Entry, arrays, core, couplings, grid, pairs, space};
use crate::state::Units;

/// Cells up to which a step ends with the prefix sum for the next one, where lanes are taken one after the other. With 1 000 cells
/// (3 000 particles) this saves a tenth of a step; with 3 000 it saves nothing any more.
const SCAN_AT_END_CELLS: u64 = 1 << 11;

/// Makes the plan of a model.
pub(crate) fn plan(model: &Model, measured: &Measured, hardware: Hardware, options: Options) -> PhysicsPlan {
    let particles = model.particle_count();
    let free = PairForce::none(&model.units, model.species.len());
    let force = model.particles().pair_force.as_ref().unwrap_or(&free);
    let mut least = [1; 3];
    if let Some(shear) = &model.particles().shear {
        // Between boundaries that shear there are rows that are next to one of them only.
        least[shear.gradient] = 3;
    }
    let grid = Grid::with_least(&model.units, force.cutoff, particles, least);
    let traversal = match (force.acts(), options.traversal) {
        (false, _) => Traversal::Alone,
        (true, Some(traversal)) => traversal,
        (true, None) if hardware.takes_eights() => Traversal::Clusters,
        (true, None) => Traversal::Rows,
    };
    let mut builder = Builder {
        model,
        measured,
        force,
        grid,
        particles,
        slots: particles,
        traversal,
        options,
        species: Species::of(model),
        texels: false,
        scans_at_end: traversal == Traversal::Clusters
            && options.suits_serial_memory(hardware)
            && grid.count() <= SCAN_AT_END_CELLS
            && !needs_levels(grid.count(), options)
            && options.part.is_none(),
        scan: Vec::new(),
        passed_on: Vec::new(),
        inner: None,
        passed_on_early: Vec::new(),
        plan: empty_plan(model, &grid, options),
    };
    // What ends a step that visits pairs once is no traversal.
    builder.scans_at_end &= !builder.visits_once();
    builder.plan_part();
    builder.texels =
        options.suits_serial_memory(hardware) && Texture::holds(builder.slots + builder.frame_capacity(), 4);
    builder.constants();
    builder.ordering();
    builder.integration();
    builder.buffers();
    let groups = builder.slots.div_ceil(builder.workgroup_size());
    PhysicsPlan {
        reported: Some(builder.reported()),
        ordered: Some(builder.ordered()),
        texture_candidates: texture_candidates(&builder.plan),
        followers: vec![Kernel::new("follow", Entry::FollowParticles, builder.choices(), groups)],
        stride: force.cutoff / model.units.shortest_length(),
        plan: builder.plan,
    }
}

fn empty_plan(model: &Model, grid: &Grid, options: Options) -> Plan {
    let account = external::rows(model, options.workgroup()) as usize;
    let layout = ParticleLayout {
        dimension: model.units.dimension,
        predicted: predicted(model),
        account,
        walls: walls::count(model),
    };
    let more = CoupledLayout {
        particles: layout,
        list: None,
        position_baths: own::remembers(model),
        bond_baths: 0,
        holds: model.particles().coloured_noise.is_some(),
        tethers: model.particles().tether.is_some(),
    };
    if more.position_baths || more.holds || more.tethers {
        model.empty_plan(grid.cells, more, quanta(model), noise::stream::PAIR)
    } else {
        model.empty_plan(grid.cells, layout, quanta(model), noise::stream::PAIR)
    }
}

/// What a traversal does with the hits of the prefilter.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Masks {
    /// Finds and forgets them.
    Unkept,
    /// Finds and keeps them.
    Keep,
    /// Visits those that were kept.
    Kept,
}

struct Builder<'a> {
    model: &'a Model,
    measured: &'a Measured,
    force: &'a PairForce,
    grid: Grid,
    particles: u64,
    /// Places for particles as they are stored.
    slots: u64,
    traversal: Traversal,
    options: Options,
    species: Species,
    /// Whether sorted particles are texels.
    texels: bool,
    /// Whether a step ends with the prefix sum over cells for the next one.
    scans_at_end: bool,
    /// The kernels of that sum on their own.
    scan: Vec<usize>,
    /// The kernels of one of several ranks that exchange particles where others follow them.
    passed_on: Vec<usize>,
    /// Of one of several ranks: cells of which no other has to know, if the device goes on with them during an exchange.
    inner: Option<Cells>,
    /// The kernels that exchange particles then.
    passed_on_early: Vec<usize>,
    plan: Plan,
}

/// Units of a rate of relaxation, and the mean of the fluid up to which their sums fit.
const RATE_UNIT: f64 = 65536.0;
const EVEN_RELAXATION: f64 = 20.0;

/// Friction and noise of the two stages of a relaxation: shaders/pairs/friction/stages.wgsl.
///
/// (1 - α₁h)(1 - α₂h) = 1 - h + bh² for a mode of eigenvalue h, which has the noise β₁(1 - α₂h) + β₂ = 1 - (1 + 2b)h/4 times √(2kT h). Its
/// temperature is kT (1 - .298h)²/(1 - .595h + .095h² - .0045h³): within 1.1 % up to h = 2.
fn stages() -> [[(Constant, f64); 2]; 2] {
    let b = 0.095_f64;
    let alpha = [0.5 - (0.25 - b).sqrt(), 0.5 + (0.25 - b).sqrt()];
    let first = (1.0 + 2.0 * b) / (4.0 * alpha[1]);
    let beta = [first, 1.0 - first];
    // Noise comes with √(kT c/2).
    [0, 1].map(|stage| [(Constant::StageFriction, alpha[stage]), (Constant::StageNoise, 2.0 * beta[stage])])
}

/// The vector space, the grid in it and the stored particle.
fn space_of(units: &Units, predicted: bool) -> Choices {
    let choices = if units.dimension == 3 {
        Choices::new().with(space::Dimension::Three).with(grid::Dimension::Volume).with(pairs::Prefilter::Volume)
    } else {
        Choices::new().with(space::Dimension::Two).with(grid::Dimension::Plane).with(pairs::Prefilter::Plane)
    };
    choices.with(if predicted { space::Particle::Predicted } else { space::Particle::Plain }).with(grid::Rows::Framed)
}

impl<'a> Builder<'a> {
    fn constants(&mut self) {
        let units = self.model.units;
        let half = 0.5 * self.model.time_step;
        let cutoff = self.force.cutoff;
        let Quanta { energy, pair_energy, force_squared, curvature, .. } = self.plan.quanta;
        let to_force = units.momentum / half;
        let exponent = self.force.common_weight_exponent().unwrap_or(0.0);
        let capacity = self.frame_capacity();
        let mut constants = self.grid.constants(&units).to_vec();
        constants.extend([
            (Constant::WindowX, f64::from(self.grid.windows[0])),
            (Constant::WindowY, f64::from(self.grid.windows[1])),
            (Constant::WindowZ, f64::from(self.grid.windows[2])),
            (Constant::ProbeY, self.grid.ratios[1]),
            (Constant::ProbeZ, self.grid.ratios[2]),
            (Constant::ProbeReach, self.grid.reach_squared),
            (Constant::Particles, self.slots as f64),
            (Constant::Workgroup, self.workgroup_size() as f64),
            (Constant::Capacity, (self.slots + capacity) as f64),
            (Constant::Cutoff, cutoff),
            (Constant::WeightRootExponent, 0.5 * exponent),
            (Constant::Species, self.model.species.len() as f64),
            (Constant::DisplacementLimit, self.model.physics().reach(self.model)),
            (Constant::PairEnergy, to_force * cutoff / (4.0 * pair_energy)),
            (Constant::PairVirial, to_force / (2.0 * pair_energy)),
            (Constant::Gradient, to_force * to_force / force_squared),
            (Constant::Laplacian, to_force / curvature),
        ]);
        if self.splits() {
            constants.push((Constant::RateUnit, self.rate_unit()));
        }
        if own::remembers(self.model) {
            constants.push((Constant::BathSquare, own::inverse(self.plan.quanta.bath_squared)));
        }
        if let Integrator::GrootWarren { lambda } = self.model.integrator {
            constants.push((Constant::Prediction, 2.0 * lambda - 1.0));
        }
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
        own::add(&self.scales(), &mut self.plan);
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

    fn scales(&self) -> Scales<'a> {
        Scales { model: self.model, species: self.species, quanta: self.plan.quanta }
    }

    /// Impulses of half a step in momentum units: repulsion at contact, friction per unit velocity (where all have one mass,
    /// momentum), noise.
    fn impulses(&self, a: usize, b: usize) -> [f64; 3] {
        if self.model.species.is_empty() {
            return [0.0; 3];
        }
        let half = 0.5 * self.model.time_step;
        let unit = self.model.units.momentum;
        let (repulsion, friction) = (self.force.repulsion(a, b), self.force.friction(a, b));
        let amplitude = (2.0 * friction * self.force.temperature / self.model.time_step).sqrt();
        [repulsion * half / unit, friction * half / self.species.mass(), amplitude * half / unit]
    }

    /// A kernel with a lane for each of some things.
    fn kernel(&mut self, name: &'static str, entry: Entry, choices: Choices, things: u64) -> usize {
        self.plan.add_kernel(Kernel::new(name, entry, choices, things.div_ceil(self.workgroup_size())))
    }

    /// What is chosen for every kernel: the space, the species, and where the ordered particles are.
    fn choices(&self) -> Choices {
        space_of(&self.model.units, predicted(self.model))
            .and(&self.species.choices())
            .with_if(self.splits(), space::Drift::Halves)
            .with_if(self.texels, arrays::Sorted::Apart)
            .with_if(self.texels, grid::Sorted::Apart)
            .with_if(self.keeps_probes(), grid::Probes::Kept)
            .with_if(self.gathers(), couplings::Gathered::Kept)
            .with_if(self.is_bonded() && self.options.part.is_none(), couplings::Slots::Kept)
            .with_any(external::profile(self.model))
            .and(&walls::choices(self.model))
            .and(&shear::choices(self.model, self.species.have_table()))
            .and(&self.of_rank())
    }

    fn ordering(&mut self) {
        let bin = self.kernel("bin", Entry::BinParticles, self.choices(), self.slots);
        self.plan.prepare.push(bin);
        self.plan.sort = self.sorting(&self.choices());
        self.exchange(bin);
        if self.scans_at_end {
            // Every step is begun by the one before, but for the first.
            let scatter = self.plan.sort.split_off(self.plan.sort.len() - 1);
            self.scan = std::mem::replace(&mut self.plan.sort, scatter);
            self.plan.prepare.extend(&self.scan);
        }
    }

    /// What ends a step.
    fn end_of_step(&self) -> Choices {
        if self.scans_at_end {
            Choices::new()
                .with(grid::EndOfStep::LastWorkgroup)
                .with(grid::ScanWidth::Narrow)
                .with(grid::ScanLanes::Eight)
        } else {
            Choices::new()
        }
    }

    /// Counting sort by cell.
    fn sorting(&mut self, choices: &Choices) -> Vec<usize> {
        let sum = PrefixSum { choices, rows: self.grid.rows(), cells: self.grid.count() };
        let mut kernels: Vec<usize> =
            sum.kernels(self.options).into_iter().map(|kernel| self.plan.add_kernel(kernel)).collect();
        // The first pass of a split step keeps its hits in the buffer of the particles.
        let whole = self.texels && !self.splits();
        let copied = self.choices().with(if whole { grid::Copied::Particles } else { grid::Copied::Fours });
        kernels.push(self.kernel("scatter", Entry::ScatterParticles, copied, self.slots.max(self.grid.count())));
        kernels
    }

    /// Whether steps are split: friction needs a second pass over the pairs.
    fn splits(&self) -> bool {
        self.model.particles().splits(self.model)
    }

    /// Buffers of the kernel that ends a step beyond those of all: impulses that were gathered, what walls take up, and of several ranks the
    /// domain in which they do, a table of species, and local densities.
    fn more_buffers(&self) -> u32 {
        let (walled, dense) = (walls::count(self.model) > 0, self.model.particles().have_local_densities());
        let booked = self.options.part.is_some() && (walled || self.is_sheared());
        let there = [self.gathers(), walled, booked, self.species.have_table(), dense];
        there.into_iter().map(u32::from).sum::<u32>() + own::buffers(self.model)
    }

    /// Whether the prefilter of pairs reads a word of each sorted particle and not its position: not from textures, and beside two
    /// more it would be one buffer too many, nor beside one where several ranks tell what is stored.
    fn keeps_probes(&self) -> bool {
        let beside = self.more_buffers() + u32::from(self.options.part.is_some());
        self.traversal != Traversal::Alone && !self.texels && beside < 2 && !self.is_sheared()
    }

    /// Whether boundaries shear.
    fn is_sheared(&self) -> bool {
        self.model.particles().shear.is_some()
    }

    /// Whether steps relax the momentum of every particle by itself.
    fn relaxes_particles(&self) -> bool {
        self.model.particles().relaxes_particles(self.model)
    }

    /// Whether a split step visits its pairs once: without friction there is nothing to do in a second visit but to
    /// repeat the kick, which only an analysis of forces looks at.
    fn visits_once(&self) -> bool {
        self.force.acts() && self.splits() && !self.relaxes_pairs() && !self.measured.needs(Need::Forces)
    }

    /// Whether impulses wait in an array for the passes over pairs.
    fn gathers(&self) -> bool {
        self.is_bonded() || self.is_tethered() || self.visits_once()
    }

    fn relaxes_pairs(&self) -> bool {
        self.model.particles().relaxes_pairs(self.model)
    }

    /// Whether friction has two stages.
    fn relaxes_in_two_stages(&self) -> bool {
        self.model.particles().relaxes_in_two_stages(self.model)
    }

    /// The pair force.
    fn law(&self) -> Choices {
        let force = self.force;
        let frictional = force.largest_friction() > 0.0;
        let noted = if self.is_sheared() { pairs::Separation::ShearedNoted } else { pairs::Separation::Noted };
        let choices = law(force)
            .with_if(force.many_body.is_some(), noted)
            .with(if self.is_sheared() {
                pairs::PrefilterSource::Sheared
            } else if self.keeps_probes() {
                pairs::PrefilterSource::Words
            } else {
                pairs::PrefilterSource::Positions
            })
            .with_any(frictional.then_some(match self.model.integrator {
                Integrator::Splitting { .. } if self.relaxes_in_two_stages() => pairs::Friction::Stages,
                Integrator::Splitting { .. } | Integrator::Gyro {} | Integrator::Rotate {} | Integrator::Euler {} => {
                    pairs::Friction::Relaxation
                }
                Integrator::CotterReich {} => pairs::Friction::DiscreteGradient,
                Integrator::GrootWarren { .. } => pairs::Friction::Velocity,
            }));
        if frictional && force.temperature > 0.0 {
            choices
                .with(pairs::Random::Thermal)
                .with(deviate(self.model.distribution))
                .with(words(self.model.generator))
        } else {
            choices
        }
    }

    /// A kernel that visits all pairs.
    fn traversal(&mut self, name: &'static str, traversal: Traversal, masks: Masks, pass: &Choices) -> usize {
        let visits = self.law().and(&shear::of_visits(self.model));
        let choices = self.choices().and(&visits).and(pass).with_any(match masks {
            Masks::Unkept => self.is_sheared().then_some(pairs::Hits::Sheared),
            Masks::Keep => Some(pairs::Hits::Keep),
            Masks::Kept => Some(pairs::Hits::Kept),
        });
        let entry = match traversal {
            Traversal::Alone => Entry::VisitAlone,
            Traversal::Rows => Entry::VisitRows,
            Traversal::Clusters => Entry::VisitClusters,
        };
        let rows = self.grid.rows();
        let clusters = traversal == Traversal::Clusters;
        let segments = self.segments(traversal, rows);
        let mut constants = vec![(Constant::Segments, segments as f64)];
        let mut groups = rows * segments;
        if clusters {
            let wanted = (self.particles / 256).clamp(32, 1024).max(self.least_groups(8));
            groups = groups.min(wanted.next_multiple_of(32));
            constants.push((Constant::Shares, groups as f64));
        }
        self.plan.add_kernel(Kernel::new(name, entry, choices, groups).with(constants))
    }

    /// Workgroups that share a row, where so many rows are visited: enough of them to fill the adapter, none with less than one round of
    /// work on average. Subgroups of eight are those of processors, whose few cores are filled by a few workgroups, and to which a workgroup
    /// is dear: some hundred particles each, and as many of them for every core.
    fn segments(&self, traversal: Traversal, rows: u64) -> u64 {
        let (lanes, enough) = match traversal {
            Traversal::Clusters => (8, 64),
            Traversal::Alone | Traversal::Rows => (self.workgroup_size(), 8192),
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

    fn integration(&mut self) {
        let forces = Choices::new().with_any(self.forces());
        self.plan.operations_per_particle = self.operations();
        let rows = if self.splits() {
            let momenta = self.momenta();
            self.split_step(&forces.with_any(momenta))
        } else {
            self.leapfrog_step(&forces)
        };
        let choices = self.choices();
        let account =
            external::add_account(self.model, &choices, self.workgroup_size(), u64::from(rows), &mut self.plan);
        if self.splits() && account > 0 {
            self.plan.kernels[self.plan.before_report[0]].constants.push((Constant::Halves, 2.0));
        }
        let rows = u64::from(rows) + account;
        let of_walls = walls::add_account(self.model, &choices, rows, &mut self.plan);
        self.plan.sample_observables(self.measured.every, &sums(self.model), rows + of_walls);
    }

    /// What passes choose that give frozen particles impulses before the end of a step.
    fn booking_of_layers(&self) -> Choices {
        if self.model.has_frozen_particles() { walls::booking(self.model) } else { Choices::new() }
    }

    /// A kernel that visits all pairs for a report, and leaves a row of sums for every workgroup, from a row on.
    fn observation(&mut self, name: &'static str, first_group: u32, pass: Choices) -> usize {
        let pass = pass.with_if(self.traversal == Traversal::Clusters, core::Reduction::OfEight);
        let kernel = self.traversal(name, self.traversal, Masks::Unkept, &pass);
        self.plan.kernels[kernel].constants.push((Constant::FirstGroup, f64::from(first_group)));
        self.plan.kernels[kernel].constants.extend(walls::frozen_sums(self.model, &sums(self.model)));
        kernel
    }

    /// One pass a step. Returns the number of rows of sums that the report leaves.
    fn leapfrog_step(&mut self, forces: &Choices) -> u32 {
        // Baths and random forces on single particles draw random words.
        let words = Choices::new().with_any(own::acts(self.model).then_some(words(self.model.generator)));
        let acting = own::choices(self.model).and(&words);
        let pass = self.end_of_step().with(pairs::Pass::Leapfrog).and(&walls::booking(self.model)).and(&acting);
        let names = ["leapfrog", "leapfrog_edges", "leapfrog_inner"];
        let advance = self.last_pass(names, self.traversal, Masks::Unkept, &pass);
        let report = self.observation(
            "report",
            0,
            forces.clone().with(pairs::Pass::ObserveLeapfrog).and(&own::report_choices(self.model)).and(&words),
        );
        let mut rows = self.plan.kernels[report].workgroups;
        let bonded = self.bonded(&mut rows);
        let stress = self.stress();
        let densities = self.densities(Masks::Unkept, &mut rows);
        self.plan.before_report = [&bonded.kicks[..], &densities.step].concat();
        self.plan.advance = self.end_with(&advance);
        self.plan.report = [&densities.report[..], &[report], &bonded.report, &stress, &bonded.stress].concat();
        self.plan.finish_report = self.plan.advance.clone();
        rows
    }

    /// Two passes a step, of which the second visits what the first has found. A report is in the middle of the drift:
    /// it sorts the particles there, and the drift is finished afterwards.
    fn split_step(&mut self, kept: &Choices) -> u32 {
        let with = |pass: pairs::Pass| Choices::new().with(pass);
        let once = self.visits_once();
        let dense = self.model.particles().have_local_densities();
        let found = with(pairs::Pass::Find).and(&self.booking_of_layers());
        let find = match (once, dense) {
            (true, _) => {
                let pass = with(pairs::Pass::Kick).and(&self.booking_of_layers());
                self.traversal("kick", self.traversal, Masks::Unkept, &pass)
            }
            (false, true) => self.traversal("find", self.traversal, Masks::Kept, &found),
            (false, false) => self.traversal("find", self.traversal, Masks::Keep, &found),
        };
        if !once && !dense {
            self.plan.kernels[find].renamed.push((Array::KeptMasks, Array::Particles));
        }
        let last = if once { Traversal::Alone } else { self.traversal };
        let to_the_end = self.end_of_step().with(pairs::Pass::Relax).and(&walls::booking(self.model));
        let relax = self.last_pass(["relax", "relax_edges", "relax_inner"], last, Masks::Kept, &to_the_end);
        for &kernel in &relax {
            self.plan.kernels[kernel].constants.push((Constant::Halves, 2.0));
        }
        let to_the_report = with(pairs::Pass::Relax).and(&walls::booking(self.model));
        let relax_to_report = self.traversal("relax_to_report", last, Masks::Kept, &to_the_report);
        self.plan.kernels[relax_to_report].constants.push((Constant::Halves, 1.0));
        let bathed = self.relaxes_particles() || self.model.particles().relaxes_bonds(self.model);
        let earlier = self.relaxes_in_two_stages() || bathed;
        let added = (earlier && kept.has(pairs::ReportedForce::Kept)).then_some(pairs::ReportedForce::Added);
        let motion =
            self.observation("report_motion", 0, kept.clone().with_any(added).with(pairs::Pass::ObserveMotion));
        let configuration = self.observation("report_configuration", 0, with(pairs::Pass::ObserveConfiguration));
        let choices = self.choices().and(&walls::booking(self.model));
        let rest = self.kernel("drift_rest", Entry::DriftRest, choices, self.slots);
        if self.is_sheared() {
            self.plan.kernels[configuration].constants.push(shear::moment(1));
        }
        for kernel in [find, motion, configuration] {
            self.plan.kernels[kernel].constants.push((Constant::Halves, 1.0));
        }
        let mut again = self.passed_on.clone();
        again.extend(self.sorting(&self.choices().with(core::Step::Same)));
        again.extend(self.mark_owned());
        let mut rows = self.plan.kernels[motion].workgroups;
        let bonded = self.bonded(&mut rows);
        let stress = [self.stress(), bonded.stress].concat();
        let baths = [self.relax_particles(), self.relax_bonds()].concat();
        let densities = self.densities(if once { Masks::Unkept } else { Masks::Keep }, &mut rows);
        if self.is_sheared() {
            for kernel in &densities.report {
                self.plan.kernels[*kernel].constants.push(shear::moment(1));
            }
        }
        self.plan.before_report = [&bonded.kicks[..], &densities.step, &[find], &baths].concat();
        self.plan.advance = self.end_with(&relax);
        let motion_there = [&bonded.report[..], &stress, &[motion, relax_to_report]].concat();
        self.plan.report =
            [&motion_there[..], &again, &bonded.configuration, &densities.report, &[configuration]].concat();
        if self.relaxes_in_two_stages() {
            self.first_stage(&[&relax[..], &[relax_to_report, motion]].concat(), kept);
        }
        self.plan.finish_report = [&[rest], &self.passed_on[..], &self.scan].concat();
        rows
    }

    /// Adds the first of two stages of friction, which leaves momenta for these kernels, those of the second.
    fn first_stage(&mut self, second: &[usize], kept: &Choices) {
        let pass = self
            .booking_of_layers()
            .with(pairs::Pass::RelaxFirst)
            .with_if(self.texels, pairs::Staged::Apart)
            .with_if(self.texels, arrays::StagedMomenta::Texture);
        let first = self.traversal("relax_first", self.traversal, Masks::Kept, &pass);
        let bathed = self.relaxes_particles() || self.model.particles().relaxes_bonds(self.model);
        let later = bathed && kept.has(pairs::ReportedForce::Kept);
        let kept = kept.clone().with_if(later, pairs::ReportedForce::Added);
        let report = self.observation("report_first_stage", 0, kept.with(pairs::Pass::ObserveFirstStage));
        let [first_stage, second_stage] = stages();
        for kernel in [first, report] {
            self.plan.kernels[kernel].constants.extend(first_stage);
        }
        let taken = self.staged();
        for &kernel in second {
            self.plan.kernels[kernel].constants.extend(second_stage);
            self.plan.kernels[kernel].renamed.push(taken);
        }
        self.plan.before_report.push(first);
        self.plan.report.insert(0, report);
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

    /// The particles of a report.
    fn reported(&self) -> Reported {
        Reported {
            choices: space_of(&self.model.units, predicted(self.model))
                .and(&self.species.choices())
                .and(&shear::of_species(self.model, self.species.have_table())),
            particles: if self.options.part.is_some() { Array::Reported } else { Array::Particles },
            // The particles of a split step's report are half a drift later, and have been kicked for it.
            momenta: self.splits().then_some(Array::ReportedMomenta),
            forces: Array::ReportedForces,
        }
    }

    /// The particles by cell, as every step orders them.
    fn ordered(&self) -> Ordered {
        // Where a report moves the particles on, distances are counted there too.
        Ordered { choices: self.choices(), kernels: Vec::new(), grid: self.grid, needs_report: self.splits() }
    }

    /// Keeps the momenta of a split step's report, where an analysis or a trajectory needs them: analyses of a sheared box without those of
    /// the flow.
    fn momenta(&mut self) -> Option<pairs::ReportedMomentum> {
        let analysed = self.measured.needs(Need::Momenta);
        if !analysed && !self.measured.frames {
            return None;
        }
        self.plan.add_buffer(Array::ReportedMomenta, 16 * self.particles);
        let peculiar = analysed && self.is_sheared();
        Some(if peculiar { pairs::ReportedMomentum::Peculiar } else { pairs::ReportedMomentum::Kept })
    }

    /// Keeps the forces of a report, where an analysis needs them.
    fn forces(&mut self) -> Option<pairs::ReportedForce> {
        if !self.measured.needs(Need::Forces) {
            return None;
        }
        // Impulses of half a step where one kick is taken twice, of a whole one where friction relaxes between two kicks.
        let time = if self.splits() { 1.0 } else { 0.5 } * self.model.time_step;
        self.plan.force_unit = self.model.units.momentum / time;
        self.plan.add_buffer(Array::ReportedForces, 16 * self.particles);
        Some(pairs::ReportedForce::Kept)
    }

    fn buffers(&mut self) {
        let rows = self.grid.rows();
        let cells = self.grid.count();
        let width = u64::from(self.grid.cells[0]) + if self.grid.framed() { 2 } else { 0 };
        let copies = self.frame_capacity();
        self.plan.add_buffer(Array::Control, 64);
        if !self.texels {
            // Particles as they are stored and sorted, their cells, counts and ranks, the clock, and these.
            self.plan.storage_buffers = self.plan.storage_buffers.max(6 + self.more_buffers());
            if own::products(self.model) > 0 {
                // A report has sums in the place of counts and ranks, and the ends of tethers.
                let forces = u32::from(self.measured.needs(Need::Forces));
                let dense = u32::from(self.model.particles().have_local_densities());
                let report = 5 + 3 + u32::from(self.species.have_table()) + dense + forces;
                self.plan.storage_buffers = self.plan.storage_buffers.max(report);
            }
        }
        self.plan.add_buffer(Array::Particles, PARTICLE * self.slots);
        if self.texels {
            let count = self.slots + copies;
            self.plan.add_texture(Array::SortedPositions, count);
            self.plan.add_texture(Array::SortedMomenta, count);
            if self.relaxes_in_two_stages() {
                self.plan.add_texture(Array::StagedMomenta, count);
            }
        } else {
            let count = self.slots + copies;
            self.plan.add_buffer(Array::Sorted, PARTICLE * count);
            if self.relaxes_in_two_stages() {
                self.plan.add_buffer(Array::Staged, PARTICLE * count);
            }
            if self.keeps_probes() {
                self.plan.add_buffer(Array::Probes, 4 * count);
            }
        }
        self.plan.add_buffer(Array::Cells, 4 * (rows * width + 1 + rows));
        self.plan.add_buffer(Array::Counts, 4 * cells);
        self.plan.add_buffer(Array::Ranks, 4 * self.slots);
        self.plan.add_row_sums(rows, cells, self.options);
        if self.scans_at_end {
            self.plan.add_buffer(Array::WorkgroupsDone, 4);
        }
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
            let ranges = ranges(self.force, count);
            if self.relaxes_particles() {
                table.extend(self.particle_entries());
            } else if own::bathes(self.model) {
                for species in 0..count {
                    table.extend(own::coefficients(&self.scales(), species).map(|value| value as f32));
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

    fn workgroup_size(&self) -> u64 {
        self.options.workgroup()
    }

    /// Room for the copies in the frames: a quarter more than the share of the end cells, and never more than all particles.
    fn frame_capacity(&self) -> u64 {
        if self.grid.framed() {
            self.options.copies.unwrap_or(5 * self.slots / (2 * u64::from(self.grid.cells[0])) + 512).min(self.slots)
        } else {
            0
        }
    }
}
