//! Shallow water on several ranks: the same bytes as one.

use mesoscope::engine::{EngineError, Stepper};
use mesoscope::families::Instability;
use mesoscope::plan::{Division, Failure, FailureKind, Options, Rows, Storage};
use mesoscope::ranks::Team;
use mesoscope::run::{self, Ranks};
use mesoscope::scene::Checked;
use mesoscope::shaders::Array;
use mesoscope::state::State;

use super::ranks::team;
use crate::support::bytes::{self, Bytes, harvest, same};
use crate::support::{ROTATE, WHITE, engine, in_eights, start, water};

const STEPS: u64 = 40;
const WARM: &str = "temperature=4e-3";
const MEMORY: &str = r#"interactions.0.bath={"type":"memory","epsilon":1}"#;
const EXPONENTIAL: &str = r#"interactions.0.bath={"type":"memory","epsilon":0.5,"scheme":"exponential"}"#;
const LINEAR: &str = "interactions.0.spline_order=1";
const QUADRATIC: &str = "interactions.0.spline_order=2";
const CHEBYSHEV: &str = r#"interactions.0.smoothing={"length":0.8,"power":2,"solver":{"type":"chebyshev"}}"#;
const SPECTRAL: &str = r#"interactions.0.smoothing={"length":0.5,"solver":{"type":"fft","symbol":"spectral"}}"#;
const ROUGH: &str = "interactions.0.smoothing.length=0";
const OBLONG: [&str; 2] = ["space.box=[12,7]", "interactions.0.mesh=[21,13]"];
const STRIPS: &str = "interactions.0.mesh=[32,16]";
const THREEFRY: &str = r#"noise={"generator":"threefry2x32-20"}"#;
const FOLLOWED: &str = r#"output.trajectory={"every":10}"#;
const TRACERS: &str = r#"particles=[
    {"species":"water","count":2048,"placement":{"type":"random"},"velocities":{"type":"geostrophic"}},
    {"species":"water","count":1024,"placement":{"type":"lattice"},"velocities":{"type":"geostrophic"}},
    {"species":"dye","count":7,"tracer":true},
    {"species":"loop","count":96,"tracer":true,"placement":{"type":"circle","center":[0.5,3],"radius":1},
     "velocities":{"type":"geostrophic"}}]"#;
const THERMAL: &str =
    r#"particles=[{"species":"water","count":3000,"placement":{"type":"random"},"velocities":{"type":"thermal"}}]"#;
/// Rows that gyrate across slabs.
const FAST: [&str; 3] = [THERMAL, "temperature=0.08", "interactions.0.rotation=0"];

/// Scenes of every spline, solver, bath, integrator and kind of particle, with numbers of slabs.
fn cases() -> Vec<(Vec<&'static str>, Vec<u32>)> {
    vec![
        (vec![], vec![1, 2, 3]),
        (vec![ROTATE, QUADRATIC, WHITE, WARM], vec![2, 3]),
        (vec![LINEAR, MEMORY, WARM, TRACERS, THREEFRY], vec![4]),
        ([&[CHEBYSHEV, QUADRATIC, EXPONENTIAL, WARM, TRACERS], &OBLONG[..]].concat(), vec![2, 13]),
        (vec![ROTATE, SPECTRAL, MEMORY, WARM, STRIPS], vec![3, 4]),
        (vec![LINEAR, ROUGH, STRIPS], vec![4]),
        ([&[FOLLOWED], &FAST[..]].concat(), vec![2, 4]),
        (vec![QUADRATIC, FOLLOWED, WHITE, WARM, TRACERS], vec![3]),
    ]
}

fn scene(changes: &[&str]) -> Checked {
    water(&[&["time.steps=1000", "output.energies.every=3"], changes].concat())
}

fn slabs(count: u32) -> Division {
    Division { parts: [1, count, 1] }
}

