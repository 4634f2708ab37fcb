//! How many steps to hand to the device at a time.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Time a batch should take: long enough that submitting costs nothing, short enough to see a failure soon.
const TARGET: f64 = 0.15;
const LARGEST: u64 = 512;
/// Particle-steps in a first batch that the slowest adapters finish within seconds.
const CAUTION: u64 = 8_000_000;
/// Batches that may still be under way when a call returns.
const IN_FLIGHT: usize = 2;

/// Measures the rate and sets the size of the batches; results never depend on it.
#[derive(Debug)]
pub(super) struct Pace {
    batch: u64,
    /// Sizes of the batches that the device may not have finished, the oldest first.
    waiting: VecDeque<u64>,
    /// Steps since the device was last idle, and since when.
    since_idle: u64,
    idle_at: Instant,
    returned_at: Instant,
    /// Steps that are certainly done, and the time spent on them.
    done: u64,
    spent: Duration,
}

impl Pace {
    pub(super) fn new(particles: u64) -> Self {
        let now = Instant::now();
        Self {
            batch: (CAUTION / particles.max(1)).clamp(1, 8),
            waiting: VecDeque::new(),
            since_idle: 0,
            idle_at: now,
            returned_at: now,
            done: 0,
            spent: Duration::ZERO,
        }
    }

    /// Steps to submit next.
    pub(super) fn batch(&self) -> u64 {
        self.batch
    }

    /// Steps done and time spent on them, pictures and checkpoints left out.
    pub(super) fn done(&self) -> (u64, Duration) {
        (self.done, self.spent)
    }

    /// The device is idle and steps begin: the time from here on is theirs.
    pub(super) fn begin(&mut self) {
        self.idle_at = Instant::now();
        self.returned_at = self.idle_at;
        self.since_idle = 0;
        self.waiting.clear();
    }

    /// A batch was submitted, and all but the last few before it are done.
    pub(super) fn submitted(&mut self, steps: u64) {
        self.waiting.push_back(steps);
        self.since_idle += steps;
        let now = Instant::now();
        let interval = now - self.returned_at;
        self.returned_at = now;
        if self.waiting.len() > IN_FLIGHT
            && let Some(finished) = self.waiting.pop_front()
        {
            self.done += finished;
            self.spent += interval;
            self.adapt(finished, interval);
        } else {
            self.spent += interval;
        }
    }

    /// The device has finished everything.
    pub(super) fn finished(&mut self) {
        let now = Instant::now();
        self.done += self.waiting.drain(..).sum::<u64>();
        self.spent += now - self.returned_at;
        self.adapt(self.since_idle, now - self.idle_at);
        self.begin();
    }

    fn adapt(&mut self, steps: u64, time: Duration) {
        if steps > 0 {
            let wanted = TARGET * steps as f64 / time.as_secs_f64().max(1e-9);
            self.batch = (wanted as u64).clamp(1, (2 * self.batch).min(LARGEST));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_grow_to_the_target_and_shrink_at_once() {
        let mut pace = Pace::new(1000);
        assert_eq!(pace.batch(), 8);
        for expected in [16, 32, 64, 128, 150, 150] {
            pace.adapt(1000, Duration::from_secs(1));
            assert_eq!(pace.batch(), expected);
        }
        pace.adapt(10, Duration::from_secs(1));
        assert_eq!(pace.batch(), 1);
        for _ in 0..20 {
            pace.adapt(1_000_000, Duration::from_secs(1));
        }
        assert_eq!(pace.batch(), LARGEST);
        assert_eq!(Pace::new(4_000_000).batch(), 2);
        assert_eq!(Pace::new(0).batch(), 8);
    }

    #[test]
    fn every_step_is_counted_once() {
        let mut pace = Pace::new(1000);
        for steps in [8, 16, 32, 64] {
            pace.submitted(steps);
        }
        assert_eq!(pace.done().0, 24);
        pace.finished();
        assert_eq!(pace.done().0, 120);
        pace.finished();
        assert_eq!(pace.done().0, 120);
    }
}
