//! Many-body dissipative particle dynamics: the same bytes whatever changes that is not physics, and no momentum lost.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes::{self, same};
use crate::support::{COTTER_REICH, MIXTURE, PREDICTED, SPLITTING, STAGED, edited, fluid, start};

const STEPS: u64 = 16;

const FORCE: &str = r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25},
    "pairs":[{"between":["A","B"],"repulsion":-30,"cutoff":0.8}]}]"#;

/// Steps of every kind, in space and in the plane.
fn scenes() -> Vec<Checked> {
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
        let plain = bytes::same_in_any_traversal_and_order(&scene, Options::default(), STEPS, &mut random);
        assert_eq!(plain.state.total_momentum(), start(&scene).1.total_momentum());
    }
}

/// Densities are found anew at every step: nothing of them is kept.
#[test]
fn a_resumed_run_goes_on_with_the_same_bytes_and_reports_change_nothing() {
    for scene in &scenes()[..2] {
        let often = edited(scene, |scene| scene.output.energies.every = 1);
        let plain = bytes::run(scene, Options::default(), STEPS, 8);
        assert!(bytes::run(&often, Options::default(), STEPS, 8).state == plain.state);
        assert!(same(&plain, &bytes::resumed(scene, Options::default(), STEPS, 7)));
    }
}
