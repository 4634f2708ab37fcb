//! The stress at a report of pairs, and of bonds and angles beside them, where an analysis needs it.

use crate::families::particles::plan::step::{Builder, Masks, stages};
use crate::families::particles::plan::stress;
use crate::plan::Traversal;
use crate::shaders::{Array, Choices, pairs};

impl Builder<'_> {
    /// The kernels that leave the stress of pairs, from what the report of the motion finds; none where no analysis needs it. Those of
    /// the second of two stages of friction come first.
    pub(crate) fn stress(&mut self) -> Vec<usize> {
        if !stress::is_needed(self.measured) {
            return Vec::new();
        }
        let mut kernels = vec![stress::begin(self.model, self.options.workgroup(), &mut self.plan)];
        if self.traversal == Traversal::Alone {
            return kernels;
        }
        if !self.splits() {
            kernels.push(self.stress_of_pairs("stress", pairs::Pass::LeapfrogStress));
            return kernels;
        }
        let whole = self.stress_of_pairs("stress", pairs::Pass::SplitStress);
        kernels.push(whole);
        if self.relaxes_in_two_stages() {
            let first = self.stress_of_pairs("stress_of_first_stage", pairs::Pass::FirstStageStress);
            let [first_stage, second_stage] = stages();
            self.plan.kernels[first].constants.extend(first_stage);
            self.plan.kernels[whole].constants.extend(second_stage);
            let staged = self.staged();
            self.plan.kernels[whole].renamed.push(staged);
            kernels.push(first);
        }
        kernels
    }

    fn stress_of_pairs(&mut self, name: &'static str, pass: pairs::Pass) -> usize {
        self.traversal(name, self.traversal, Masks::Unkept, &Choices::new().with(pass))
    }

    /// Where the second of two stages of friction finds the momenta that the first has left.
    pub(crate) fn staged(&self) -> (Array, Array) {
        if self.texels { (Array::SortedMomenta, Array::StagedMomenta) } else { (Array::Sorted, Array::Staged) }
    }
}
