//! Walls and the account of what they absorb: the same bytes whatever changes that is not physics.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes::{self, same};
use crate::support::{INTEGRATORS, MIXTURE, fluid};

const STEPS: u64 = 24;

const WALLS: [&str; 2] = [
    r#"space={"box":[5,4,5],"walls":{"z":{"lower_velocity":[-1,0,0],"upper_velocity":[1,0.5,0]}}}"#,
    r#"space={"box":[5,4,5],"walls":{"x":{"upper_velocity":[0,0,1]},"y":{"reflection":"specular"}}}"#,
];
const DRIVEN: &str =
    r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","force":[3,0.3,0.2]}]"#;

/// The mixture, and frozen particles behind the walls of each of those above.
const LAYERED: [&str; 2] = [
    r#"particles=[{"species":"A","number_density":2},{"species":"B","number_density":1,"mass":2.5},
        {"species":"C","number_density":3,"placement":{"type":"behind-walls","axis":"z","thickness":0.9}}]"#,
    r#"particles=[{"species":"A","number_density":2},{"species":"B","number_density":1,"mass":2.5},
        {"species":"C","number_density":3,"placement":{"type":"behind-walls","axis":"x","wall":"upper","thickness":1}}]"#,
];

fn scenes() -> Vec<Checked> {
    let base = ["time.steps=1000", "time.step=0.02", "output.energies.every=3", DRIVEN];
    // Either kind of walls with layers and without.
    let scene = |(number, integrator): (usize, &&str)| {
        let particles = [MIXTURE, LAYERED[number % 2]][number / 2 % 2];
        fluid(&[&base[..], &[particles, integrator, WALLS[number % 2]]].concat())
    };
    INTEGRATORS.iter().enumerate().map(scene).collect()
}

#[test]
fn reruns_batches_orders_and_workgroup_sizes_give_the_same_bytes() {
    let mut random = rand::rngs::StdRng::seed_from_u64(3);
    for scene in scenes() {
        let plain = bytes::same_in_any_traversal_and_order(&scene, Options::default(), STEPS, &mut random);
        assert!(plain.state.walls.iter().all(|wall| wall.momentum() != [0; 3]), "{:?}", plain.state.walls);
    }
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bytes() {
    for scene in scenes() {
        let plain = bytes::run(&scene, Options::default(), STEPS, 8);
        for interruption in [1, STEPS - 5] {
            assert!(
                same(&plain, &bytes::resumed(&scene, Options::default(), STEPS, interruption)),
                "interrupted at {interruption}"
            );
        }
    }
}

/// Reports fall between the halves of a drift, in which walls may reflect too: they change nothing.
#[test]
fn reports_change_nothing() {
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let particles = [LAYERED[number % 2], MIXTURE][number / 2 % 2];
        let with_reports = |every: &str| {
            let changes =
                ["time.steps=1000", "time.step=0.02", every, particles, DRIVEN, integrator, WALLS[number % 2]];
            bytes::run(&fluid(&changes), Options::default(), STEPS, 8).state
        };
        let [often, seldom] = ["output.energies.every=1", "output.energies.every=1000"].map(with_reports);
        assert!(often == seldom, "{integrator} {particles}");
    }
}
