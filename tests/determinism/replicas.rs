//! Systems that a device advances together, each of which is advanced as it is alone: the same bytes.

use std::{fs, thread};

use mesoscope::engine::{Engine, Replicas};
use mesoscope::gpu::{ConstantsIn, Gpu, Requirements};
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::Checked;
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
    let replicas = Replicas::new(gpu, first, scenes.len() as u32).unwrap();
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
    let replicas = Replicas::new(gpu(), plan(&small, gpu(), ConstantsIn::Code), 2).unwrap();
    assert!(replicas[0].suits(&plan(&small, gpu(), ConstantsIn::Code)));
    assert!(!replicas[0].suits(&plan(&large, gpu(), ConstantsIn::Code)));
    let stiff = edited(&small, |scene| scene.time.step *= 0.5);
    assert!(!replicas[0].suits(&plan(&stiff, gpu(), ConstantsIn::Code)), "constants are in the code of kernels");
}

#[test]
fn a_sweep_of_replicas_leaves_the_files_of_runs_alone() {
    let place = tempfile::tempdir().unwrap();
    let set = ["space.box=[4,4,4]", r#"output={"energies":{"every":5}}"#, GROOT_WARREN].map(str::to_owned);
    // One time step is so long that its runs become unstable, which ends no other.
    let vary = ["time.step=0.02,0.15", "seed=1,2,3"].map(str::to_owned);
    let sweep = |name: &str, replicas: usize| {
        let request = Sweep::load("dpd-fluid", &set, Some(120), &vary, &[]).unwrap();
        let run = SweepRun::start(request, place.path().join(name)).with_replicas(Some(replicas)).with_jobs(Some(1));
        run.execute(&adapter(), &mut |_| {}).unwrap()
    };
    let [alone, together] = [sweep("alone", 1), sweep("together", 3)];
    let failed = |outcome: &mesoscope::sweep::SweepOutcome| {
        outcome
            .failures
            .iter()
            .map(|(number, error)| (*number, error.to_string().split(';').count()))
            .collect::<Vec<_>>()
    };
    assert_eq!((failed(&alone).len(), failed(&together)), (3, failed(&alone)));
    for seed in 1..=3 {
        for file in ["energies.csv", "checkpoint.bin"] {
            let read =
                |name: &str| fs::read(place.path().join(format!("{name}/step=0.02,seed={seed}/{file}"))).unwrap();
            assert!(read("alone") == read("together"), "{file}, seed {seed}");
        }
    }
}
