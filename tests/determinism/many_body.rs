//! Many-body dissipative particle dynamics: the same bytes whatever changes that is not physics, and no momentum lost.

use mesoscope::plan::{Options, Traversal};
use mesoscope::scene::Scene;
use rand::SeedableRng as _;

use crate::support::bytes::{self, harvest, same};
use crate::support::{COTTER_REICH, MIXTURE, PREDICTED, SPLITTING, STAGED, engine, fluid, start};

const STEPS: u64 = 16;

const FORCE: &str = r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25},
    "pairs":[{"between":["A","B"],"repulsion":-30,"cutoff":0.8}]}]"#;

/// Steps of every kind, in space and in the plane.
fn scenes() -> Vec<Scene> {
    let base = ["time.steps=1000", "time.step=0.01", "output.energies.every=3", MIXTURE, FORCE];
    let changes = [
        [SPLITTING, "space.box=[5,5,5]"],
        [STAGED, "space.box=[12,9]"],
        [PREDICTED, "space.box=[5,5,5]"],
        [COTTER_REICH, "space.box=[12,9]"],
    ];
    changes.iter().map(|changes| fluid(&[&base[..], changes].concat())).collect()
}

#[test]
fn reruns_batches_orders_and_workgroup_sizes_give_the_same_bytes_and_keep_momentum() {
    let mut random = rand::rngs::StdRng::seed_from_u64(3);
    for scene in scenes() {
        let options = Options::default();
        let plain = bytes::run(&scene, options, STEPS, 8);
        assert_eq!(plain.state.total_momentum(), start(&scene).1.total_momentum());
        for changed in [
            Options { workgroup_size: Some(32), serial_memory: Some(false), ..options },
            Options { traversal: Some(Traversal::Rows), ..options },
        ] {
            assert!(same(&plain, &bytes::run(&scene, changed, STEPS, 5)), "{changed:?}");
        }
        assert!(same(&plain, &bytes::shuffled(&scene, options, STEPS, 8, &mut random)), "storage order");
    }
}

/// Densities are found anew at every step: nothing of them is kept.
#[test]
fn a_resumed_run_goes_on_with_the_same_bytes_and_reports_change_nothing() {
    for scene in &scenes()[..2] {
        let mut often = scene.clone();
        often.output.energies.every = 1;
        let plain = bytes::run(scene, Options::default(), STEPS, 8);
        assert!(bytes::run(&often, Options::default(), STEPS, 8).state == plain.state);
        let (_, state) = start(scene);
        let mut first = engine(scene, &state, Options::default());
        first.advance(7, 8).unwrap();
        let kept = first.state().unwrap();
        let mut samples = first.finish().unwrap();
        samples.retain(|sample| sample.step < 7);
        let mut second = engine(scene, &kept, Options::default());
        second.advance(STEPS - 7, 8).unwrap();
        assert!(same(&plain, &harvest(second, samples)));
    }
}
