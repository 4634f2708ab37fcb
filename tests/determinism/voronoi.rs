//! Voronoi DPD: the same bytes whatever changes that is not physics.

use mesoscope::engine::EngineError;
use mesoscope::plan::Options;
use mesoscope::run;
use mesoscope::scene::Checked;
use mesoscope::shaders::{Constant, Entry};
use rand::SeedableRng as _;

use crate::support::bytes::{self, Bytes, harvest, same};
use crate::support::{adapter, cells, engine, hardware, series, start};

const STEPS: u64 = 24;

/// Scenes that between them have every kind of sum: a solver in one workgroup and in many, energies, mass exchange.
fn scenes() -> Vec<Checked> {
    let sampled = [
        "output.energies.every=3",
        "time.step=0.01",
        "time.steps=1000",
        r#"output.diffusion={"every":2,"window":8}"#,
        r#"output.viscosity={"every":5,"window":8}"#,
        r#"output.histograms=[{"quantity":"velocity","every":4}]"#,
    ];
    let more: [(u32, &[&str]); 4] = [
        (300, &[]),
        (2116, &["interactions.0.energy={}"]),
        (
            300,
            &[r#"interactions.0.form="consistent""#, "interactions.0.energy={}", "interactions.0.molecular_mass=0.1"],
        ),
        (300, &[r#"interactions.0.form="paper""#, r#"integrator.type="euler""#, "time.step=0.002"]),
    ];
    more.into_iter().map(|(count, changes)| cells(count, &[&sampled[..], changes].concat())).collect()
}

fn bytes_of(scene: &Checked, options: Options, batch: u64) -> Bytes {
    bytes::run(scene, options, STEPS, batch)
}

#[test]
fn reruns_batches_scans_and_workgroup_sizes_give_the_same_bytes() {
    for scene in scenes() {
        bytes::same_in_every_way(&scene, STEPS);
    }
}

#[test]
fn storage_order_gives_the_same_bytes() {
    for scene in scenes() {
        let plain = bytes_of(&scene, Options::default(), 8);
        let mut random = rand::rngs::StdRng::seed_from_u64(7);
        assert!(same(&plain, &bytes::shuffled(&scene, Options::default(), STEPS, 8, &mut random)));
    }
}

/// The number of sums in a row that do not depend on the last upload, which come first: exchanges are counted since
/// then, and the solver remembered.
fn lasting_sums(scene: &Checked) -> usize {
    let plan = run::plan(scene, hardware(), Options::default());
    let counted = plan.constants.iter().find(|(name, _)| *name == Constant::SumLimitedExchanges);
    counted.map_or(usize::MAX, |(_, place)| *place as usize)
}

/// Windows of analyses begin with an engine, so a restart keeps the observables and the state.
#[test]
fn a_restart_gives_the_same_bytes() {
    for scene in scenes() {
        let (_, state) = start(&scene);
        let plain = bytes_of(&scene, Options::default(), 8);
        let mut first = engine(&scene, &state, Options::default());
        first.advance(STEPS / 2, 8).unwrap();
        let middle = first.state().unwrap();
        let early = first.finish().unwrap();
        let mut second = engine(&scene, &middle, Options::default());
        second.advance(STEPS / 2, 5).unwrap();
        let whole = harvest(second, early);
        assert!(plain.state == whole.state && plain.reported == whole.reported);
        let lasting = lasting_sums(&scene);
        let of = |bytes: &Bytes| -> Vec<Vec<i64>> {
            let mut rows: Vec<(u64, Vec<i64>)> = bytes
                .samples
                .iter()
                .filter(|sample| sample.sampler == 0)
                .map(|sample| (sample.step, sample.sums.iter().take(lasting).copied().collect()))
                .collect();
            rows.dedup();
            rows.into_iter().map(|(_, sums)| sums).collect()
        };
        assert_eq!(of(&plain), of(&whole));
    }
}

#[test]
fn a_report_changes_nothing() {
    for changes in [&[][..], &["interactions.0.energy={}"], &[r#"integrator.type="euler""#]] {
        let silent = cells(200, &[&["output.energies.every=1000"], changes].concat());
        let often = cells(200, changes);
        let (_, state) = start(&often);
        let mut one = engine(&often, &state, Options::default());
        let mut other = engine(&silent, &state, Options::default());
        one.advance(20, 4).unwrap();
        other.advance(20, 4).unwrap();
        assert!(one.state().unwrap() == other.state().unwrap(), "{changes:?}");
    }
}

/// Friction that takes more iterations than were recorded is solved with more, to the bits of all that are allowed.
#[test]
fn more_iterations_are_recorded_where_friction_needs_them() {
    // It takes thirteen.
    let changes = ["interactions.0.viscosity=400", "time.step=0.01", "time.steps=6"];
    let scene = cells(2116, &changes);
    let (_, state) = start(&scene);
    let run_with = |options: Options| {
        let mut engine = engine(&scene, &state, options);
        engine.advance(6, 6)?;
        let state = engine.state()?;
        engine.finish().map(|samples| (state, samples))
    };
    let few = Options::default();
    assert!(matches!(run_with(few), Err(EngineError::Unsolved { step: 0 })));
    let more = few.with_more_iterations().unwrap();
    let all = Options { iteration_growth: 31, ..few };
    assert!(run::plan(&scene, hardware(), more).advance.len() < run::plan(&scene, hardware(), all).advance.len());
    let (more, all) = (run_with(more).unwrap(), run_with(all).unwrap());
    assert!(more == all);

    let directory = tempfile::tempdir().unwrap();
    let mut repeated = 0;
    let run = run::Run::start(scene, directory.path().join("run"));
    let observer = &mut |event: run::Event<'_>| repeated += u32::from(matches!(event, run::Event::Repeating { .. }));
    run.execute(&adapter(), observer).unwrap();
    assert_eq!(repeated, 1);
}

/// Of so many cells one workgroup adds up the sums of all: iterations and residual are as in a small box.
#[test]
#[ignore = "seconds"]
fn a_great_many_cells_are_solved_for() {
    let solved = |count: u32| {
        let scene = cells(count, &["interactions.0.viscosity=5", "time.steps=3"]);
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(3, 3).unwrap();
        assert_eq!(engine.state().unwrap().total_momentum(), state.total_momentum());
        let found = series(&mut engine, &scene).pop().unwrap().cells.unwrap();
        assert!(found.residual > 0.0 && found.residual < 1e-5, "{count} cells: {}", found.residual);
        found.iterations
    };
    let plan = run::plan(&cells(70_225, &[]), hardware(), Options::default());
    assert!(plan.kernels.iter().any(|kernel| kernel.entry == Entry::FrictionTotal));
    assert!(solved(70_225).abs_diff(solved(2500)) <= 1);
}
