//! Shallow water to the last bit: the same bytes of the state between steps, of the reported state and of every sample,
//! whatever changes that is not physics, and not a unit of mass lost.

use std::collections::HashSet;

use mesoscope::engine::{EngineError, Sample};
use mesoscope::families::reference::ShallowWaterReference;
use mesoscope::output::{Id, checkpoint};
use mesoscope::plan::{Options, Storage, TIDYING, Traversal};
use mesoscope::scene::Checked;
use mesoscope::shaders::Array;
use mesoscope::state::State;
use rand::SeedableRng as _;

use crate::support::bytes::{self, Bytes};
use crate::support::{ROTATE, WHITE, edited, engine, gpu, in_eights, largest_difference, start, water};

const STEPS: u64 = 12;
const BATCH: u64 = 5;
const NO_ROTATION: [&str; 2] = ["interactions.0.rotation=0", r#"particles.0.velocities={"type":"thermal"}"#];
const WARM: &str = "temperature=4e-4";
const MEMORY: &str = r#"interactions.0.bath={"type":"memory","epsilon":1}"#;
const SYMMETRIC: &str = r#"interactions.0.bath={"type":"memory","epsilon":2,"scheme":"symmetric"}"#;
const EXPONENTIAL: &str = r#"interactions.0.bath={"type":"memory","epsilon":0.5,"scheme":"exponential"}"#;
const LINEAR: &str = "interactions.0.spline_order=1";
const QUADRATIC: &str = "interactions.0.spline_order=2";
const CHEBYSHEV: &str = r#"interactions.0.smoothing={"length":0.8,"power":2,"solver":{"type":"chebyshev"}}"#;
const SPECTRAL: &str = r#"interactions.0.smoothing={"length":0.5,"solver":{"type":"fft","symbol":"spectral"}}"#;
const OBLONG: [&str; 2] = ["space.box=[12,7]", "interactions.0.mesh=[21,13]"];
const NARROW: &str = "space.box=[3,12]";
/// Cells without particles, and eights of cells with just eight particles.
const SPARSE: &str =
    r#"particles=[{"species":"water","count":1800,"placement":{"type":"random"},"velocities":{"type":"geostrophic"}}]"#;
const TRACERS: &str = r#"particles=[
    {"species":"water","count":2048,"placement":{"type":"random"},"velocities":{"type":"geostrophic"}},
    {"species":"water","count":1024,"placement":{"type":"lattice"},"velocities":{"type":"geostrophic"}},
    {"species":"dye","count":7,"tracer":true},
    {"species":"loop","count":96,"tracer":true,"placement":{"type":"circle","center":[0.5,3],"radius":1},
     "velocities":{"type":"geostrophic"}}]"#;

fn sampled(changes: &[&str]) -> Checked {
    water(&[&["time.steps=1000", "output.energies.every=3"], changes].concat())
}

