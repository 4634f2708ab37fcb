//! Systems that a device advances together, each of which is advanced as it is alone: the same bytes.

use std::collections::BTreeMap;
use std::{fs, thread};

use mesoscope::engine::{Engine, Replicas};
use mesoscope::gpu::{ConstantsIn, Gpu, Requirements};
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use mesoscope::stability::{self, StabilityRun};
use mesoscope::study::Sweep;
use mesoscope::sweep::SweepRun;

use crate::support::bytes::{Bytes, harvest};
use crate::support::{
    GROOT_WARREN, MIXTURE, MIXTURE_FORCE, adapter, built_in, cells, edited, gpu, requirements, start, water,
};

/// Steps of a replica, and how many of them are submitted at once: replicas are at different steps most of the time.
fn pace(number: usize) -> [u64; 2] {
    [[14, 5], [20, 20], [9, 1], [17, 3]][number % 4]
}

/// The bytes of an engine that has taken its steps; a report in their middle changes none.
fn bytes(mut engine: Engine<'_>, number: usize) -> Bytes {
    let [steps, batch] = pace(number);
    engine.advance(6, batch).unwrap();
    if number == 1 {
        engine.reported().unwrap();
    }
    engine.advance(steps - 6, batch).unwrap();
    harvest(engine, Vec::new())
}

fn plan(scene: &Checked, gpu: &Gpu, constants_in: ConstantsIn) -> Plan {
    run::plan(scene, Hardware::from(gpu), Options { constants_in, ..Options::default() })
}

fn alone(gpu: &Gpu, scenes: &[Checked], constants_in: ConstantsIn) -> Vec<Bytes> {
    let engine = |scene| Engine::new(gpu, plan(scene, gpu, constants_in), &start(scene).1).unwrap();
    scenes.iter().enumerate().map(|(number, scene)| bytes(engine(scene), number)).collect()
}

fn together(gpu: &Gpu, scenes: &[Checked], constants_in: ConstantsIn) -> Vec<Bytes> {
    let first = plan(&scenes[0], gpu, constants_in);
    assert_eq!(Replicas::fitting(&first, gpu, 4), 4, "{}", scenes[0].title);
    let replicas = Replicas::side_by_side(gpu, first, scenes.len() as u32).unwrap();
    thread::scope(|scope| {
        let runs = replicas.into_iter().zip(scenes).enumerate().map(|(number, (replica, scene))| {
            scope.spawn(move || {
                let plan = plan(scene, gpu, constants_in);
                assert!(
                    replica.suits(&plan),
                    "{}: replica {number}, {constants_in:?}, {}",
                    scene.title,
                    plan.particles
                );
                bytes(Engine::of_replica(replica, plan, &start(scene).1).unwrap(), number)
            })
        });
        let runs: Vec<_> = runs.collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    })
}

#[test]
fn replicas_give_the_bytes_of_each_alone() {
    let output = r#"output={"diffusion":{"every":2,"window":4},"trajectory":{"every":5}}"#;
    let melt = ["space.box=[6,6,6]", "particles.2.count=440"];
    let portable = Gpu::open(&adapter(), Requirements { portable: true, ..requirements() }).unwrap();
    // Time steps are in nearly all constants, which are loaded then: drivers may round otherwise where they know them. The velocities of
    // shear lie in other constants too.
    for (scene, differ_in_steps) in [
        (built_in("dpd-fluid", &["space.box=[5,4,6]", output]), true),
        (built_in("dpd-fluid", &["space.box=[4,5,5]", "output={}", MIXTURE, MIXTURE_FORCE, GROOT_WARREN]), false),
        (built_in("dpd-fluid-2d", &["space.box=[9,8]", "output={}"]), false),
        (built_in("polymer-melt", &melt), true),
        (built_in("shear", &["space.box=[6,6,6]"]), false),
        (built_in("drop", &[]), false),
        (
            built_in(
                "salt-water",
                &[
                    "space.box=[6,6,6]",
                    "particles.0.count=500",
                    "particles.1.count=60",
                    "particles.2.count=60",
                    "output={}",
                ],
            ),
            false,
        ),
        (cells(300, &[]), false),
        (water(&["particles.0.count=1024"]), false),
    ] {
        let seeds: Vec<Checked> = (0..4).map(|number| edited(&scene, |scene| scene.seed += number)).collect();
        let steps: Vec<Checked> =
            [1.0, 0.9, 0.8, 0.7].map(|factor| edited(&scene, |scene| scene.time.step *= factor)).into();
        for (gpu, scenes, constants_in) in [
            (gpu(), &seeds, ConstantsIn::Code),
            (&portable, &seeds, ConstantsIn::Code),
            (gpu(), &steps, ConstantsIn::Buffer),
        ] {
            if constants_in == ConstantsIn::Buffer && !differ_in_steps {
                continue;
            }
            let [alone, together] = [alone(gpu, scenes, constants_in), together(gpu, scenes, constants_in)];
            assert!(alone[0].state != alone[1].state, "{}", scene.title);
            for (number, (alone, together)) in alone.iter().zip(&together).enumerate() {
                assert!(alone == together, "{}: replica {number}, {constants_in:?}", scene.title);
            }
        }
    }
}

