//! Coupled scenes at the ends of what a scene can ask for.

use mesoscope::plan::Options;
use mesoscope::state::State;

use crate::support::{Device, Implementation, fluid, start};

const MEMORY: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":5}}]"#;
const BATHS: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"tether","stiffness":3},
    {"type":"langevin","friction":2,"bath":{"type":"memory","rate":5}}]"#;
const STEP: &str = "time.step=0.01";

#[test]
fn none_one_and_two_particles() {
    // Every number with every box once, and with either list of interactions.
    let boxes = ["[5]", "[5,4]", "[5,4,3]", "[2.01,2.01,2.01]"];
    for count in [0, 1, 2] {
        for (index, lengths) in boxes.into_iter().enumerate() {
            let interactions = [MEMORY, BATHS][(index + count) % 2];
            let particles = format!(r#"particles=[{{"species":"A","count":{count}}}]"#);
            let lengths = format!("space.box={lengths}");
            let scene = fluid(&[STEP, interactions, &particles, &lengths, "output.energies.every=1"]);
            let mut run = Device::new(&scene);
            run.step(30);
            assert_eq!(run.state().len(), count, "{interactions} {lengths}");
            let row = run.observe();
            assert_eq!(row.particles, count as u64);
            assert!(row.kinetic_energy.is_finite() && row.potential_energy.is_finite());
        }
    }
}

/// Without a temperature a bath only takes energy away; without friction or rate nothing is taken.
#[test]
fn no_temperature() {
    for (bath, keeps) in [
        (r#"{"type":"memory","rate":5}"#, false),
        (r#"{"type":"memory","rate":0,"coupling":20}"#, true),
        (r#"{"type":"memory","rate":3,"coupling":0}"#, true),
    ] {
        let friction = if bath.contains("coupling") { "0" } else { "4.5" };
        let interactions =
            format!(r#"interactions=[{{"type":"dpd","repulsion":25,"friction":{friction},"bath":{bath}}}]"#);
        let scene = fluid(&[
            "time.step=0.002",
            "space.box=[3,3,3]",
            "temperature=0",
            &interactions,
            r#"particles.0.placement.type="lattice""#,
            "output.energies.every=1",
        ]);
        // A lattice with one particle out of its place is not at rest for long.
        let (_, mut state) = start(&scene);
        state.positions[0][0] = state.positions[0][0].wrapping_add(1 << 28);
        let mut run = Device::from_state(&scene, &state, Options::default());
        let first = run.observe();
        run.step(500);
        let last = run.observe();
        let change = last.total_energy() + last.bath_energy - first.total_energy() - first.bath_energy;
        println!("{bath}: {} -> {}, bath {}", first.total_energy(), last.total_energy(), last.bath_energy);
        assert!(last.kinetic_energy > 0.0);
        let scale = 0.1 * first.potential_energy;
        if keeps {
            // Baths of pairs that have parted are not part of the sum: it may only be too small, and by little.
            assert!(change < 1e-3 * scale && change > -0.2 * scale, "{bath}: {change} of {scale}");
        } else {
            assert!(last.total_energy() < first.total_energy(), "{bath}");
        }
    }
}

/// All particles in one place: pairs without a direction exert no force, and the list holds them all.
#[test]
fn coincident_particles() {
    let positions = vec!["[1,1,1]"; 40].join(",");
    let particles = format!(
        r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":[{positions}]}},"velocities":{{"type":"rest"}}}}]"#
    );
    let scene = fluid(&[STEP, MEMORY, &particles]);
    let mut run = Device::with(&scene, Options { list_growth: 6, ..Options::default() });
    run.step(20);
    let state = run.state();
    assert!(state.positions.iter().all(|position| *position == state.positions[0]));
    assert_eq!(state.total_momentum(), [0; 3]);
    assert_eq!(state.pair_baths.len(), 40 * 39 / 2);
}

/// Stamps are low words of the step: they go round while pairs remember.
#[test]
fn the_step_counter_goes_round() {
    let scene = fluid(&[STEP, MEMORY, r#"particles.0.placement.type="lattice""#, "output.energies.every=1"]);
    let mut settled = Device::new(&scene);
    settled.step(300);
    let state = settled.state();
    for before in [u64::from(u32::MAX) - 20, (1 << 40) - 20] {
        let shift = before - state.step;
        let mut far = State { step: before, ..state.clone() };
        for pair in &mut far.pair_baths {
            pair.stamp = pair.stamp.wrapping_add(shift as u32);
        }
        let mut whole = Device::from_state(&scene, &far, Options::default());
        whole.step(60);
        let mut half = Device::from_state(&scene, &far, Options::default());
        half.step(30);
        let middle = half.state();
        let mut rest = Device::from_state(&scene, &middle, Options::default());
        rest.step(30);
        assert!(whole.state() == rest.state());
        let after = whole.state().pair_baths;
        let low = before as u32;
        assert!(after.iter().any(|pair| pair.stamp < low), "no stamp went round");
        // Had stamps been misread as long ago, the baths would have been drawn anew from their law at rest.
        let kept = |state: &State| -> f64 {
            let memory = |pair: &mesoscope::state::PairBath| f64::from(f32::from_bits(pair.memory));
            let before: std::collections::HashMap<_, _> =
                far.pair_baths.iter().map(|pair| ((pair.first, pair.second), memory(pair))).collect();
            let both = state
                .pair_baths
                .iter()
                .filter_map(|pair| Some((before.get(&(pair.first, pair.second))?, memory(pair))));
            both.map(|(a, b)| a * b).sum::<f64>() / before.values().map(|a| a * a).sum::<f64>()
        };
        let mut soon = Device::from_state(&scene, &far, Options::default());
        soon.step(25);
        // e^-1.25 and what pairs that are apart keep whole.
        assert!(kept(&soon.state()) > 0.3, "{}", kept(&soon.state()));
    }
}

/// Fast and strong baths: nothing but white noise is left of the memory, and temperatures are right or the scene is refused.
#[test]
fn fast_baths() {
    for (scheme, rate) in [("cotter-reich", "1e9"), ("exponential", "1e5")] {
        let bath = format!(r#"interactions.0.bath={{"type":"memory","rate":{rate},"scheme":"{scheme}"}}"#);
        let mut run = Device::new(&fluid(&[
            STEP,
            MEMORY,
            &bath,
            r#"particles.0.placement.type="lattice""#,
            "output.energies.every=1",
        ]));
        run.step(600);
        let found = run.observe().kinetic_temperature();
        assert!((found - 1.0).abs() < 0.17, "{scheme} at {rate}: {found}");
    }
}
