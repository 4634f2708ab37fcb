//! What crosses the faces: momentum, mass and energy, as each part of a step asks for.

use super::Builder;

/// What a part of a step exchanges, in which time, and how fast cells are then taken to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Pressure and mass, in half a step.
    Pressure,
    /// Friction and heat in a whole step, with the velocities that the solver has found.
    Friction,
    /// Heat alone, in a whole step.
    Heat,
    /// Everything, in a whole step, from what there is at its beginning.
    Everything,
}

impl Builder<'_> {
    /// Kernels that compute a part of a step and leave it in a buffer.
    pub(super) fn exchange(&mut self, part: Part, into: &'static str) -> Vec<usize> {
        let pressure = matches!(part, Part::Pressure | Part::Everything);
        let predicted = pressure && self.cells.keeps_energy();
        let mut kernels = Vec::new();
        if predicted {
            kernels.push(self.predict(part));
        }
        let heat = part != Part::Pressure && self.conducts();
        let mut modules = vec!["common/side"];
        modules.extend(match part {
            _ if predicted => ["common/side_predicted"],
            Part::Pressure | Part::Everything => ["common/side_start"],
            Part::Friction => ["common/side_solved"],
            Part::Heat => ["common/side_warm"],
        });
        modules.extend(self.forces(part, heat));
        let limits = heat || (pressure && self.has_limits());
        if limits && !modules.contains(&"common/limit_on") {
            modules.push("common/limit_on");
        }
        if !limits {
            modules.push("common/limit_off");
        }
        modules.push(if heat { "common/conduction_on" } else { "common/conduction_off" });
        modules.push(if self.cells.keeps_energy() { "common/energy_on" } else { "common/energy_off" });
        modules.push(match (part, pressure && self.cells.exchanges_mass(), self.cells.keeps_energy()) {
            (Part::Heat, _, _) => "common/moved_heat",
            (_, false, false) => "common/moved_momentum",
            (_, true, false) => "common/moved_mass",
            (_, false, true) => "common/moved_energy",
            (_, true, true) => "common/moved_all",
        });
        modules.push("kernels/exchange");
        let exchange = self.face_kernel("exchange", &modules, part);
        if into != "exchanges" {
            self.plan.kernels[exchange].renamed = vec![("exchanges", into)];
        }
        kernels.push(exchange);
        kernels
    }

    /// The kernel that looks ahead, so that energies are exchanged at the velocities in the middle of a part.
    fn predict(&mut self, part: Part) -> usize {
        if !self.plan.buffers.iter().any(|buffer| buffer.name == "predictions") {
            self.plan.add_buffer("predictions", "what an exchange is expected to bring", 16 * self.particles);
        }
        let mut modules = vec!["common/side", "common/side_start"];
        modules.extend(self.forces(part, false));
        modules.extend([
            if part == Part::Everything { "common/middle_start" } else { "common/middle_halfway" },
            "kernels/predict",
        ]);
        self.face_kernel("predict", &modules, part)
    }

    /// Modules of the forces of a part, with the random words they and heat need.
    fn forces(&self, part: Part, heat: bool) -> Vec<&'static str> {
        let rubs = match part {
            Part::Pressure | Part::Heat => false,
            Part::Friction | Part::Everything => self.rubs(),
        };
        let mut modules = match part {
            Part::Pressure | Part::Everything => self.form(),
            Part::Friction | Part::Heat => vec!["common/form_off", "common/sweep_free"],
        };
        modules.extend(if rubs { self.rubbing() } else { vec!["common/rubbing_off"] });
        if heat || (rubs && self.rubs_at_random()) {
            modules.extend(self.words());
            modules.push("common/key_of_step");
        } else {
            modules.push("common/key_unused");
        }
        modules
    }

    /// Modules of friction and its noise, but for the words.
    pub(super) fn rubbing(&self) -> Vec<&'static str> {
        let random = if self.rubs_at_random() { "common/random_impulse_on" } else { "common/random_impulse_off" };
        vec!["common/rubbing_on", random]
    }

    /// A kernel over the faces of cells.
    fn face_kernel(&mut self, name: &'static str, modules: &[&'static str], part: Part) -> usize {
        let step = self.model.time_step * if part == Part::Pressure { 0.5 } else { 1.0 };
        let modules = [&self.cell()[..], &["common/face", "common/facet"], modules].concat();
        let groups = self.groups(self.particles);
        let kernel = self.kernel(name, &modules, groups);
        self.plan.kernels[kernel].constants = vec![("STEP", step)];
        kernel
    }
}
