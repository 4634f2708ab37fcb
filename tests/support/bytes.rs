//! The bytes of a run: what has to stay the same whatever changes that is not physics.

use super::edited;
use mesoscope::engine::{EngineError, Sample, Stepper};
use mesoscope::plan::{Options, Traversal};
use mesoscope::scene::Checked;
use mesoscope::state::{Reported, State};
use rand::rngs::StdRng;
use rand::seq::SliceRandom as _;

use super::{engine, start};

/// Everything a run gives: the state to continue from, that of the last report, and all samples.
#[derive(Debug, PartialEq)]
pub struct Bytes {
    pub state: State,
    pub reported: Reported,
    pub samples: Vec<Sample>,
}

/// What an engine gives at the end, after samples that were taken from it before.
pub fn harvest(mut engine: impl Stepper, mut samples: Vec<Sample>) -> Bytes {
    let state = engine.state().unwrap();
    let reported = engine.reported().unwrap();
    samples.extend(engine.finish().unwrap());
    Bytes { state, reported, samples }
}

/// The first steps of a scene, `batch` of them in one submission.
pub fn run(scene: &Checked, options: Options, steps: u64, batch: u64) -> Bytes {
    let (_, state) = start(scene);
    let mut engine = engine(scene, &state, options);
    engine.advance(steps, batch).unwrap();
    harvest(engine, Vec::new())
}

/// The bytes of a scene in batches of 8 steps, which are the same again and in other batches, with another scan, other sizes of workgroups
/// and longer lists together, and others with another seed.
#[track_caller]
pub fn same_in_every_way(scene: &Checked, steps: u64) -> Bytes {
    let plain = run(scene, Options::default(), steps, 8);
    assert_eq!(plain.state.step, steps);
    for (options, batch) in [
        (Options::default(), 8),
        (Options::default(), 1),
        (Options { workgroup_size: Some(32), serial_memory: Some(false), ..Options::default() }, steps),
        (Options { workgroup_size: Some(128), many_level_scan: true, list_growth: 1, ..Options::default() }, 8),
    ] {
        assert!(same(&plain, &run(scene, options, steps, batch)), "{options:?}, batches of {batch}");
    }
    let other = edited(scene, |scene| scene.seed += 1);
    assert!(!same(&plain, &run(&other, Options::default(), steps, 8)), "the seed changes nothing");
    plain
}

/// The bytes of particles in batches of 8 steps, which are the same in others, with other sizes of workgroups, where one particle at a time
/// finds its neighbours, and with the particles in any order of storage.
#[track_caller]
pub fn same_in_any_traversal_and_order(scene: &Checked, options: Options, steps: u64, random: &mut StdRng) -> Bytes {
    let plain = run(scene, options, steps, 8);
    for (lanes, traversal) in [(32, Traversal::Rows), (64, Traversal::Queue)] {
        let (workgroup_size, traversal) = (Some(lanes), Some(traversal));
        let changed = Options { workgroup_size, serial_memory: Some(false), traversal, ..options };
        assert!(same(&plain, &run(scene, changed, steps, 5)), "{changed:?}");
    }
    assert!(same(&plain, &shuffled(scene, options, steps, 8, random)), "storage order");
    plain
}

/// The bytes of a run that is interrupted after some steps: what it has not reported by then is reported by the one that goes on.
pub fn resumed(scene: &Checked, options: Options, steps: u64, interruption: u64) -> Bytes {
    let (_, state) = start(scene);
    let mut first = engine(scene, &state, options);
    first.advance(interruption, 8).unwrap();
    let kept = first.state().unwrap();
    let mut samples = first.finish().unwrap();
    samples.retain(|sample| sample.step < interruption);
    let mut second = engine(scene, &kept, options);
    second.advance(steps - interruption, 8).unwrap();
    harvest(second, samples)
}

/// The same with the particles in another order of storage at the start.
#[track_caller]
pub fn shuffled(scene: &Checked, options: Options, steps: u64, batch: u64, random: &mut StdRng) -> Bytes {
    let (_, state) = start(scene);
    let mut order: Vec<usize> = (0..state.len()).collect();
    order.shuffle(random);
    assert!(!order.is_sorted());
    let mut engine = engine(scene, &state, options);
    engine.upload_in_order(&state, &order).unwrap();
    engine.advance(steps, batch).unwrap();
    harvest(engine, Vec::new())
}

/// The same asked for piece by piece, with a look at the state in between.
#[track_caller]
pub fn in_pieces(scene: &Checked, options: Options, pieces: &[u64], batch: u64) -> Bytes {
    let (_, state) = start(scene);
    let mut engine = engine(scene, &state, options);
    let mut samples = Vec::new();
    for piece in pieces {
        engine.advance(*piece, batch).unwrap();
        samples.extend(engine.take_samples());
        assert_eq!(engine.state().unwrap().step, engine.step());
    }
    harvest(engine, samples)
}

/// The same with every step reported before it is finished.
#[track_caller]
pub fn watched(scene: &Checked, options: Options, steps: u64) -> Bytes {
    let (_, state) = start(scene);
    let mut engine = engine(scene, &state, options);
    let mut samples = Vec::new();
    for _ in 0..steps {
        engine.reported().unwrap();
        assert!(matches!(engine.state(), Err(EngineError::State { .. })));
        samples.extend(engine.finish().unwrap());
        engine.advance(1, 1).unwrap();
    }
    harvest(engine, samples)
}

/// Whether two runs agree; where they do not is printed, but not all of it.
pub fn same(a: &Bytes, b: &Bytes) -> bool {
    let first = |sample: &Sample| (sample.sampler, sample.step, sample.sums.len(), sample.sums.first().copied());
    for (one, other) in a.samples.iter().zip(&b.samples).filter(|(one, other)| one != other).take(3) {
        println!("sampler, step, number of sums and the first: {:?}, {:?}", first(one), first(other));
    }
    println!("states agree: {}, reports: {}", a.state == b.state, a.reported == b.reported);
    a == b
}
