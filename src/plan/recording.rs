//! Kernels that write sums into rows of samples, where the host reads them.

use super::{Kernel, Plan, Sampler, SamplerId, Sums};
use crate::shaders::{Array, Choices, Constant, Entry};

/// Rows of samples kept on the device between two readbacks.
pub(crate) const SAMPLE_ROWS: u64 = 1024;

/// The kernel that adds up the sums of all workgroups and records them.
pub(crate) fn record_sums(name: &'static str, quantities: u64, groups: u64) -> Kernel {
    Kernel::new(name, Entry::RecordSample, Choices::new(), 1)
        .with(vec![(Constant::Quantities, quantities as f64), (Constant::Groups, groups as f64)])
}

/// The kernel that records a histogram and clears it.
pub(crate) fn record_histogram(bins: u64) -> Kernel {
    Kernel::new("record_histogram", Entry::RecordHistogram, Choices::new(), 1).with(vec![(Constant::Bins, bins as f64)])
}

impl Plan {
    /// Adds the sampler of the observables: each workgroup of the report leaves a row of these sums.
    pub(crate) fn sample_observables(&mut self, every: u64, sums: &Sums, groups: u64) {
        self.constants.extend(sums.constants());
        let quantities = sums.len() as u64;
        let record = self.add_kernel(record_sums("record_observables", quantities, groups));
        self.samplers.push(Sampler {
            id: SamplerId::Observables,
            first: 0,
            every,
            kernels: vec![record],
            samples: Array::Samples,
            quantities: quantities as usize,
            capacity: SAMPLE_ROWS,
            needs_report: true,
            gathered: false,
            window: None,
            whole: 0..0,
        });
        self.add_buffer(Array::PartialSums, 8 * quantities * groups);
        self.add_buffer(Array::Samples, 8 * (1 + SAMPLE_ROWS * (1 + quantities)));
    }
}
