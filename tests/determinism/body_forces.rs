//! Body forces and the account of what they give: the same bytes whatever changes that is not physics.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes::{self, same};
use crate::support::{INTEGRATORS, MIXTURE, fluid};

const STEPS: u64 = 24;

const FORCES: [&str; 2] = [
    r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","profile":"opposed","axis":"y","force":[1,0.3,0.2],"species":["A"]}]"#,
    r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","profile":"sinusoidal","axis":"x","waves":2,"force":[0.1,1,0]}]"#,
];

fn scenes() -> Vec<(Checked, Options)> {
    let base = ["time.steps=1000", "time.step=0.02", "output.energies.every=3", MIXTURE];
    let listed = Options { listed: true, ..Options::default() };
    let mut scenes = Vec::new();
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        scenes.push((fluid(&[&base[..], &[integrator, FORCES[number % 2]]].concat()), Options::default()));
    }
    scenes.push((fluid(&[&base[..], &[INTEGRATORS[3], FORCES[1]]].concat()), listed));
    scenes
}

#[test]
fn reruns_batches_orders_and_workgroup_sizes_give_the_same_bytes() {
    let mut random = rand::rngs::StdRng::seed_from_u64(3);
    for (scene, options) in scenes() {
        let plain = bytes::same_in_any_traversal_and_order(&scene, options, STEPS, &mut random);
        assert_ne!(plain.state.account[0].momentum(), [0; 3]);
    }
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bytes() {
    for (scene, options) in scenes() {
        let plain = bytes::run(&scene, options, STEPS, 8);
        for interruption in [0, 1, STEPS - 5] {
            assert!(
                same(&plain, &bytes::resumed(&scene, options, STEPS, interruption)),
                "interrupted at {interruption}"
            );
        }
    }
}
