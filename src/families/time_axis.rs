//! The times of steps.

use serde::{Deserialize, Serialize};

/// The times of the steps of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TimeAxis {
    /// A step.
    pub step: u64,
    /// Its time.
    pub time: f64,
    /// The time between two steps.
    pub interval: f64,
}

impl TimeAxis {
    /// The time of a step.
    ///
    /// ```
    /// use mesoscope::families::TimeAxis;
    ///
    /// let axis = TimeAxis { step: 100, time: 1.0, interval: 0.25 };
    /// assert_eq!([100, 104].map(|step| axis.at(step)), [1.0, 2.0]);
    /// ```
    #[must_use]
    pub fn at(&self, step: u64) -> f64 {
        self.time + step.saturating_sub(self.step) as f64 * self.interval
    }

    /// The same of a step that a sample keeps as a number.
    pub(crate) fn at_sample(&self, step: f64) -> f64 {
        self.at(step as u64)
    }
}