/// Scenes that between them have every integrator, spline, bath, solver, kind of noise and kind of particle.
fn scenes() -> Vec<Checked> {
    vec![
        sampled(&[]),
        sampled(&[ROTATE, MEMORY, WARM, TRACERS, CHEBYSHEV, "interactions.0.mesh=[24,12]"]),
        sampled(&[NARROW, "interactions.0.mesh=[8,32]"]),
        sampled(&[SPARSE, "interactions.0.mesh=[32,64]"]),
        sampled(&[ROTATE, QUADRATIC, WHITE, WARM]),
        sampled(&[LINEAR, MEMORY, WARM, TRACERS, r#"noise={"generator":"threefry2x32-20"}"#]),
        sampled(&[&[CHEBYSHEV, EXPONENTIAL, WARM, TRACERS], &OBLONG[..]].concat()),
        sampled(&[&[ROTATE, LINEAR, SYMMETRIC, CHEBYSHEV, WARM], &NO_ROTATION[..]].concat()),
        sampled(&[QUADRATIC, SPECTRAL, TRACERS, "interactions.0.smoothing.power=2"]),
        sampled(&[ROTATE, SPECTRAL, MEMORY, TRACERS]),
    ]
}

fn run(scene: &Checked, options: Options, batch: u64) -> Bytes {
    bytes::run(scene, options, STEPS, batch)
}

/// Each way to store with each traversal in two or three of the scenes.
#[test]
fn storage_traversals_scans_and_workgroup_sizes_give_the_same_bytes() {
    every_way_gives_the_same_bytes(|scene, way, traversal| {
        (scene + way).is_multiple_of(2) && (scene / 2 + way / 2 + traversal).is_multiple_of(2)
    });
}

#[test]
#[ignore = "a minute"]
fn all_storages_traversals_scans_and_workgroup_sizes_give_the_same_bytes() {
    every_way_gives_the_same_bytes(|_, _, _| true);
}

/// Compares ways to store and visit particles in scenes, as far as the numbers of a scene, a way and a traversal are chosen.
fn every_way_gives_the_same_bytes(chosen: fn(usize, usize, usize) -> bool) {
    for (number, scene) in scenes().into_iter().enumerate() {
        let plain = run(&scene, Options { storage: Some(Storage::Sorted), ..in_eights() }, BATCH);
        let sorted = |workgroup_size: u32, many_level_scan: bool| Options {
            storage: Some(Storage::Sorted),
            workgroup_size: Some(workgroup_size),
            serial_memory: (workgroup_size == 32).then_some(false),
            many_level_scan,
            ..in_eights()
        };
        let bins = |workgroup_size: u32| Options { storage: Some(Storage::Bins), ..sorted(workgroup_size, false) };
        // Bins are not sorted, and need no scan.
        let ways = [sorted(32, true), sorted(64, true), sorted(128, false), bins(32), bins(64), bins(128)];
        for (way, options) in ways.into_iter().enumerate() {
            for (index, traversal) in [in_eights().traversal, Some(Traversal::Rows)].into_iter().enumerate() {
                if chosen(number, way, index) {
                    let options = Options { traversal, ..options };
                    assert!(plain == run(&scene, options, BATCH), "{options:?} {:?}", scene.system);
                }
            }
        }
        let roomy = in_eights().with_room(scene.particles.len() as u64);
        assert!(plain == run(&scene, roomy, BATCH), "with room for a crowd");
    }
}

#[test]
fn a_rerun_and_batches_of_any_size_give_the_same_bytes() {
    for (number, scene) in scenes().into_iter().enumerate() {
        let steps = run(&scene, in_eights(), 1);
        assert_eq!(steps.state.step, STEPS);
        let tracers = scene.particles.iter().any(|group| group.tracer);
        let samples = |sampler: usize| steps.samples.iter().filter(|sample| sample.sampler == sampler).count();
        assert_eq!([samples(0), samples(1)], [5, if tracers { 5 } else { 0 }], "steps 0, 3, 6, 9, 12");
        assert!(steps.samples.iter().all(|sample| sample.sums.iter().any(|sum| *sum != 0)));
        for batch in [1, 1000] {
            assert!(steps == run(&scene, in_eights(), batch), "batches of {batch}");
        }
        let pieces = bytes::in_pieces(&scene, in_eights(), &[1, 4, 5, 2], 3);
        assert!(steps == pieces, "piece by piece: {:?}", scene.system);
        let storage = [Storage::Bins, Storage::Sorted][number % 2];
        let options = Options { storage: Some(storage), ..in_eights() };
        let watched = bytes::watched(&scene, options, STEPS);
        assert!(steps == watched, "watched at every step, {storage:?}: {:?}", scene.system);
        // How often it is sampled changes no state.
        let seldom = edited(&scene, |scene| scene.output.energies.every = 7);
        let seldom = run(&seldom, in_eights(), BATCH);
        assert!(steps.state == seldom.state && steps.reported == seldom.reported, "sampled seldom");
    }
}

#[test]
fn the_storage_order_does_not_matter() {
    let mut random = rand::rngs::StdRng::seed_from_u64(1);
    for scene in scenes() {
        let expected = run(&scene, in_eights(), BATCH);
        for storage in [Storage::Bins, Storage::Sorted] {
            let options = Options { storage: Some(storage), ..in_eights() };
            let shuffled = bytes::shuffled(&scene, options, STEPS, BATCH, &mut random);
            assert!(expected == shuffled, "{storage:?}: {:?}", scene.system);
        }
    }
}

#[test]
fn sorted_water_is_put_in_order_of_cells_now_and_then() {
    let scene = sampled(&[]);
    let (model, state) = start(&scene);
    let [columns, rows] = model.shallow_water().unwrap().mesh.map(u64::from);
    // Words of a particle, of which the first two are its position: in textures, and in a buffer.
    for (serial_memory, words) in
        [(true, 4), (false, 6)].into_iter().filter(|(texels, _)| !texels || gpu().serial_memory())
    {
        let options =
            Options { storage: Some(Storage::Sorted), serial_memory: Some(serial_memory), ..Options::default() };
        let mut engine = engine(&scene, &state, options);
        let mut in_order = |steps: u64| {
            engine.advance(steps, BATCH).unwrap();
            engine.reported().unwrap();
            let particles = engine.words(Array::Particles).unwrap();
            let cells: Vec<u64> = (particles.chunks_exact(words).take(state.len()))
                .map(|word| ((u64::from(word[1]) * rows) >> 32) * columns + ((u64::from(word[0]) * columns) >> 32))
                .collect();
            assert_eq!(cells.len(), state.len());
            cells.is_sorted()
        };
        let tidied = [TIDYING - 1, 1, TIDYING - 1, 1].map(&mut in_order);
        assert_eq!(tidied, [false, true, false, true], "serial memory: {serial_memory}");
    }
}

/// A state as a checkpoint brings it back.
fn through_a_checkpoint(scene: &Checked, state: &State) -> State {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("checkpoint.bin");
    checkpoint::save(&path, Id::of_run(scene), scene, state, &[], &[]).unwrap();
    checkpoint::load(&path).unwrap().state
}

/// Split at every other step of a scene, and at the steps between in the next.
#[test]
fn a_run_split_in_two_at_any_step_is_the_run() {
    for (number, scene) in scenes().into_iter().enumerate() {
        let (_, state) = start(&scene);
        let unbroken = run(&scene, in_eights(), BATCH);
        let mut before = engine(&scene, &state, in_eights());
        let mut after = engine(&scene, &state, Options { storage: Some(Storage::Sorted), ..in_eights() });
        for first in (1 + number as u64 % 2..STEPS).step_by(2) {
            before.advance(first - before.step(), 1).unwrap();
            let halfway = before.state().unwrap();
            assert_eq!(halfway.step, first);
            assert_eq!(halfway.masses, state.masses);
            let restored = through_a_checkpoint(&scene, &halfway);
            assert!(restored == halfway, "the checkpoint of step {first}");
            after.upload(&restored).unwrap();
            after.advance(STEPS - first, BATCH).unwrap();
            let (last, reported) = (after.state().unwrap(), after.reported().unwrap());
            assert!(last == unbroken.state, "split at {first}: state ({:?})", scene.system);
            assert!(reported == unbroken.reported, "split at {first}: reported ({:?})", scene.system);
            let samples = after.finish().unwrap();
            let later: Vec<&Sample> = unbroken.samples.iter().filter(|sample| sample.step >= first).collect();
            assert!(samples.iter().eq(later), "split at {first}: samples ({:?})", scene.system);
        }
    }
}

#[test]
fn the_mass_on_the_mesh_is_constant_to_the_last_unit() {
    for scene in scenes() {
        let (model, state) = start(&scene);
        let total = model.shallow_water().unwrap().total_mass();
        assert_eq!(state.masses.iter().map(|mass| u64::from(*mass)).sum::<u64>(), total, "of the particles");
        for storage in [Storage::Bins, Storage::Sorted] {
            let mut engine = engine(&scene, &state, Options { storage: Some(storage), ..in_eights() });
            let mut seen = HashSet::new();
            for step in 0..STEPS {
                let reported = engine.reported().unwrap();
                assert_eq!(reported.masses, state.masses);
                let nodes = engine.words(Array::NodeMasses).unwrap();
                let nodes = &nodes[..model.shallow_water().unwrap().nodes() as usize];
                assert_eq!(nodes.iter().map(|mass| u64::from(*mass)).sum::<u64>(), total, "step {step}, {storage:?}");
                seen.insert(nodes.to_vec());
                engine.advance(1, 1).unwrap();
            }
            assert_eq!(seen.len() as u64, STEPS, "the water moves");
        }
    }
}

#[test]
#[ignore = "half a minute on a software adapter: run by `make validate`"]
fn the_mass_on_the_mesh_is_constant_for_twenty_thousand_steps() {
    let scene = sampled(&[MEMORY, WARM, LINEAR]);
    let (model, state) = start(&scene);
    let total = model.shallow_water().unwrap().total_mass();
    let mut engine = engine(&scene, &state, in_eights());
    for _ in 0..200 {
        engine.advance(100, 50).unwrap();
        engine.reported().unwrap();
        let nodes = engine.words(Array::NodeMasses).unwrap();
        assert_eq!(nodes[..256].iter().map(|mass| u64::from(*mass)).sum::<u64>(), total);
        engine.finish().unwrap();
    }
}

// ---- The clock and the noise

/// Bath variables and masses of the step before, as at a step that is not the first.
fn under_way(scene: &Checked) -> State {
    let (_, state) = start(scene);
    let mut engine = engine(scene, &state, in_eights());
    engine.advance(2, 2).unwrap();
    engine.state().unwrap()
}

#[test]
fn the_clock_goes_past_any_power_of_two() {
    for scene in [sampled(&[MEMORY, WARM]), sampled(&[ROTATE, WHITE, WARM, TRACERS]), sampled(&[])] {
        let middle = under_way(&scene);
        for first in [(1 << 32) - 2, u64::MAX - 5] {
            for storage in [Storage::Bins, Storage::Sorted] {
                let state = State { step: first, ..middle.clone() };
                let mut device = engine(&scene, &state, Options { storage: Some(storage), ..in_eights() });
                let mut reference = ShallowWaterReference::new(scene.model().clone(), state).unwrap();
                device.advance(4, 3).unwrap();
                reference.run(4).unwrap();
                let found = device.state().unwrap();
                assert_eq!(found.step, first + 4);
                let (velocity, position) = largest_difference(&found, reference.state());
                // A step that went unnoticed, or noise of another, would be millions of units.
                assert!(velocity < 20_000 && position < 20_000, "step {first}: {velocity} {position}");
                let steps: HashSet<u64> = device.finish().unwrap().iter().map(|sample| sample.step).collect();
                assert_eq!(steps, (first..=first + 4).filter(|step| step.is_multiple_of(3)).collect());
            }
        }
        let last = State { step: u64::MAX - 1, ..middle };
        let mut device = engine(&scene, &last, in_eights());
        assert!(matches!(device.advance(2, 1), Err(EngineError::State { .. })));
        device.advance(1, 1).unwrap();
        assert!(matches!(device.advance(1, 1), Err(EngineError::State { .. })));
    }
}

#[test]
fn every_word_of_seed_and_step_counts() {
    let words = [1_u64, 2, 1 << 32, (1 << 32) + 1, 2 << 32, 1 << 63, u64::MAX - 1];
    for generator in ["pcg4d", "threefry2x32-20"] {
        let generator = format!(r#"noise={{"generator":"{generator}"}}"#);
        let scene = sampled(&[MEMORY, WARM, &generator]);
        let middle = under_way(&scene);
        let mut seen = HashSet::new();
        for seed in words {
            let scene = edited(&scene, |scene| scene.seed = seed);
            let mut device = engine(&scene, &middle, in_eights());
            for step in words {
                let state = State { step, ..middle.clone() };
                device.upload(&state).unwrap();
                device.advance(1, 1).unwrap();
                let found = device.state().unwrap();
                let mut reference = ShallowWaterReference::new(scene.model().clone(), state).unwrap();
                reference.step().unwrap();
                let expected = reference.state();
                for (node, (a, b)) in found.node_bath.iter().zip(&expected.node_bath).enumerate() {
                    let (a, b) = (f32::from_bits(*a), f32::from_bits(*b));
                    assert!((a - b).abs() < 1e-5, "seed {seed}, step {step}: bath {a}, not {b}, at node {node}");
                }
                assert!(seen.insert(found.node_bath), "seed {seed}, step {step} repeats the noise of another");
            }
        }
    }
}

#[test]
fn another_seed_is_another_run_only_where_there_is_noise() {
    for (changes, noisy) in [(&[MEMORY, WARM][..], true), (&[WHITE, WARM], true), (&[MEMORY], false), (&[], false)] {
        let [one, two] =
            ["seed=1", "seed=2"].map(|seed| run(&sampled(&[changes, &[seed]].concat()), in_eights(), BATCH));
        assert_eq!(one.reported.momenta != two.reported.momenta, noisy, "{changes:?}");
        assert_eq!(one != two, noisy, "{changes:?}");
    }
}

#[test]
fn states_without_what_a_step_needs_are_refused() {
    let scene = sampled(&[MEMORY, WARM]);
    let middle = under_way(&scene);
    let mut engine = engine(&scene, &middle, in_eights());
    for wrong in [
        State { masses: Vec::new(), ..middle.clone() },
        State { node_bath: Vec::new(), ..middle.clone() },
        State { node_masses: Vec::new(), ..middle.clone() },
        State { positions: middle.positions[1..].to_vec(), ..middle.clone() },
    ] {
        assert!(matches!(engine.upload(&wrong), Err(EngineError::State { .. })));
    }
    engine.upload(&middle).unwrap();
    assert_eq!(engine.state().unwrap(), middle);
}
