//! The same bytes: of the state between steps, of the reported state and of every sample, whatever changes that is not
//! physics.

use std::collections::HashSet;

use mesoscope::engine::{Engine, EngineError, Sample};
use mesoscope::noise;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::shaders::Entry;
use mesoscope::state::State;
use rand::SeedableRng as _;

use crate::support::bytes::{self, Bytes, harvest};
use crate::support::{
    COTTER_REICH, GROOT_WARREN, INTEGRATORS, MIXTURE, MIXTURE_FORCE, PREDICTED, SPLITTING, edited, engine, fluid,
    reference, start, traversals,
};

const STEPS: u64 = 24;
const TWO_DIMENSIONS: &str = "space.box=[12,9]";

fn sampled(changes: &[&str]) -> Checked {
    let every_sampler = [
        "time.steps=1000",
        "output.energies.every=3",
        r#"output.radial_distribution={"every":4,"range":2.0,"bins":40}"#,
        r#"output.diffusion={"every":2,"window":8}"#,
        r#"output.viscosity={"every":5,"window":8}"#,
    ];
    fluid(&[&every_sampler[..], changes].concat())
}

fn run(scene: &Checked, options: Options, batch: u64) -> Bytes {
    bytes::run(scene, options, STEPS, batch)
}

/// Scenes that between them have every kind of particle, table and noise.
fn scenes() -> Vec<Checked> {
    vec![
        sampled(&[GROOT_WARREN]),
        sampled(&[SPLITTING, MIXTURE, MIXTURE_FORCE]),
        sampled(&[SPLITTING, TWO_DIMENSIONS]),
        sampled(&[PREDICTED, TWO_DIMENSIONS]),
        sampled(&[COTTER_REICH, MIXTURE, MIXTURE_FORCE]),
        sampled(&[PREDICTED, MIXTURE, MIXTURE_FORCE, r#"noise={"distribution":"gaussian"}"#]),
    ]
}

/// Choices of how a step is computed, and how many values each has.
const CHOICES: [usize; 6] = [2, 3, 2, 3, 2, 3];

/// The values of the choices with these numbers.
fn way([traversal, segments, scan, workgroup, copies, pairs]: [usize; 6]) -> Options {
    let traversals = traversals();
    Options {
        traversal: Some(traversals[traversal % traversals.len()]),
        segments: Some([1, 2, 7][segments]),
        many_level_scan: scan == 1,
        workgroup_size: [None, Some(32), Some(128)][workgroup],
        serial_memory: (workgroup == 1).then_some(false),
        copies: [None, Some(u64::from(u32::MAX))][copies],
        // Distances counted by a hundred dispatches, and by two.
        pairs_in_dispatch: [None, Some(10_000), Some(500_000)][pairs],
        ..Options::default()
    }
}

/// Two ways for each scene, which between them have every value of a choice with every value of every other one.
fn few_ways(scene: usize) -> impl Iterator<Item = [usize; 6]> {
    let half = scene / 2;
    (0..2).map(move |n| [n, (n + half) % 3, scene / 3 % 2, scene % 3, scene % 2, (n + 2 * scene + half) % 3])
}

#[test]
fn few_ways_have_every_two_values_together() {
    let ways: Vec<[usize; 6]> = (0..scenes().len()).flat_map(few_ways).collect();
    for (first, a) in CHOICES.iter().enumerate() {
        for (second, b) in CHOICES.iter().enumerate().filter(|(second, _)| *second != first) {
            let together: HashSet<[usize; 2]> = ways.iter().map(|way| [way[first], way[second]]).collect();
            assert_eq!(together.len(), a * b, "choices {first} and {second}: {together:?}");
        }
    }
}

/// All ways to visit pairs and to scan; copies and distances are counted as they are by default.
fn all_ways() -> impl Iterator<Item = [usize; 6]> {
    let values = [CHOICES[0], CHOICES[1], CHOICES[2], CHOICES[3]];
    (0..values.iter().product::<usize>()).map(move |mut number| {
        let [traversal, segments, scan, workgroup] = values.map(|values| {
            let value = number % values;
            number /= values;
            value
        });
        [traversal, segments, scan, workgroup, 0, 0]
    })
}

fn gives_the_bytes_of(plain: &Bytes, scene: &Checked, ways: impl Iterator<Item = [usize; 6]>) {
    for options in ways.map(way) {
        assert!(*plain == run(scene, options, 8), "{options:?}");
    }
}

#[test]
fn traversals_segments_scans_and_workgroup_sizes_give_the_same_bytes() {
    for (number, scene) in scenes().into_iter().enumerate() {
        gives_the_bytes_of(&run(&scene, Options::default(), 8), &scene, few_ways(number));
    }
}

#[test]
#[ignore = "minutes"]
fn all_traversals_segments_scans_and_workgroup_sizes_together_give_the_same_bytes() {
    for scene in scenes() {
        gives_the_bytes_of(&run(&scene, Options::default(), 8), &scene, all_ways());
    }
}

/// Up to 1 024 particles a card sorts in one workgroup, and more of them in a scan and a scatter.
#[test]
fn few_particles_are_sorted_as_many_are() {
    for (count, in_one_workgroup) in [(1023, true), (1024, true), (1025, false)] {
        let particles = format!(r#"particles=[{{"species":"A","count":{count}}}]"#);
        let scene = sampled(&[GROOT_WARREN, "space.box=[7,7,7]", &particles]);
        let expected = run(&scene, Options::default(), 8);
        for many_level_scan in [false, true] {
            let options = Options { serial_memory: Some(false), many_level_scan, ..Options::default() };
            let (model, state) = start(&scene);
            let engine = engine(&scene, &state, options);
            let one = engine.plan().kernels.iter().any(|kernel| kernel.entry == Entry::SortInOneWorkgroup);
            assert_eq!(one, in_one_workgroup && !many_level_scan, "{} {options:?}", model.particle_count());
            assert!(run(&scene, options, 8) == expected, "{count} {options:?}");
        }
    }
}

#[test]
fn a_rerun_and_batches_of_any_size_give_the_same_bytes() {
    for scene in scenes() {
        let steps = run(&scene, Options::default(), 1);
        assert_eq!(steps.state.step, STEPS);
        // Energies at 0, 3, …, 24 and g(r), diffusion, viscosity at their own steps, the last included.
        let of = |sampler: usize| steps.samples.iter().filter(|sample| sample.sampler == sampler).count();
        assert_eq!([of(0), of(1), of(2), of(3)], [9, 7, 13, 5]);
        assert!(steps.samples.iter().all(|sample| sample.sums.iter().any(|sum| *sum != 0)));
        for batch in [1, 3, 1000] {
            assert!(steps == run(&scene, Options::default(), batch), "batches of {batch}");
        }
        let pieces = bytes::in_pieces(&scene, Options::default(), &[1, 4, 11, 8], 5);
        assert!(steps == pieces, "piece by piece");
        assert!(steps == bytes::watched(&scene, Options::default(), STEPS), "watched at every step");
    }
}

#[test]
fn the_storage_order_does_not_matter() {
    let mut random = rand::rngs::StdRng::seed_from_u64(1);
    for (number, scene) in scenes().into_iter().enumerate() {
        let expected = run(&scene, Options::default(), 8);
        // Another way to visit pairs for the next scene.
        let traversal = traversals()[number % traversals().len()];
        let options = Options { traversal: Some(traversal), ..Options::default() };
        assert!(expected == bytes::shuffled(&scene, options, STEPS, 8, &mut random), "{traversal:?}");
    }
}

#[test]
fn only_orders_of_all_particles_are_accepted() {
    let scene = fluid(&[GROOT_WARREN, r#"particles=[{"species":"A","count":3}]"#]);
    let (_, state) = start(&scene);
    let mut engine = engine(&scene, &state, Options::default());
    assert!(engine.upload_in_order(&state, &[2, 0, 1]).is_ok());
    for order in [&[0, 1][..], &[0, 1, 1], &[0, 1, 3], &[0, 1, 2, 3]] {
        assert!(matches!(engine.upload_in_order(&state, order), Err(EngineError::State { .. })), "{order:?}");
    }
}

#[test]
fn a_run_split_in_two_is_the_run() {
    // Every integrator, of one species, in the plane and of a mixture by turns.
    let kinds = [&[][..], &[TWO_DIMENSIONS], &[MIXTURE, MIXTURE_FORCE]];
    for (integrator, kind) in INTEGRATORS.iter().zip(kinds.into_iter().cycle()) {
        let changes = [&[*integrator], kind].concat();
        // Diffusion begins its windows anew; every other sampler has no memory.
        let scene = sampled(&[changes.as_slice(), &["output.diffusion=null"]].concat());
        let (_, state) = start(&scene);
        let unbroken = run(&scene, Options::default(), 8);
        for first in [1, 7, 12] {
            let mut before = engine(&scene, &state, Options::default());
            before.advance(first, 8).unwrap();
            let halfway = before.state().unwrap();
            assert_eq!(halfway.step, first);
            let mut after = engine(&scene, &halfway, Options::default());
            after.advance(STEPS - first, 8).unwrap();
            let after = harvest(after, Vec::new());
            assert!(after.state == unbroken.state, "split at {first}: state ({changes:?})");
            assert!(after.reported == unbroken.reported, "split at {first}: reported state ({changes:?})");
            let later: Vec<&Sample> = unbroken.samples.iter().filter(|sample| sample.step >= first).collect();
            assert!(after.samples.iter().eq(later), "split at {first}: samples ({changes:?})");
        }
    }
}

/// Runs and asserts that no component of momentum moves by a bit, in the state or in the samples.
fn momentum_stays(changes: &[&str], steps: u64, every: u64) {
    let scene = fluid(&[changes, &[&format!("output.energies.every={every}")]].concat());
    let (_, mut state) = start(&scene);
    // A momentum that is not zero, so that its loss would show as well as its gain.
    state.momenta[0] = [1 << 24, -(1 << 23), if scene.space.lengths.len() == 3 { 12_345_678 } else { 0 }];
    let total = state.total_momentum();
    let mut engine = engine(&scene, &state, Options::default());
    engine.advance(steps, 500).unwrap();
    let last = engine.state().unwrap();
    assert_eq!((last.step, last.total_momentum()), (steps, total), "{changes:?}");
    assert_ne!(last.momenta, state.momenta);
    let samples = engine.finish().unwrap();
    assert_eq!(samples.len() as u64, steps / every + 1);
    for sample in samples {
        assert_eq!(sample.sums[2..5], total, "step {} ({changes:?})", sample.step);
    }
}

#[test]
fn momentum_is_constant_to_the_last_bit() {
    momentum_stays(&[GROOT_WARREN], 2000, 10);
    momentum_stays(&[SPLITTING], 2000, 10);
    momentum_stays(&[PREDICTED, TWO_DIMENSIONS, MIXTURE, MIXTURE_FORCE], 2000, 10);
    momentum_stays(&[COTTER_REICH, TWO_DIMENSIONS], 2000, 10);
}

#[test]
#[ignore = "a minute on a software adapter: run by `make validate`"]
fn momentum_is_constant_to_the_last_bit_for_a_hundred_thousand_steps() {
    // One that visits the pairs once a step, and one that visits them twice.
    for integrator in [GROOT_WARREN, SPLITTING] {
        momentum_stays(&[integrator], 100_000, 100);
    }
}

/// One step from the same particles under another seed or at another step.
fn one_step(scene: &Checked, engine: &mut Engine<'_>, start: &State, step: u64) -> State {
    let state = State { step, ..start.clone() };
    engine.upload(&state).unwrap();
    engine.advance(1, 1).unwrap();
    let found = engine.state().unwrap();
    assert_eq!(found.step, step + 1);
    let mut reference = reference(scene, &state);
    reference.step().unwrap();
    let (momentum, _) = crate::support::largest_difference(&found, reference.state());
    assert!(momentum <= 100, "step {step} of seed {}: {momentum} units from the reference", scene.seed);
    found
}

#[test]
fn every_word_of_seed_and_step_counts() {
    let (_, start) = start(&fluid(&[GROOT_WARREN]));
    let words = [1_u64, 2, 1 << 32, (1 << 32) + 1, 2 << 32, 1 << 63, u64::MAX - 1];
    let mut seen = HashSet::new();
    for seed in words {
        let scene = edited(&fluid(&[GROOT_WARREN]), |scene| scene.seed = seed);
        let mut engine = engine(&scene, &start, Options::default());
        for step in words {
            let momenta = one_step(&scene, &mut engine, &start, step).momenta;
            assert!(seen.insert(momenta), "seed {seed}, step {step} repeats the noise of another seed and step");
        }
    }
}

#[test]
fn keys_of_seeds_streams_and_steps_do_not_alias() {
    let words: Vec<u64> =
        (0..40).chain((0..40).map(|word| word << 32)).chain((0..40).map(|word| u64::MAX - word)).collect();
    let mut keys = HashSet::new();
    let mut distinct = 0;
    for seed in words.iter().collect::<HashSet<_>>() {
        for step in words.iter().collect::<HashSet<_>>() {
            for stream in 0..8 {
                keys.insert(noise::step_key(*seed, stream, *step));
                distinct += 1;
            }
        }
    }
    // Among 2⁶⁴ keys, a hundred thousand random ones meet with a probability of 10⁻⁹.
    assert_eq!(keys.len(), distinct);
}

#[test]
fn another_seed_is_another_run() {
    let changes = [GROOT_WARREN, "output.energies.every=3"];
    let [one, two] = ["seed=1", "seed=2"].map(|seed| {
        let scene = fluid(&[&changes[..], &[seed]].concat());
        // The same particles for both: what differs is the noise.
        let (_, state) = start(&fluid(&changes));
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(STEPS, 8).unwrap();
        harvest(engine, Vec::new())
    });
    assert_ne!(one.state.momenta, two.state.momenta);
    // The report of step 0 comes before any noise has moved anything; the virial holds the noise itself.
    assert_eq!(one.samples[0].sums[0], two.samples[0].sums[0]);
    assert_eq!(one.samples[0].sums[5..], two.samples[0].sums[5..]);
    for (a, b) in one.samples.iter().zip(&two.samples).skip(1) {
        assert_ne!(a.sums[0], b.sums[0], "kinetic energy at step {}", a.step);
    }
}
