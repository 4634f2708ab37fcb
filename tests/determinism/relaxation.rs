//! Split steps with baths without memory on particles: the same bytes whatever changes that is not physics.

use mesoscope::output::{Id, checkpoint};
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes::{self, harvest, same};
use crate::support::{MIXTURE, SPLITTING, engine, fluid, start};

const STEPS: u64 = 24;

fn scenes() -> Vec<Checked> {
    let langevin = r#"{"type":"langevin","friction":2,"species":[{"name":"A","friction":30}]}"#;
    let force = r#""every":4,"window":2"#;
    let forces =
        format!(r#"output.autocorrelations=[{{"quantity":"force",{force}}},{{"quantity":"velocity",{force}}}]"#);
    let scene = |interactions: &str, changes: &[&str]| {
        let interactions = format!("interactions=[{langevin}{interactions}]");
        let base = [SPLITTING, "time.steps=1000", "time.step=0.02", "output.energies.every=3"];
        fluid(&[&base[..], &[&interactions, &forces], changes].concat())
    };
    let chains = r#"particles=[{"species":"A","count":200,"chain":{"beads":4}},{"species":"B","count":50,"mass":2.5}]"#;
    vec![
        scene(r#",{"type":"dpd","repulsion":25}"#, &[MIXTURE, "space.box=[9,7]", "output.autocorrelations=[]"]),
        scene(
            r#",{"type":"dpd","repulsion":25,"friction":4.5},{"type":"tether","stiffness":5},
            {"type":"bonds","potential":{"type":"harmonic","stiffness":9},"friction":7}"#,
            &[chains],
        ),
    ]
}

#[test]
fn reruns_batches_scans_and_storage_give_the_same_bytes() {
    for scene in scenes() {
        let plain = bytes::same_in_every_way(&scene, STEPS);
        let mut random = rand::rngs::StdRng::seed_from_u64(3);
        assert!(same(&plain, &bytes::shuffled(&scene, Options::default(), STEPS, 8, &mut random)));
    }
}

#[test]
fn friction_along_bonds_keeps_the_total_momentum_to_the_last_bit() {
    for friction in [3.0, 1e9] {
        let interactions = format!(
            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{{"type":"bonds","friction":{friction}}}]"#
        );
        let chains = r#"particles=[{"species":"A","count":200,"chain":{"beads":5,"closed":true},"mass":3},
            {"species":"B","count":90}]"#;
        let scene = fluid(&[SPLITTING, "time.step=0.02", &interactions, chains]);
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(200, 50).unwrap();
        assert_eq!(engine.state().unwrap().total_momentum(), state.total_momentum());
    }
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bytes() {
    let directory = tempfile::tempdir().unwrap();
    for (number, scene) in scenes().into_iter().enumerate() {
        let plain = bytes::run(&scene, Options::default(), STEPS, 8);
        for interruption in [0, 1, STEPS - 1] {
            let (_, state) = start(&scene);
            let mut first = engine(&scene, &state, Options::default());
            first.advance(interruption, 8).unwrap();
            let kept = first.state().unwrap();
            let path = directory.path().join(format!("{number}-{interruption}"));
            checkpoint::save(&path, Id::of_run(&scene), &scene, &kept, &[], &[]).unwrap();
            let kept = checkpoint::load(&path).unwrap().state;
            let mut second = engine(&scene, &kept, Options::default());
            second.advance(STEPS - interruption, 8).unwrap();
            let resumed = harvest(second, Vec::new());
            assert!(plain.state == resumed.state, "the state, interrupted at {interruption}");
            assert!(plain.reported == resumed.reported, "what is reported, interrupted at {interruption}");
        }
    }
}