/// The slab of each particle with mass.
fn owners(scene: &Checked, state: &State, count: u32) -> Vec<u32> {
    let (model, _) = start(scene);
    let water = model.shallow_water().unwrap();
    let rows = Rows { count: water.mesh[1], centred: water.spline_order == 2 };
    let owner =
        |position: &[u32; 3]| (0..count).find(|&rank| slabs(count).domain_of_rows(rank, rows).contains(*position));
    state.positions.iter().take(water.carriers as usize).map(|position| owner(position).unwrap()).collect()
}

fn divided(scene: &Checked, count: u32, options: Options, batch: u64) -> Bytes {
    let (_, state) = start(scene);
    let mut team = team(scene, slabs(count), options, &state);
    team.advance(STEPS, batch).unwrap();
    assert!(team.traffic().iter().all(|traffic| traffic.exchanges == STEPS && traffic.copies == 0));
    let found = harvest(team, Vec::new());
    if count > 1 {
        let [before, after] = [&state, &found.state].map(|state| owners(scene, state, count));
        let moved = before.iter().zip(&after).filter(|(before, after)| before != after).count();
        assert!(moved > 20, "{moved} particles have changed their rank");
    }
    found
}

#[test]
fn any_number_of_ranks_gives_the_bytes_of_one() {
    for (changes, counts) in cases() {
        let scene = scene(&changes);
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        let crossed = alone.state.images.iter().flatten().filter(|image| **image != 0).count();
        assert_eq!(changes.contains(&FOLLOWED), crossed > 9, "{crossed} crossings");
        for (number, count) in counts.into_iter().enumerate() {
            let batch = [7, 1, STEPS][number % 3];
            let options = if number % 2 == 0 { in_eights() } else { Options::default() };
            let options = Options { particles_at_once: (number != 1).then_some(700), ..options };
            assert!(same(&alone, &divided(&scene, count, options, batch)), "{changes:?} on {count} ranks");
        }
    }
}

/// What was saved by one number of ranks goes on with another: one, three, two.
#[test]
fn ranks_continue_from_each_others_states() {
    for changes in [&[MEMORY, WARM][..], &[LINEAR, ROTATE, TRACERS], &[&[FOLLOWED], &FAST[..]].concat()] {
        let scene = scene(changes);
        let expected = bytes::run(&scene, Options::default(), STEPS, 8);
        let (_, mut state) = start(&scene);
        let mut samples = Vec::new();
        for (ranks, steps) in [(1, 11), (3, 14)] {
            let mut before: Box<dyn Stepper> = match ranks {
                1 => Box::new(engine(&scene, &state, Options::default())),
                ranks => Box::new(team(&scene, slabs(ranks), Options::default(), &state)),
            };
            before.advance(steps, 4).unwrap();
            state = before.state().unwrap();
            let step = state.step;
            samples.extend(before.finish().unwrap().into_iter().filter(|sample| sample.step < step));
        }
        let mut after = team(&scene, slabs(2), Options::default(), &state);
        after.advance(STEPS - state.step, 8).unwrap();
        assert!(same(&expected, &harvest(after, samples)), "{changes:?}");
    }
}

/// Every report between two steps, and what pictures of fields show.
#[test]
fn watched_ranks_have_the_surface_of_one() {
    let scene = scene(&[MEMORY, WARM, QUADRATIC]);
    let (model, state) = start(&scene);
    let nodes = model.shallow_water().unwrap().nodes() as usize;
    let mut alone = engine(&scene, &state, Options { storage: Some(Storage::Sorted), ..Options::default() });
    let mut team = team(&scene, slabs(3), Options::default(), &state);
    for _ in 0..5 {
        assert_eq!(alone.reported().unwrap(), team.reported().unwrap());
        for array in [Array::Depths, Array::NodeMasses, Array::NodeBath] {
            let [one, all] = [alone.words(array), team.words(array)].map(|words| words.unwrap()[..nodes].to_vec());
            assert!(one == all, "{}", array.name());
        }
        assert!(team.words(Array::Particles).is_err());
        assert_eq!(alone.finish().unwrap(), team.finish().unwrap());
        alone.advance(1, 1).unwrap();
        team.advance(1, 1).unwrap();
    }
}

