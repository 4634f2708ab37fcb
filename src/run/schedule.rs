//! When a run has to stop for something.

use crate::families::{Checked, PictureKind};
use std::time::Duration;

/// The steps of checkpoints, snapshots and frames.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Schedule {
    last: u64,
    checkpoint: u64,
    checkpoint_time: Duration,
    snapshot: Option<u64>,
    frame: Option<u64>,
    /// Of states that analyses take.
    states: Vec<u64>,
}

impl Schedule {
    /// The schedule of a scene, with the steps between two states that its analyses take.
    pub(super) fn new(scene: &Checked, states: Vec<u64>) -> Self {
        let output = &scene.output;
        let pictures = match scene.model().picture() {
            PictureKind::Fields => output.fields.as_ref().map_or(0, |fields| fields.every),
            PictureKind::Particles | PictureKind::Cells => output.snapshot.every,
        };
        Self {
            last: scene.time.steps,
            checkpoint: output.checkpoint.every.max(1),
            checkpoint_time: Duration::from_mins(u64::from(output.checkpoint.minutes.max(1))),
            snapshot: (pictures > 0).then_some(pictures),
            frame: output.trajectory.as_ref().map(|trajectory| trajectory.every.max(1)),
            states,
        }
    }

    /// The first event after a step.
    pub(super) fn next(&self, step: u64) -> u64 {
        let after = |every: u64| (step / every + 1).saturating_mul(every);
        let events = [Some(self.checkpoint), self.snapshot, self.frame].into_iter().flatten();
        events.chain(self.states.iter().copied()).map(after).fold(self.last, u64::min)
    }

    /// Whether to save a checkpoint; the start and the end always are.
    pub(super) fn checkpoint(&self, step: u64) -> bool {
        step == self.last || step.is_multiple_of(self.checkpoint)
    }

    /// Whether a checkpoint is so old that another is due.
    pub(super) fn checkpoint_after(&self, time: Duration) -> bool {
        time >= self.checkpoint_time
    }

    /// The number of the snapshot to take.
    pub(super) fn snapshot(&self, step: u64) -> Option<u64> {
        self.snapshot.filter(|every| step.is_multiple_of(*every)).map(|every| step / every + 1)
    }

    /// Numbers and steps of all snapshots.
    pub(super) fn numbered(&self) -> impl Iterator<Item = (u64, u64)> {
        self.snapshot.into_iter().flat_map(|every| (0..=self.last / every).map(move |place| (place + 1, place * every)))
    }

    /// Number of snapshots taken before a step.
    pub(super) fn snapshots_before(&self, step: u64) -> u64 {
        self.snapshot.map_or(0, |every| step.div_ceil(every))
    }

    /// Whether to add a frame to the trajectory.
    pub(super) fn frame(&self, step: u64) -> bool {
        self.frame.is_some_and(|every| step.is_multiple_of(every))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCHEDULE: Schedule = Schedule {
        last: 100,
        checkpoint: 40,
        checkpoint_time: Duration::from_mins(10),
        snapshot: Some(30),
        frame: None,
        states: Vec::new(),
    };

    #[test]
    fn states_that_analyses_take_are_events() {
        let schedule = Schedule { states: vec![25, 10], ..SCHEDULE };
        assert_eq!([40, 45, 70].map(|step| schedule.next(step)), [50, 50, 75]);
    }

    #[test]
    fn events_come_in_order_and_end_with_the_run() {
        let mut step = 0;
        let mut steps = Vec::new();
        while step < SCHEDULE.last {
            step = SCHEDULE.next(step);
            steps.push(step);
        }
        assert_eq!(steps, [30, 40, 60, 80, 90, 100]);
        assert_eq!(Schedule { snapshot: None, checkpoint: u64::MAX, ..SCHEDULE }.next(99), 100);
    }

    #[test]
    fn snapshots_are_numbered_without_gaps() {
        let numbers: Vec<u64> = (0..=100).filter_map(|step| SCHEDULE.snapshot(step)).collect();
        assert_eq!(numbers, [1, 2, 3, 4]);
        assert_eq!(SCHEDULE.numbered().collect::<Vec<_>>(), [(1, 0), (2, 30), (3, 60), (4, 90)]);
        for step in 0..=100 {
            let before = (0..step).filter(|earlier| SCHEDULE.snapshot(*earlier).is_some()).count() as u64;
            assert_eq!(SCHEDULE.snapshots_before(step), before);
        }
    }

    #[test]
    fn the_ends_are_checkpoints() {
        assert!(
            SCHEDULE.checkpoint_after(Duration::from_mins(10)) && !SCHEDULE.checkpoint_after(Duration::from_secs(599))
        );
        assert!(SCHEDULE.checkpoint(0) && SCHEDULE.checkpoint(80) && SCHEDULE.checkpoint(100));
        assert!(!SCHEDULE.checkpoint(30));
    }
}
