//! Samplers: kernels that turn a report into a row of sums, and the steps at which they do.

use crate::document::AnalysisId;
use crate::shaders::Array;
use std::ops::Range;

/// What a sampler is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SamplerId {
    /// The observables.
    Observables,
    /// An analysis.
    Analysis(AnalysisId),
}

impl SamplerId {
    /// Its name, for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Observables => "observables",
            Self::Analysis(analysis) => analysis.name(),
        }
    }
}

/// Kernels that turn the particles of a report into one row of sums.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampler {
    /// What is sampled.
    pub id: SamplerId,
    /// The first step sampled.
    pub first: u64,
    /// Steps between two samples.
    pub every: u64,
    /// Kernels in order, as indices into [`Plan::kernels`](super::Plan::kernels).
    pub kernels: Vec<usize>,
    /// The buffer that receives the rows.
    pub samples: Array,
    /// Number of sums in a row.
    pub quantities: usize,
    /// Rows the buffer holds.
    pub capacity: u64,
    /// Whether the kernels read the particles that the report leaves in the order of their ids.
    pub needs_report: bool,
    /// Whether they read those of all ranks, which the first gathers.
    pub gathered: bool,
    /// What stays on the device from one sample to the next, if anything.
    pub window: Option<Window>,
    /// Sums that each of several ranks finds whole, by their places in a row; all others are added over the ranks.
    pub whole: Range<usize>,
}

/// A window of samples, each compared with the first: a buffer of the plan holds the particles as they were then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// The buffer.
    pub buffer: Array,
    /// Samples in a window; the next begins a new one.
    pub samples: u64,
}

impl Sampler {
    /// Whether a sample is due at a step.
    #[must_use]
    pub fn due(&self, step: u64) -> bool {
        step >= self.first && (step - self.first).is_multiple_of(self.every)
    }

    /// The next step after one with a sample.
    pub(crate) fn next_after(&self, step: u64) -> u64 {
        if step < self.first {
            return self.first;
        }
        let every = self.every.max(1);
        self.first.saturating_add(((step - self.first) / every + 1).saturating_mul(every))
    }

    /// Number of samples before a step.
    ///
    /// ```
    /// # use mesoscope::plan::{Hardware, Options};
    /// # use mesoscope::{run::plan, scene};
    /// let scene = scene::load("dpd-fluid", &[r#"output={"energies":{"every":20}}"#.to_owned()])?;
    /// let plan = plan(&scene, Hardware::default(), Options::default());
    /// assert_eq!([0, 1, 20, 21].map(|step| plan.samplers[0].samples_before(step)), [0, 1, 1, 2]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn samples_before(&self, step: u64) -> u64 {
        step.saturating_sub(self.first).div_ceil(self.every.max(1))
    }

    /// The buffer of the window that is open before the sample of a step, and the number of its samples so far.
    pub(crate) fn open_window(&self, step: u64) -> Option<(Array, u64)> {
        let window = self.window?;
        let taken = self.samples_before(step) % window.samples;
        (taken > 0).then_some((window.buffer, taken))
    }
}
