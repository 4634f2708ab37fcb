//! When a run has to stop for something.

use super::cells::Due;
use crate::scene::{Interaction, Scene};
use std::time::Duration;

/// The steps of checkpoints, snapshots and frames.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Schedule {
    last: u64,
    checkpoint: u64,
    checkpoint_time: Duration,
    snapshot: Option<u64>,
    frame: Option<u64>,
    chain: Option<u64>,
    neighbours: Option<u64>,
    shear_wave: Option<u64>,
    equilibration: u64,
}

impl Schedule {
    pub(super) fn new(scene: &Scene) -> Self {
        let output = &scene.output;
        let water = scene.interactions.iter().any(|interaction| matches!(interaction, Interaction::ShallowWater(_)));
        // Shallow water shows fields, all others particles.
        let pictures =
            if water { output.fields.as_ref().map_or(0, |fields| fields.every) } else { output.snapshot.every };
        Self {
            last: scene.time.steps,
            checkpoint: output.checkpoint.every.max(1),
            checkpoint_time: Duration::from_mins(u64::from(output.checkpoint.minutes.max(1))),
            snapshot: (pictures > 0).then_some(pictures),
            frame: output.trajectory.as_ref().map(|trajectory| trajectory.every.max(1)),
            chain: output.chain.as_ref().map(|chain| chain.every.max(1)),
            neighbours: output.neighbours.as_ref().map(|neighbours| neighbours.every.max(1)),
            shear_wave: output.shear_wave.as_ref().map(|wave| wave.every.max(1)),
            equilibration: scene.time.equilibration,
        }
    }

    /// The first event after a step.
    pub(super) fn next(&self, step: u64) -> u64 {
        let after = |every: u64| (step / every + 1).saturating_mul(every);
        let events = [Some(self.checkpoint), self.snapshot, self.frame, self.chain, self.neighbours, self.shear_wave];
        events.into_iter().flatten().map(after).fold(self.last, u64::min)
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

    /// Number of snapshots taken before a step.
    pub(super) fn snapshots_before(&self, step: u64) -> u64 {
        self.snapshot.map_or(0, |every| step.div_ceil(every))
    }

    /// Whether to take a sample of harmonic chains.
    pub(super) fn chain(&self, step: u64) -> bool {
        self.chain.is_some_and(|every| step.is_multiple_of(every))
    }

    /// What to gather of Voronoi cells.
    pub(super) fn cells(&self, step: u64) -> Due {
        let due =
            |every: Option<u64>| step >= self.equilibration && every.is_some_and(|every| step.is_multiple_of(every));
        Due { neighbours: due(self.neighbours), shear_wave: due(self.shear_wave) }
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
        chain: None,
        neighbours: None,
        shear_wave: None,
        equilibration: 0,
    };

    #[test]
    fn cells_are_sampled_after_equilibration() {
        let schedule = Schedule { neighbours: Some(25), shear_wave: Some(10), equilibration: 40, ..SCHEDULE };
        let due: Vec<u64> = (0..=100).filter(|step| schedule.cells(*step).neighbours).collect();
        assert_eq!(due, [50, 75, 100]);
        assert!(schedule.cells(40).shear_wave && !schedule.cells(40).neighbours && !schedule.cells(30).any());
        assert_eq!(schedule.next(40), 50);
        assert_eq!(schedule.next(70), 75);
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
