//! How many steps to hand to the device at a time.

use crate::engine::{EngineError, Stepper};
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Time a batch should take: long enough that submitting costs nothing, short enough to see a failure soon.
const TARGET: f64 = 0.15;
/// The same where each call has to return soon, with two more batches on their way.
const SOON: f64 = 0.02;
const LARGEST: u64 = 512;
/// Operations in a first batch that the slowest adapters finish within seconds, and of a particle at least.
const CAUTION: f64 = 2e10;
const FEWEST: f64 = 2500.0;
/// Batches that may still be under way when a call returns.
const IN_FLIGHT: usize = 2;

/// Measures the rate and sets the size of the batches; results never depend on it.
#[derive(Debug)]
pub(super) struct Pace {
    /// Time a batch should take.
    target: f64,
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
    /// The same when the first batch was done: drivers compile kernels as these are first used.
    warm: Option<(u64, Duration)>,
}

impl Pace {
    /// Of steps that take so many operations a particle.
    pub(super) fn new(particles: u64, operations: f64) -> Self {
        let now = Instant::now();
        let operations = particles as f64 * operations.max(FEWEST);
        Self {
            target: TARGET,
            batch: ((CAUTION / operations) as u64).clamp(1, 8),
            waiting: VecDeque::new(),
            since_idle: 0,
            idle_at: now,
            returned_at: now,
            done: 0,
            spent: Duration::ZERO,
            warm: None,
        }
    }

    /// The same for calls that return soon.
    pub(super) fn for_looking(particles: u64, operations: f64) -> Self {
        Self { target: SOON, ..Self::new(particles, operations) }
    }

    /// Steps to submit next.
    pub(super) fn batch(&self) -> u64 {
        self.batch
    }

    /// Steps done and time spent on them, pictures and checkpoints left out.
    pub(super) fn done(&self) -> (u64, Duration) {
        (self.done, self.spent)
    }

    /// Steps a second, but for the first batch; none as long as no other one is done.
    pub(super) fn rate(&self) -> Option<f64> {
        let (done, spent) = self.warm?;
        let (steps, seconds) = (self.done - done, self.spent.saturating_sub(spent).as_secs_f64());
        (steps > 0 && seconds > 0.0).then(|| steps as f64 / seconds)
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
            self.note_first();
        } else {
            self.spent += interval;
        }
    }

    fn note_first(&mut self) {
        if self.warm.is_none() && self.done > 0 {
            self.warm = Some(self.done());
        }
    }

    /// The device has finished everything.
    pub(super) fn finished(&mut self) {
        let now = Instant::now();
        self.done += self.waiting.drain(..).sum::<u64>();
        self.spent += now - self.returned_at;
        self.adapt(self.since_idle, now - self.idle_at);
        self.note_first();
        self.begin();
    }

    fn adapt(&mut self, steps: u64, time: Duration) {
        if steps > 0 {
            let wanted = self.target * steps as f64 / time.as_secs_f64().max(1e-9);
            self.batch = (wanted as u64).clamp(1, (2 * self.batch).min(LARGEST));
        }
    }
}

/// The observer of every batch.
type EachBatch<'e, E> =
    dyn FnMut(&mut dyn Stepper, &mut Pace, Result<(), EngineError>) -> Result<ControlFlow<()>, E> + 'e;

/// Advances batch by batch until a step. After every batch `each` receives what became of it: a failure is found a few batches late, and what
/// came before it is good. It may end the advance early.
pub(super) fn advance<E>(
    engine: &mut dyn Stepper,
    pace: &mut Pace,
    last: u64,
    each: &mut EachBatch<'_, E>,
) -> Result<(), E> {
    pace.begin();
    while engine.step() < last {
        let steps = pace.batch().min(last - engine.step());
        let advanced = engine.advance(steps, steps);
        if advanced.is_ok() {
            pace.submitted(steps);
        }
        if each(engine, pace, advanced)?.is_break() {
            break;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_grow_to_the_target_and_shrink_at_once() {
        let mut pace = Pace::new(1000, 1.0);
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
        assert_eq!(Pace::new(4_000_000, 2500.0).batch(), 2);
        assert_eq!(Pace::new(0, 0.0).batch(), 8);
        // A dense liquid, of which one step takes as long as many of a thin one.
        assert_eq!(Pace::new(100_000, 100_000.0).batch(), 2);
    }

    #[test]
    fn the_first_batch_says_nothing_of_those_that_follow() {
        let mut pace = Pace::new(1000, 1.0);
        pace.returned_at -= Duration::from_secs(9);
        pace.submitted(8);
        assert_eq!(pace.rate(), None);
        pace.finished();
        // Nine seconds of compiling are not those of eight steps.
        assert!(pace.done().1 > Duration::from_secs(9) && pace.rate().is_none());
        pace.returned_at -= Duration::from_secs(1);
        pace.submitted(100);
        pace.finished();
        assert!(pace.rate().is_some_and(|rate| (90.0..=100.0).contains(&rate)), "{:?}", pace.rate());
    }

    #[test]
    fn every_step_is_counted_once() {
        let mut pace = Pace::new(1000, 1.0);
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
