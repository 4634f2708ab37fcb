//! The scheme of a step: one pass over particles of a leapfrog step, two or three of a split one.

use super::{Builder, Masks, Order};
use crate::families::particles::space::shear::plan as shear;
use crate::families::particles::space::walls::plan as walls;
use crate::families::particles::sums::sums;
use crate::families::particles::terms::body_forces::plan as external;
use crate::plan::{Need, Traversal};
use crate::shaders::{Array, Choices, Constant, Entry, core, pairs};

/// Friction and noise of the two stages of a relaxation: shaders/pairs/friction.wgsl.
///
/// (1 - α₁h)(1 - α₂h) = 1 - h + bh² for a mode of eigenvalue h, which has the noise β₁(1 - α₂h) + β₂ = 1 - (1 + 2b)h/4
/// times √(2kT h). Its temperature is kT (1 - .298h)²/(1 - .595h + .095h² - .0045h³): within 1.1 % up to h = 2.
pub(crate) fn stages() -> [[(Constant, f64); 2]; 2] {
    let b = 0.095_f64;
    let alpha = [0.5 - (0.25 - b).sqrt(), 0.5 + (0.25 - b).sqrt()];
    let first = (1.0 + 2.0 * b) / (4.0 * alpha[1]);
    let beta = [first, 1.0 - first];
    // Noise comes with √(kT c/2).
    [0, 1].map(|stage| [(Constant::StageFriction, alpha[stage]), (Constant::StageNoise, 2.0 * beta[stage])])
}

