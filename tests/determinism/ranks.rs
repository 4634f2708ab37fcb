//! Several ranks: the same bytes as one.

use mesoscope::engine::Stepper as _;
use mesoscope::plan::{Division, Options};
use mesoscope::ranks::Team;
use mesoscope::run;
use mesoscope::scene::Scene;
use mesoscope::state::State;

use crate::support::bytes::{self, Bytes, harvest, same};
use crate::support::{
    COTTER_REICH, GROOT_WARREN, MIXTURE, MIXTURE_FORCE, PREDICTED, SPLITTING, STAGED, adapter, fluid, gpu, start,
};

const STEPS: u64 = 30;
const EVERY_THIRD: &str = "output.energies.every=3";
const GAUSSIAN: &str = "noise.distribution=gaussian";

/// Scenes of every integrator, in three dimensions and two, alone and mixed, with what each can be divided into.
fn cases() -> Vec<(Vec<&'static str>, Vec<[u32; 3]>)> {
    vec![
        (vec![SPLITTING, "space.box=[4,4,13]"], vec![[1, 1, 2], [1, 1, 3], [1, 1, 4]]),
        (vec![SPLITTING, "space.box=[8.5,9,8.5]", MIXTURE, MIXTURE_FORCE], vec![[2, 2, 2]]),
        (vec![SPLITTING, "space.box=[9,3]", GAUSSIAN], vec![[2, 1, 1]]),
        (vec![STAGED, "space.box=[4,4,15]"], vec![[1, 1, 3]]),
        (vec![GROOT_WARREN, "space.box=[5,5,9]"], vec![[2, 2, 2], [1, 1, 3], [1, 2, 4]]),
        (vec![PREDICTED, "space.box=[12,16]", MIXTURE, MIXTURE_FORCE], vec![[1, 4, 1], [4, 2, 1]]),
        (vec![COTTER_REICH, "space.box=[4,7,9]", MIXTURE, MIXTURE_FORCE, GAUSSIAN], vec![[1, 2, 2], [1, 3, 1]]),
    ]
}

fn scene(changes: &[&str]) -> Scene {
    fluid(&[&["time.steps=1000", EVERY_THIRD], changes].concat())
}

fn team(scene: &Scene, division: Division, options: Options, state: &State) -> Team<'static> {
    let (model, _) = start(scene);
    run::team((scene, &model), gpu(), &adapter(), division, options, state).expect("ranks")
}

fn divided(scene: &Scene, parts: [u32; 3], batch: u64) -> Bytes {
    let (_, state) = start(scene);
    let mut team = team(scene, Division { parts }, Options::default(), &state);
    team.advance(STEPS, batch).unwrap();
    assert!(team.traffic().iter().all(|traffic| traffic.exchanges >= STEPS && traffic.copies > 0));
    harvest(team, Vec::new())
}

#[test]
fn any_number_of_ranks_gives_the_bytes_of_one() {
    for (changes, divisions) in cases() {
        let scene = scene(&changes);
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        for (number, parts) in divisions.into_iter().enumerate() {
            let batch = [8, 1, STEPS][number % 3];
            assert!(same(&alone, &divided(&scene, parts, batch)), "{changes:?} in {parts:?}");
        }
    }
}
