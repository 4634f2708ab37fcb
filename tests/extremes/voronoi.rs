//! Voronoi DPD at the ends of what a scene can ask for.

use mesoscope::engine::EngineError;
use mesoscope::families::reference::VoronoiReference;
use mesoscope::plan::Options;
use mesoscope::state::{Reported, State};

use crate::support::{Device, ENERGY, Implementation, cells, engine, start, totals};

/// What [`totals`] are of a report.
fn reported(cells: Reported) -> ([i64; 3], i64, i64) {
    totals(&State { momenta: cells.momenta, masses: cells.masses, energies: cells.energies, ..State::default() })
}

#[test]
fn none_and_a_few_cells() {
    let kinds = [&[][..], &[ENERGY], &[r#"interactions.0.form="consistent""#], &[r#"integrator.type="euler""#]];
    // Every kind with few cells and with fewer.
    for (index, count) in [0, 1, 2, 3, 9].into_iter().enumerate() {
        for more in [kinds[index % 4], kinds[(index + 2) % 4]] {
            let random = r#"particles.0.placement={"type":"random"}"#;
            let scene = cells(count, &[&["time.step=0.002", random], more].concat());
            let (_, state) = start(&scene);
            let mut run = Device::from_state(&scene, &state, Options::default());
            run.step(30);
            let after = run.state();
            assert_eq!(totals(&after), totals(&state), "{count} {more:?}");
            let row = run.observe();
            assert_eq!(row.particles, u64::from(count));
            assert!(row.kinetic_energy.is_finite());
            let volume = row.cells.unwrap().volume;
            assert!((volume - f64::from(count)).abs() <= 1e-5 * f64::from(count.max(1)), "{count}: {volume}");
        }
    }
}

/// Steps of few cells, which border each other in several images, are those of the reference.
#[test]
fn images_of_the_same_neighbour_are_told_apart() {
    for count in [2, 3, 9] {
        let random = r#"particles.0.placement={"type":"random"}"#;
        let tight = r#"interactions.0.friction_solver={"iterations":100,"tolerance":1e-7}"#;
        let scene = cells(count, &[random, ENERGY, tight, "time.step=0.005"]);
        let (model, state) = start(&scene);
        let mut run = Device::from_state(&scene, &state, Options::default());
        let mut reference = VoronoiReference::new(model, state).unwrap();
        run.step(1);
        reference.step().unwrap();
        let (momentum, position) = crate::support::largest_difference(&run.state(), reference.state());
        println!("{count}: {momentum} {position}");
        // Thermal noise of a face in this step is some million units.
        assert!(momentum < 1000 && position < 100_000, "{count}: {momentum} {position}");
    }
}

/// Without a temperature there is no noise: a shear wave only decays, into heat where there is an account of it.
#[test]
fn no_temperature() {
    let wave = r#"particles.0.velocities={"type":"shear-wave","amplitude":1,"periods":1}"#;
    for energy in [None, Some(ENERGY), Some(r#"interactions.0.energy={"conductivity":0}"#)] {
        let changes: Vec<&str> = ["temperature=0", wave].into_iter().chain(energy).collect();
        let scene = cells(400, &changes);
        let (_, state) = start(&scene);
        let mut run = Device::from_state(&scene, &state, Options::default());
        let first = run.observe();
        run.step(100);
        let last = run.observe();
        assert_eq!(reported(run.reported()), totals(&state));
        assert!(last.kinetic_energy < 0.95 * first.kinetic_energy && last.kinetic_energy > 0.0);
        if energy.is_some() {
            let heat = last.cells.unwrap().internal_energy - first.cells.unwrap().internal_energy;
            let lost = first.kinetic_energy - last.kinetic_energy;
            assert!((heat / lost - 1.0).abs() < 1e-3, "{heat} of {lost}");
        }
    }
    let rest = cells(100, &["temperature=0", r#"particles.0.velocities={"type":"rest"}"#]);
    let (_, state) = start(&rest);
    let mut run = Device::from_state(&rest, &state, Options::default());
    run.step(10);
    assert!(run.state().momenta.iter().all(|momentum| *momentum == [0; 3]));
}

#[test]
fn viscosities_from_nothing_to_much() {
    for (viscosity, step, kinds) in [
        ("0", "0.01", &[None, Some(ENERGY)][..]),
        ("1e-6", "0.01", &[None]),
        ("100", "0.01", &[Some(ENERGY)]),
        ("1e6", "1e-7", &[None]),
    ] {
        for more in kinds {
            let (viscosity, step) = (format!("interactions.0.viscosity={viscosity}"), format!("time.step={step}"));
            let changes: Vec<&str> =
                [viscosity.as_str(), &step, "interactions.0.molecular_mass=0.5"].into_iter().chain(*more).collect();
            let scene = cells(400, &changes);
            let (_, state) = start(&scene);
            let mut run = Device::from_state(&scene, &state, Options::default());
            run.step(200);
            let row = run.observe();
            assert_eq!(reported(run.reported()), totals(&state));
            // 798 degrees of freedom: ±.05; the sound of a start from a lattice may warm it.
            let temperature = row.kinetic_temperature();
            println!("{changes:?}: {temperature:.3}, {:?}", row.cells.unwrap().iterations);
            assert!((temperature - 1.0).abs() < 0.35, "{changes:?}: {temperature}");
        }
    }
}

/// So thick a fluid that friction acts ten thousand times over in a step: the midpoint turns velocities round and keeps their
/// distribution, if the solver is let run to its end. 400 cells have 800 squares of variance 2: five of their standard
/// errors are .25. What it leaves over in forty iterations heats, by a quarter in fifty steps.
#[test]
fn a_fluid_too_thick_for_its_step() {
    let thorough = r#"interactions.0.friction_solver={"iterations":1000,"tolerance":1e-7}"#;
    let scene = cells(400, &["interactions.0.viscosity=1e6", "time.step=0.02", thorough]);
    let (_, state) = start(&scene);
    let mut run = Device::from_state(&scene, &state, Options::default());
    for _ in 0..3 {
        run.step(20);
        let row = run.observe();
        let (temperature, cells) = (row.kinetic_temperature(), row.cells.unwrap());
        println!("kT {temperature:.4}, {} iterations", cells.iterations);
        assert!((temperature - 1.0).abs() < 0.25, "{temperature}");
        assert!((100..1000).contains(&cells.iterations), "{}", cells.iterations);
    }
    run.step(1);
    assert_eq!(run.state().total_momentum(), state.total_momentum());
}

#[test]
fn dense_and_dilute_and_long_boxes() {
    for (count, lengths, mass) in
        [(300, "[0.01,0.01]", 1e-6), (300, "[1e4,1e4]", 1e6), (300, "[300,1]", 5.0), (64, "[1,64]", 5.0)]
    {
        let volume: f64 =
            lengths.trim_matches(['[', ']']).split(',').map(|edge| edge.parse::<f64>().unwrap()).product();
        let width = (volume / f64::from(count)).sqrt();
        // In units of a cell's width and its thermal velocity.
        let velocity = 1.0 / f64::sqrt(mass);
        let scene = cells(
            count,
            &[
                &format!("space.box={lengths}"),
                &format!("particles.0.mass={mass}"),
                &format!("interactions.0.molecular_mass={}", mass / 5.0),
                &format!("interactions.0.viscosity={}", mass * velocity / width / 5.0),
                &format!("time.step={}", 0.02 * width / velocity),
            ],
        );
        let (_, state) = start(&scene);
        let mut run = Device::from_state(&scene, &state, Options::default());
        run.step(100);
        let row = run.observe();
        assert_eq!(reported(run.reported()), totals(&state));
        assert!((row.cells.unwrap().volume / volume - 1.0).abs() < 1e-5);
        assert!((row.kinetic_temperature() - 1.0).abs() < 0.5, "{lengths}: {}", row.kinetic_temperature());
    }
}

#[test]
fn coincident_cells_part() {
    let positions = ["[1,1]"; 4].join(",");
    let particles = format!(
        r#"particles=[{{"species":"A","mass":5,"placement":{{"type":"listed","positions":[{positions},[3,3],[1,3],[3,1]]}}}}]"#
    );
    // So close, they may only go on in steps that are short beside the rates at their faces.
    let scene = cells(4, &["space.box=[4,4]", &particles, "time.step=1e-4"]);
    let (_, state) = start(&scene);
    let mut run = Device::from_state(&scene, &state, Options::default());
    run.step(50);
    let after = run.state();
    assert_eq!(totals(&after), totals(&state));
    for (index, position) in after.positions.iter().enumerate() {
        assert!(after.positions[..index].iter().all(|other| other != position));
    }
}

#[test]
fn lattices_keep_their_balance() {
    let still = r#"particles=[{"species":"A","count":144,"mass":5,"placement":{"type":"lattice"},"velocities":{"type":"rest"}}]"#;
    for more in [None, Some(ENERGY)] {
        let changes: Vec<&str> = ["interactions.0.viscosity=0", still].into_iter().chain(more).collect();
        let changes: Vec<&str> = changes
            .into_iter()
            .map(|change| if change == ENERGY { r#"interactions.0.energy={"conductivity":0}"# } else { change })
            .collect();
        let scene = cells(144, &changes);
        let (_, state) = start(&scene);
        let mut run = Device::from_state(&scene, &state, Options::default());
        run.step(20);
        // Pressures balance to rounding.
        let worst = run.state().momenta.iter().flatten().map(|momentum| momentum.abs()).max().unwrap();
        assert!(worst < 4096, "{worst}");
    }
}

/// More heat than there is must not cross a face: the limit acts, and temperatures stay positive.
#[test]
fn a_huge_conductivity() {
    let scene = cells(
        400,
        &[
            r#"interactions.0.energy={"conductivity":1e6}"#,
            "interactions.0.molecular_mass=0.05",
            "interactions.0.exchange_limit=0.02",
        ],
    );
    let (_, state) = start(&scene);
    let mut run = Device::from_state(&scene, &state, Options::default());
    run.step(100);
    let row = run.observe();
    assert_eq!(reported(run.reported()), totals(&state));
    assert!(row.cells.unwrap().limited_exchanges > 1000);
    assert!((row.cells.unwrap().internal_temperature - 1.0).abs() < 0.1);
}

/// More cells within the place of one than the loops of some adapters have turns for: they are tessellated, or the adapter
/// is said to have given up, without advice about the step.
#[test]
fn a_crowd_is_tessellated_or_given_up() {
    const CROWD: u32 = 1600;
    let scene = cells(CROWD, &["temperature=0", r#"particles.0.velocities={"type":"rest"}"#, "time.step=1e-6"]);
    let (_, mut state) = start(&scene);
    // Within half the width of a cell of the grid, in no order.
    for (number, position) in (0_u32..).zip(&mut state.positions) {
        let part = |factor: u32| number.wrapping_mul(factor) >> 7;
        *position = [(1 << 31) + part(2_654_435_761), (1 << 31) + part(2_246_822_519), 0];
    }
    let mut engine = engine(&scene, &state, Options::default());
    match engine.advance(1, 1).and_then(|()| engine.finish()) {
        Ok(_) => assert_eq!(engine.reported().unwrap().total_momentum(), state.total_momentum()),
        Err(EngineError::GaveUp { step, adapter }) => {
            assert_eq!(adapter, crate::support::gpu().description().name);
            let message = EngineError::GaveUp { step, adapter }.to_string();
            println!("{message}");
            assert!(step <= 1 && message.contains("crowd") && !message.contains("time step"), "{message}");
        }
        Err(EngineError::Crowded { .. }) => {}
        Err(other) => panic!("{other}"),
    }
}