impl Builder<'_> {
    pub(super) fn integration(&mut self) {
        self.keep_forces();
        self.keep_momenta();
        self.plan.operations_per_particle = self.operations();
        let rows = if self.splits() { self.split_step() } else { self.leapfrog_step() };
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
    pub(super) fn booking_of_layers(&self) -> Choices {
        if self.model.frozen_particles() > 0 { walls::booking(self.model) } else { Choices::new() }
    }

    /// A kernel that visits all pairs for a report, and leaves a row of sums for every workgroup, from a row on.
    pub(crate) fn observation(&mut self, name: &'static str, first_group: u32, pass: Choices) -> usize {
        let pass = pass.with_if(self.traversal == Traversal::Clusters, core::Reduction::OfEight);
        let kernel = self.traversal(name, self.traversal_of_reports(), Masks::Unkept, &pass);
        self.plan.kernels[kernel].constants.push((Constant::FirstGroup, f64::from(first_group)));
        self.plan.kernels[kernel].constants.extend(walls::frozen_sums(self.model, &sums(self.model)));
        kernel
    }

    /// One pass a step. Returns the number of rows of sums that the report leaves.
    fn leapfrog_step(&mut self) -> u32 {
        let pass = self.sorted.end_of_step().with(pairs::Pass::Leapfrog).and(&walls::booking(self.model));
        let names = ["leapfrog", "leapfrog_edges", "leapfrog_inner"];
        let last = self.last_pass(names, self.traversal, Masks::Unkept, &pass);
        let report = self.observation("report", 0, Choices::new().with(pairs::Pass::ObserveLeapfrog));
        let mut rows = self.plan.kernels[report].workgroups;
        let gathering = self.gathering(&mut rows);
        let stress = self.stress();
        let densities = self.densities(Masks::Unkept, &mut rows);
        self.plan.before_report = densities.step;
        // Baths that remember are advanced once: a report leaves them as they are, and gathers impulses of its own.
        self.plan.advance = [gathering.kicks, self.end_with(&last)].concat();
        self.plan.report = [&densities.report[..], &gathering.report, &[report], &stress, &gathering.stress].concat();
        self.plan.finish_report = self.plan.advance.clone();
        rows
    }

    /// Two passes a step, of which the second visits what the first has found. A report is in the middle of the drift:
    /// it sorts the particles there, and the drift is finished afterwards.
    fn split_step(&mut self) -> u32 {
        let with = |pass: pairs::Pass| Choices::new().with(pass);
        let once = self.visits_once();
        let dense = self.model.particles().have_local_densities();
        let first = self.booking_of_layers();
        let found = with(pairs::Pass::Find).and(&first);
        let find = match (once, dense) {
            (true, _) => {
                let pass = with(pairs::Pass::Kick).and(&first);
                self.traversal("kick", self.traversal, Masks::Unkept, &pass)
            }
            (false, true) => self.traversal("find", self.traversal, Masks::Kept, &found),
            (false, false) => self.traversal("find", self.traversal, Masks::Keep, &found),
        };
        if !once && !dense {
            self.plan.kernels[find].renamed.push((Array::KeptMasks, Array::Particles));
        }
        let last = if once { Traversal::Alone } else { self.traversal };
        let to_the_end = self.sorted.end_of_step().with(pairs::Pass::Relax).and(&walls::booking(self.model));
        let relax = self.last_pass(["relax", "relax_edges", "relax_inner"], last, Masks::Kept, &to_the_end);
        for &kernel in &relax {
            self.plan.kernels[kernel].constants.push((Constant::Halves, 2.0));
        }
        let to_the_report = with(pairs::Pass::Relax).and(&walls::booking(self.model));
        let relax_to_report = self.traversal("relax_to_report", last, Masks::Kept, &to_the_report);
        self.plan.kernels[relax_to_report].constants.push((Constant::Halves, 1.0));
        let earlier = self.relaxes_in_two_stages() || self.leaves_forces();
        let motion = self.observation("report_motion", 0, with(pairs::Pass::ObserveMotion));
        self.adds_forces(motion, earlier);
        let configuration = self.observation("report_configuration", 0, with(pairs::Pass::ObserveConfiguration));
        let choices = self.choices().and(&walls::booking(self.model));
        let rest = self.kernel("drift_rest", Entry::DriftRest, choices, self.slots);
        self.plan.kernels[rest].constants.push((Constant::Halves, 1.0));
        if self.is_sheared() {
            self.plan.kernels[configuration].constants.push(shear::moment(1));
        }
        // Baths see whole drifts.
        let seen = if self.model.particles().acts_on_particles() { 2.0 } else { 1.0 };
        for (kernel, halves) in [(find, seen), (motion, 1.0), (configuration, 1.0)] {
            self.plan.kernels[kernel].constants.push((Constant::Halves, halves));
        }
        let mut again = self.passed_on.clone();
        if self.order == Order::EveryStep {
            again.extend(self.sorting(&self.choices().with(core::Step::Same)));
            again.extend(self.mark_owned());
        }
        let mut rows = self.plan.kernels[motion].workgroups;
        let gathering = self.gathering(&mut rows);
        let stress = self.stress();
        let baths = [self.relax_particles(), self.relax_bonds()].concat();
        let densities = self.densities(if once { Masks::Unkept } else { Masks::Keep }, &mut rows);
        if self.is_sheared() {
            for kernel in &densities.report {
                self.plan.kernels[*kernel].constants.push(shear::moment(1));
            }
        }
        let mut first = [&gathering.kicks[..], &densities.step, &[find], &baths].concat();
        let mut report_first = None;
        if self.relaxes_in_two_stages() {
            let [step, report] = self.first_stage(&[&relax[..], &[relax_to_report, motion]].concat());
            first.push(step);
            report_first = Some(report);
        }
        // Stresses are cleared before any are added.
        let (clear, stress) = stress.split_at(stress.len().min(1));
        let bonded = [&gathering.report[..], clear, &gathering.stress].concat();
        let motion_there: Vec<usize> =
            report_first.into_iter().chain(stress.iter().copied()).chain([motion, relax_to_report]).collect();
        let there = [&again[..], &gathering.configuration, &densities.report, &[configuration]].concat();
        let last = self.end_with(&relax);
        if self.bonds_remember() {
            self.plan.advance = [&first[..], &last].concat();
            self.plan.report = [bonded, first, motion_there, there].concat();
        } else {
            self.plan.before_report = first;
            self.plan.advance = last;
            self.plan.report = [bonded, motion_there, there].concat();
        }
        self.plan.finish_report = [&[rest], &self.passed_on[..], &self.scan].concat();
        rows
    }

    /// Whether baths and random forces on single particles are part of the forces of a split step's report.
    pub(crate) fn reports_own_forces(&self) -> bool {
        self.splits() && self.model.particles().acts_on_particles() && self.measured.needs(Need::Forces)
    }

    /// Whether the forces of a split step's report are begun before pairs are.
    fn leaves_forces(&self) -> bool {
        self.relaxes_particles() || self.model.particles().relaxes_bonds() || self.reports_own_forces()
    }

    /// Says whether a kernel of a report adds its forces to those that an earlier one has left.
    pub(crate) fn adds_forces(&mut self, kernel: usize, adds: bool) {
        if adds && self.measured.needs(Need::Forces) {
            self.plan.kernels[kernel].constants.push((Constant::ForcesBegun, 1.0));
        }
    }

    /// Makes the first of two stages of friction, which leaves momenta for these kernels, those of the second; and its
    /// report.
    fn first_stage(&mut self, second: &[usize]) -> [usize; 2] {
        let pass = self.booking_of_layers().with(pairs::Pass::RelaxFirst).and(&self.sorted.staged_choices());
        let first = self.traversal("relax_first", self.traversal, Masks::Kept, &pass);
        let seen = Choices::new().with(pairs::Pass::ObserveFirstStage);
        let report = self.observation("report_first_stage", 0, seen);
        self.adds_forces(report, self.leaves_forces());
        let [first_stage, second_stage] = stages();
        for kernel in [first, report] {
            self.plan.kernels[kernel].constants.extend(first_stage);
        }
        let taken = self.staged();
        for &kernel in second {
            self.plan.kernels[kernel].constants.extend(second_stage);
            self.plan.kernels[kernel].renamed.push(taken);
        }
        [first, report]
    }
}
