//! What a report leaves for analyses and trajectories.

use super::{Builder, Order};
use crate::families::particles::space::shear::plan as shear;
use crate::plan::{Need, Ordered, Reported, switch};
use crate::shaders::{Array, Constant, pairs};

impl Builder<'_> {
    /// The particles of a report.
    pub(super) fn reported(&self) -> Reported {
        let aside = self.order != Order::EveryStep;
        let sheared = self.is_sheared();
        Reported {
            choices: self.space().and(&self.species.choices()).with_if(sheared, pairs::Apart::Sheared),
            // The particles of a split step's report are half a drift later.
            between: if sheared && self.splits() { vec![shear::moment(1)] } else { Vec::new() },
            particles: if aside || self.options.part.is_some() { Array::Reported } else { Array::Particles },
            // And have been kicked for it.
            momenta: self.splits().then_some(Array::ReportedMomenta),
            forces: Array::ReportedForces,
        }
    }

    /// The particles by cell, as every step orders them, or as an analysis needs them.
    pub(super) fn ordered(&mut self) -> Option<Ordered> {
        let aside = self.order != Order::EveryStep;
        if aside && !self.measured.needs(Need::Order) {
            return None;
        }
        let kernels = if aside { self.order_aside() } else { Vec::new() };
        let choices = if aside { self.sorted_beside() } else { self.choices() };
        // Where a report moves the particles on, distances are counted there too.
        Some(Ordered { choices, kernels, grid: self.grid, needs_report: self.splits() })
    }

    /// Keeps the momenta of a split step's report, where an analysis or a trajectory needs them: analyses of a sheared
    /// box without those of the flow.
    pub(super) fn keep_momenta(&mut self) {
        let analysed = self.measured.needs(Need::Momenta);
        let kept = self.splits() && (analysed || self.measured.frames);
        let peculiar = analysed && self.is_sheared();
        self.plan.constants.push((Constant::KeepsMomenta, f64::from(u8::from(kept) + u8::from(kept && peculiar))));
        if kept {
            self.plan.add_buffer(Array::ReportedMomenta, 16 * self.particles);
        }
    }

    /// Keeps the forces of a report, where an analysis needs them.
    pub(super) fn keep_forces(&mut self) {
        let kept = self.measured.needs(Need::Forces);
        self.plan.constants.push(switch(Constant::KeepsForces, kept));
        if !kept {
            return;
        }
        // Impulses of half a step where one kick is taken twice, of a whole one where friction relaxes between two
        // kicks.
        let time = if self.splits() { 1.0 } else { 0.5 } * self.model.time_step;
        self.plan.force_unit = self.model.units.momentum / time;
        self.plan.add_buffer(Array::ReportedForces, 16 * self.particles);
    }
}
