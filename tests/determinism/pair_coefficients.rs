//! Pairs of species with a cutoff and a weight exponent of their own: the bytes whatever changes that is not physics, and no momentum
//! lost.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes;
use crate::support::{COTTER_REICH, MIXTURE, PREDICTED, STAGED, fluid, start};

const STEPS: u64 = 24;

const PAIRS: &str = r#"interactions.0.pairs=[{"between":["A","B"],"cutoff":1.2,"friction":9,"weight_exponent":1},
    {"between":["B","B"],"cutoff":0.7}]"#;

/// Steps of both kinds, with what has memory among them.
fn scenes() -> Vec<Checked> {
    let base = ["time.steps=1000", "time.step=0.02", "output.energies.every=3", MIXTURE, PAIRS];
    let memory = r#"interactions.0.bath={"type":"memory","rate":3}"#;
    let changes = [[STAGED, "space.box=[5,5,5]"], [PREDICTED, "space.box=[12,9]"], [COTTER_REICH, memory]];
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
