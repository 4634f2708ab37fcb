//! Boundaries that shear: the same bytes whatever changes that is not physics.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes::{self, same};
use crate::support::{GROOT_WARREN, MIXTURE, PREDICTED, SPLITTING, STAGED, fluid};

const STEPS: u64 = 24;
const SHEARED: [&str; 4] = [SPLITTING, GROOT_WARREN, PREDICTED, STAGED];
const SPACES: [&str; 2] = [
    r#"space={"box":[5,4,5],"shear":{"rate":1.2,"gradient":"z"}}"#,
    r#"space={"box":[7,4,3],"shear":{"rate":-0.8,"gradient":"y"}}"#,
];

fn scene(number: usize, every: &str) -> Checked {
    let base = ["time.steps=1000", "time.step=0.02", every, SHEARED[number], SPACES[number % 2]];
    fluid(&[&base[..], if number < 2 { &[] } else { &[MIXTURE] }].concat())
}

fn scenes() -> Vec<Checked> {
    (0..SHEARED.len()).map(|number| scene(number, "output.energies.every=3")).collect()
}

/// Also whether eight particles or one find their neighbours.
#[test]
fn reruns_batches_orders_and_workgroup_sizes_give_the_same_bytes() {
    let mut random = rand::rngs::StdRng::seed_from_u64(3);
    for scene in scenes().into_iter().step_by(2) {
        let plain = bytes::same_in_any_traversal_and_order(&scene, Options::default(), STEPS, &mut random);
        assert_ne!(plain.state.walls[0].momentum(), [0; 3]);
    }
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bytes() {
    const INTERRUPTION: u64 = 5;
    for scene in scenes().into_iter().skip(1).step_by(2) {
        let plain = bytes::run(&scene, Options::default(), STEPS, 8);
        assert!(same(&plain, &bytes::resumed(&scene, Options::default(), STEPS, INTERRUPTION)));
    }
}

/// Reports fall between the halves of a drift, in which boundaries may be crossed too: they change nothing.
#[test]
fn reports_change_nothing() {
    for number in [0, 2, 3] {
        let [often, seldom] = [1, 1000].map(|every| {
            bytes::run(&scene(number, &format!("output.energies.every={every}")), Options::default(), STEPS, 8).state
        });
        assert!(often == seldom, "{}", SHEARED[number]);
    }
}