/// How a run fails, and what is told of it.
fn failure(scene: &Checked, mut stepper: impl Stepper) -> (Failure, String) {
    match stepper.advance(100, 8).and_then(|()| stepper.finish()) {
        Err(EngineError::Unstable(failure)) => {
            let told = Instability::new(&failure, stepper.plan(), scene.model()).to_string();
            (failure, told)
        }
        other => panic!("{other:?}"),
    }
}

/// A run that fails does so at the same step and place with the same words, however many ranks it has.
#[test]
fn failures_are_those_of_one_rank() {
    // Around a node between two slabs, on each of which alone the mass would do.
    let crowd = r#"particles=[{"species":"water","count":4096,"placement":
        {"type":"circle","center":[3.141592653589793,3.141592653589793],"radius":0.004}}]"#;
    let lone = r#"particles=[{"species":"water","placement":{"type":"listed","positions":[[1.0,3.2]]}}]"#;
    let overshoot = r#"interactions.0.smoothing={"length":0.2,"solver":{"type":"fft","symbol":"spectral"}}"#;
    for (changes, kind) in [
        (&["time.step=0.3"][..], FailureKind::Momentum),
        (&[LINEAR, overshoot, lone, "interactions.0.surface=[]"], FailureKind::Depth),
        (&[LINEAR, crowd, "interactions.0.surface=[]"], FailureKind::Crowding),
    ] {
        let scene = scene(changes);
        let (_, state) = start(&scene);
        let roomy = |options: Options, _| options.with_room(state.len() as u64);
        let options = (0..4).fold(Options::default(), roomy);
        let (expected, told) = failure(&scene, engine(&scene, &state, options));
        assert!(expected.is(kind), "{told}");
        for ranks in [2, 4] {
            let (found, words) = failure(&scene, team(&scene, slabs(ranks), options, &state));
            assert_eq!((found.step, found.place, &words), (expected.step, expected.place, &told), "{ranks} ranks");
        }
    }
}

/// Water that is nearly all in one slab asks for more room, with which it goes on.
#[test]
fn crowded_slabs_get_more_room() {
    let scene = scene(&[r#"particles=[
        {"species":"water","count":512,"placement":{"type":"lattice"},"velocities":{"type":"thermal"}},
        {"species":"water","count":12000,"placement":{"type":"circle","center":[3,1],"radius":0.7}}]"#]);
    let (_, state) = start(&scene);
    let ended =
        run::team(&scene, crate::support::gpu(), &crate::support::adapter(), slabs(3), Options::default(), &state);
    let Err(error) = ended.map(|_: Team<'_>| ()) else { panic!("it fits") };
    assert!(error.to_string().contains("capacity"), "{error}");
    let sorted = Options { storage: Some(Storage::Sorted), ..Options::default() };
    let alone = bytes::run(&scene, sorted, 5, 8);
    let mut roomy = team(&scene, slabs(3), Options::default().with_room(state.len() as u64), &state);
    roomy.advance(5, 8).unwrap();
    assert!(same(&alone, &harvest(roomy, Vec::new())));
}

#[test]
fn what_hinders_is_told() {
    let scene = scene(&[]);
    let divide = |asked| run::divide(&scene, asked);
    assert_eq!(divide(Ranks::Count(5)).unwrap(), slabs(5));
    assert_eq!(divide(Ranks::Count(16)).unwrap(), slabs(16));
    for (asked, expected) in [
        (Ranks::Count(17), &["17 parts along y", "16 rows of cells"][..]),
        (Ranks::Parts([2, 17, 1]), &["2 parts along x", "17 parts along y"]),
    ] {
        let told = divide(asked).unwrap_err().to_string();
        assert!(expected.iter().all(|words| told.contains(words)), "{told}");
    }
}