#[test]
fn plans_of_which_a_dispatch_depends_on_the_step_have_no_replicas() {
    let listed = plan(&built_in("edpd-fluid", &["space.box=[5,5,5]", "output={}"]), gpu(), ConstantsIn::Code);
    assert!(Replicas::fitting(&listed, gpu(), 8) < 2);
    // Others differ in more than numbers.
    let (small, large) = (
        built_in("dpd-fluid", &["space.box=[5,5,5]", "output={}"]),
        built_in("dpd-fluid", &["space.box=[5,5,6]", "output={}"]),
    );
    let replicas = Replicas::side_by_side(gpu(), plan(&small, gpu(), ConstantsIn::Code), 2).unwrap();
    assert!(replicas[0].suits(&plan(&small, gpu(), ConstantsIn::Code)));
    assert!(!replicas[0].suits(&plan(&large, gpu(), ConstantsIn::Code)));
    let stiff = edited(&small, |scene| scene.time.step *= 0.5);
    assert!(!replicas[0].suits(&plan(&stiff, gpu(), ConstantsIn::Code)), "constants are in the code of kernels");
}

/// Files of a sweep of a small fluid, and how many of its runs failed.
fn sweep(vary: &[&str], replicas: usize) -> (BTreeMap<String, Vec<u8>>, usize) {
    let place = tempfile::tempdir().unwrap();
    let set = ["space.box=[4,4,4]", r#"output={"energies":{"every":5}}"#, GROOT_WARREN].map(str::to_owned);
    let vary: Vec<String> = vary.iter().map(|key| (*key).to_owned()).collect();
    let request = Sweep::load("dpd-fluid", &set, Some(120), &vary, &[]).unwrap();
    let names: Vec<String> = request.variants().iter().map(|variant| variant.name.clone()).collect();
    let out = place.path().join("sweep");
    let run = SweepRun::start(request, &out).with_replicas(Some(replicas)).with_jobs(Some(1));
    let failed = run.execute(&adapter(), &mut |_| {}).unwrap().failures.len();
    let files = names.iter().flat_map(|name| ["energies.csv", "checkpoint.bin"].map(|file| format!("{name}/{file}")));
    (files.map(|file| (file.clone(), fs::read(out.join(file)).unwrap())).collect(), failed)
}

#[test]
fn a_sweep_of_replicas_leaves_the_files_of_runs_alone() {
    let seeds = ["seed=1,2,3,4,5"];
    let (alone, together) = (sweep(&seeds, 1), sweep(&seeds, 5));
    assert_eq!((alone.0.len(), alone.1), (10, 0));
    assert!(alone == together);
    // Some time steps are so long that runs become unstable, which ends no other of their group.
    let both = ["seed=1,2,3", "time.step=0.02,0.15"];
    let (in_pairs, together) = (sweep(&both, 2), sweep(&both, 6));
    assert_eq!(in_pairs.1, 3);
    assert!(in_pairs == together);
}

#[test]
fn a_map_of_stability_of_replicas_is_that_of_runs_alone() {
    let map = |replicas: usize| {
        let place = tempfile::tempdir().unwrap();
        let set = ["space.box=[4,4,4]", "time.equilibration=100", "output={}", GROOT_WARREN].map(str::to_owned);
        let request = stability::Request::load("dpd-fluid", &set, Some(400), &["time.step=0.02,0.15".to_owned()]);
        let request = request.unwrap().with_bisections(1).with_seeds(3).unwrap();
        let out = place.path().join("map");
        let run = StabilityRun::start(request, &out).with_replicas(Some(replicas)).with_jobs(Some(1));
        run.execute(&adapter(), &mut |_| {}).unwrap();
        fs::read_to_string(out.join(stability::files::TABLE)).unwrap()
    };
    let (alone, together) = (map(1), map(3));
    for verdict in ["right", "unstable"] {
        assert!(alone.contains(verdict), "{alone}");
    }
    assert_eq!(alone, together);
}

#[test]
fn every_shipped_scene_has_replicas_but_where_dispatches_depend_on_the_step() {
    let mut without = Vec::new();
    for builtin in scene::builtin() {
        let scene = scene::load(builtin.name, &[]).unwrap();
        for constants_in in [ConstantsIn::Code, ConstantsIn::Buffer] {
            let plan = plan(&scene, gpu(), constants_in);
            match Replicas::fitting(&plan, gpu(), 2) {
                2 => drop(
                    Replicas::side_by_side(gpu(), plan, 2).unwrap_or_else(|error| panic!("{}: {error}", builtin.name)),
                ),
                _ => without.push(builtin.name),
            }
        }
    }
    without.dedup();
    assert_eq!(without, ["coloured-noise", "edpd-fluid"], "lists that hold for several steps");
}
