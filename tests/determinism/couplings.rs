//! Couplings that add their impulses up: the same bytes whatever changes that is not physics, and the exact laws.

use mesoscope::engine::EngineError;
use mesoscope::families::particles::CoupledLayout;
use mesoscope::output::{Id, checkpoint};
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use rand::SeedableRng as _;

use crate::support::bytes::{self, Bytes, harvest, same};
use crate::support::{INTEGRATORS, MIXTURE, engine, fluid, start};

const STEPS: u64 = 40;
const MEMORY: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":5}}]"#;
const MIXTURE_MEMORY: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,
    "pairs":[{"between":["A","B"],"repulsion":40,"friction":0}],
    "bath":{"type":"memory","rate":150,"scheme":"symmetric"}}]"#;
const EVERYTHING: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"tether","stiffness":3},
    {"type":"langevin","friction":2,"bath":{"type":"memory","rate":5,"scheme":"exponential"}}]"#;
const IONS: &str = r#"particles=[{"species":"A","count":120,"charge":-1},{"species":"B","count":48,"charge":2.5}]"#;
const CHARGED: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
    {"type":"electrostatics","bjerrum_length":1.1},{"type":"electric-field","field":[1,0,0],"frequency":0.4}]"#;
const CHARGED_WAVES: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
    {"type":"electrostatics","bjerrum_length":1.1,"method":"waves"}]"#;
/// Which sampler measures diffusion.
const DIFFUSION: usize = 2;
const COUPLED: &str = r#"integrator.type="cotter-reich""#;

fn sampled(changes: &[&str]) -> Checked {
    let samplers = [
        r#"output.radial_distribution={"every":4,"range":2.0,"bins":40}"#,
        r#"output.diffusion={"every":2,"window":8}"#,
        r#"output.histograms=[{"quantity":"velocity","every":5}]"#,
    ];
    let base = ["time.steps=1000", "time.step=0.02", "output.energies.every=3", COUPLED];
    fluid(&[&base[..], &samplers, changes].concat())
}

/// A list that holds for some steps; without it a step of these scenes outruns any, and each makes a list.
const MARGIN: &str = "interactions.0.skin=0.3";

/// Scenes that between them have every kind of memory, and charges in a field, whose phase goes on.
fn scenes() -> Vec<Checked> {
    vec![
        sampled(&[MEMORY]),
        sampled(&[MEMORY, MARGIN]),
        sampled(&[MIXTURE, MIXTURE_MEMORY, "space.box=[9,7]"]),
        sampled(&[MIXTURE, EVERYTHING, r#"noise={"generator":"threefry2x32-20"}"#]),
        sampled(&[IONS, CHARGED]),
        sampled(&[IONS, CHARGED_WAVES]),
    ]
}

fn run(scene: &Checked, options: Options, batch: u64) -> Bytes {
    bytes::run(scene, options, STEPS, batch)
}

#[test]
fn reruns_batches_scans_and_workgroup_sizes_give_the_same_bytes() {
    for scene in scenes() {
        let plain = bytes::same_in_every_way(&scene, STEPS);
        // Energies at 0, 3, …, 39 and g(r), diffusion, velocities at their own steps, the last included.
        let of = |sampler: usize| plain.samples.iter().filter(|sample| sample.sampler == sampler).count();
        assert_eq!([of(0), of(1), of(2), of(3)], [14, 11, 21, 9]);
    }
}

#[test]
fn the_order_of_storage_does_not_matter() {
    for scene in scenes() {
        let plain = run(&scene, Options::default(), 8);
        let mut random = rand::rngs::StdRng::seed_from_u64(3);
        assert!(same(&plain, &bytes::shuffled(&scene, Options::default(), STEPS, 8, &mut random)));
    }
}

/// A state carries lists, baths and all: interrupted at any step, even between two lists, and saved on the way.
#[test]
fn a_resumed_run_goes_on_with_the_same_bytes() {
    let directory = tempfile::tempdir().unwrap();
    for (number, scene) in scenes().into_iter().enumerate() {
        let plain = run(&scene, Options::default(), 8);
        for interruption in [0, 1, 7, STEPS - 1] {
            let (_, state) = start(&scene);
            let mut first = engine(&scene, &state, Options::default());
            first.advance(interruption, 8).unwrap();
            let kept = first.state().unwrap();
            // What the interrupted run has not reported is reported by the one that goes on.
            let mut samples = first.finish().unwrap();
            samples.retain(|sample| sample.step < interruption);
            let path = directory.path().join(format!("{number}-{interruption}"));
            checkpoint::save(&path, Id::of_run(&scene), &scene, &kept, &[], &[]).unwrap();
            let kept = checkpoint::load(&path).unwrap().state;
            let mut second = engine(&scene, &kept, Options::default());
            second.advance(STEPS - interruption, 8).unwrap();
            let resumed = harvest(second, samples);
            // A window of the diffusion that was open begins anew.
            let [plain, resumed] = [&plain, &resumed].map(|bytes| {
                let samples = bytes.samples.iter().filter(|sample| sample.sampler != DIFFUSION).cloned().collect();
                Bytes { state: bytes.state.clone(), reported: bytes.reported.clone(), samples }
            });
            assert!(plain.state == resumed.state, "the state, interrupted at {interruption}");
            assert!(same(&plain, &resumed), "interrupted at {interruption}");
        }
    }
}

/// Pairs without memory can be listed or found in cells anew in every step.
#[test]
fn a_list_gives_the_bytes_of_a_search_in_cells() {
    let pairs = r#"interactions.0.pairs=[{"between":["A","B"],"repulsion":40,"friction":9}]"#;
    for integrator in INTEGRATORS.iter().copied().filter(|integrator| !integrator.contains("splitting")) {
        for changes in
            [vec!["interactions.0.skin=0"], vec!["interactions.0.skin=0.05"], vec!["space.box=[12,9]", MIXTURE, pairs]]
        {
            let changes = [&["time.steps=1000", "output.energies.every=3", integrator], &changes[..]].concat();
            let scene = fluid(&changes);
            let listed = run(&scene, Options { listed: true, ..Options::default() }, 8);
            let found = run(&scene, Options::default(), 8);
            assert!(listed.state == found.state, "{changes:?}");
            assert!(listed.reported == found.reported, "{changes:?}");
        }
    }
}

#[test]
fn pair_baths_keep_the_total_momentum_to_the_last_bit() {
    for changes in [vec![MEMORY], vec![MEMORY, MARGIN], vec![MIXTURE, MIXTURE_MEMORY]] {
        let scene = sampled(&changes);
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        for _ in 0..5 {
            engine.advance(100, 50).unwrap();
            assert_eq!(engine.state().unwrap().total_momentum(), state.total_momentum());
        }
    }
}

/// Where a list has no room the run says so before anything is lost, and the same run with more room gives the bytes of
/// one that had room from the start.
#[test]
fn a_full_list_is_told_and_not_cut() {
    // Room is made for places that a scene lists, not for walks that end where they began.
    let crowd = r#"particles=[{"species":"A","count":300},{"species":"A","count":100,
        "chain":{"beads":100,"spacing":0.02}}]"#;
    let scene = sampled(&[MEMORY, "space.box=[40,40]", crowd, "interactions.0.repulsion=0.1"]);
    let (_, state) = start(&scene);
    let mut options = Options::default();
    let capacity = |options| {
        let plan = mesoscope::run::plan(&scene, mesoscope::plan::Hardware::default(), options);
        plan.layout.of::<CoupledLayout>().unwrap().list.unwrap().capacity
    };
    let mut capacities = vec![capacity(options)];
    loop {
        let mut engine = engine(&scene, &state, options);
        let ended = engine.advance(5, 5).and_then(|()| engine.finish().map(|_| ()));
        match ended {
            Err(EngineError::Crowded { step }) => assert!(step < 5),
            ended => break ended.unwrap(),
        }
        assert!(options.has_room_left());
        options = options.with_room(400);
        capacities.push(capacity(options));
    }
    assert!(capacities.len() > 1 && capacities.windows(2).all(|pair| pair[0] < pair[1]), "{capacities:?}");
    let twice = Options { list_growth: options.list_growth + 1, ..options };
    assert!(same(&run(&scene, options, 8), &run(&scene, twice, 8)));
}

#[test]
fn the_margin_of_a_list_is_no_wider_than_the_box_allows() {
    let scene = sampled(&[MEMORY, MARGIN, "space.box=[2.2,5,5]", "output.radial_distribution.range=1"]);
    let model = scene.model();
    let skin = model.particles().pair_force.as_ref().unwrap().skin;
    assert!((skin - 0.1).abs() < 1e-12, "{skin}");
    let bytes = run(&scene, Options::default(), 8);
    assert!(same(&bytes, &run(&scene, Options::default(), 1)));
}

/// Of workgroups of one lane there are more than a dispatch has in one dimension, those whose number depends on the step too.
#[test]
fn folded_dispatches_give_the_same_bytes() {
    let scene = fluid(&["space.box=[28,28,28]", COUPLED]);
    assert!(scene.model().particle_count() > 65_535);
    let run = |workgroup_size| {
        let options = Options { listed: true, workgroup_size: Some(workgroup_size), ..Options::default() };
        bytes::run(&scene, options, 2, 2)
    };
    // Sums over so many workgroups take a single lane more turns than software adapters make.
    let (wide, narrow) = (run(64), run(1));
    assert!(wide.state == narrow.state && wide.reported == narrow.reported);
}
