//! Several ranks with bonds, angles, tethers and charges: the same bytes as one.

use mesoscope::engine::{EngineError, Stepper as _};
use mesoscope::plan::{Division, Options};
use mesoscope::scene::Checked;

use super::ranks::{EVERY_THIRD, FOLLOWED, STEPS, continues, fits, team};
use crate::support::bytes::{self, Bytes, same};
use crate::support::{COTTER_REICH, GROOT_WARREN, PREDICTED, SPLITTING, STAGED, built_in, fluid, start};

const PAIRS: &str = r#"{"type":"dpd","repulsion":25,"friction":4.5}"#;
const SPRINGS: &str = r#"{"type":"bonds","potential":{"type":"harmonic","stiffness":50,"length":0.6}}"#;
const ANGLES: &str = r#"{"type":"angles","stiffness":5}"#;
const FENE: &str =
    r#"{"type":"bonds","potential":{"type":"fene","stiffness":30,"extent":1.3},"exclude_repulsion":true}"#;
const EXCLUDING: &str =
    r#"{"type":"bonds","potential":{"type":"harmonic","stiffness":50,"length":0.6},"exclude_charges":true}"#;
const RUBBING: &str = r#"{"type":"bonds","potential":{"type":"harmonic","stiffness":50,"length":0.6},"friction":6}"#;
const TETHERS: &str = r#"{"type":"tether","stiffness":20}"#;
const CHARGES: &str = r#"{"type":"electrostatics","bjerrum_length":1.1}"#;
const WAVES: &str = r#"{"type":"electrostatics","bjerrum_length":1.1,"method":"waves"}"#;
const LANGEVIN: &str = r#"{"type":"langevin","friction":2}"#;
const MANY_BODY: &str = r#"{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}"#;

/// Chains of six beads in solvent.
const CHAINS: &str = r#"particles=[{"species":"A","count":240,"chain":{"beads":6,"spacing":0.6}},
    {"species":"B","count":100}]"#;
/// The same with charges.
const SALT: &str = r#"particles=[{"species":"A","count":240,"charge":-1,"chain":{"beads":6,"spacing":0.6}},
    {"species":"B","count":96,"charge":2.5}]"#;
/// A few long rings, each of which crosses all boundaries.
const RINGS: &str = r#"particles=[{"species":"A","count":320,"chain":{"beads":80,"spacing":0.6,"closed":true}}]"#;
/// Branched molecules of two species, the heavier of which is in the middle.
const BRANCHED: [&str; 2] = [
    r#"particles=[{"species":"A"},{"species":"B","mass":2.5}]"#,
    r#"molecules=[{"beads":["B","A","A","B","A"],"bonds":[[0,1],[0,2],[0,3],[3,4]],"angles":[[1,0,2],[0,3,4]],
        "count":60,"spacing":0.6},{"beads":["A"],"count":90}]"#,
];

fn interactions(list: &[&str]) -> String {
    format!("interactions=[{}]", list.join(","))
}

fn scene(changes: &[&str], list: &[&str]) -> Checked {
    fluid(&[&["time.steps=1000", "time.step=0.02", EVERY_THIRD, &interactions(list)], changes].concat())
}

/// Scenes with every integrator, with what each can be divided into. In the narrow parts bonds reach beyond the next one, in others
/// round the box, so that a rank knows all of it.
fn cases() -> Vec<(Checked, Vec<[u32; 3]>)> {
    let bonded = [PAIRS, SPRINGS];
    let stiff = [PAIRS, SPRINGS, ANGLES];
    vec![
        (scene(&[GROOT_WARREN, "space.box=[4,4,9]", CHAINS], &bonded), vec![[1, 1, 2], [1, 1, 3], [1, 1, 4]]),
        (scene(&[GROOT_WARREN, "space.box=[5,5,7]", CHAINS, FOLLOWED], &stiff), vec![[2, 2, 2], [1, 1, 3]]),
        (scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS], &bonded), vec![[1, 1, 2], [1, 1, 3], [1, 1, 4]]),
        (scene(&[SPLITTING, "space.box=[8.5,9,8.5]", RINGS, FOLLOWED], &stiff), vec![[2, 2, 2]]),
        (scene(&[STAGED, "space.box=[4,4,15]", RINGS], &stiff), vec![[1, 1, 3]]),
        (scene(&[&[PREDICTED, "space.box=[12,16]"], &BRANCHED[..]].concat(), &stiff), vec![[1, 4, 1], [4, 2, 1]]),
        (scene(&[&[COTTER_REICH, "space.box=[4,7,9]"], &BRANCHED[..]].concat(), &stiff), vec![[1, 2, 2], [1, 3, 1]]),
        (scene(&[GROOT_WARREN, "space.box=[4,7,9]", CHAINS], &[PAIRS, FENE]), vec![[1, 1, 3], [1, 2, 1]]),
        (scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS], &[MANY_BODY, SPRINGS]), vec![[1, 1, 2], [1, 1, 3]]),
        (scene(&[GROOT_WARREN, "space.box=[4,9,5]", CHAINS, r#"space.walls={"z":{}}"#], &bonded), vec![[1, 3, 1]]),
        (
            scene(&[SPLITTING, "space.box=[4,9,10]", CHAINS, r#"space.shear={"rate":1.2,"gradient":"z"}"#], &stiff),
            vec![[1, 2, 1], [1, 1, 3]],
        ),
        // Friction along bonds, in rounds that depend on each other.
        (scene(&[SPLITTING, "space.box=[4,4,19]", CHAINS], &[PAIRS, RUBBING]), vec![[1, 1, 2], [1, 1, 4]]),
        (
            scene(&[&[SPLITTING, "space.box=[9,21]"], &BRANCHED[..]].concat(), &[PAIRS, RUBBING, ANGLES]),
            vec![[2, 3, 1]],
        ),
        // Charges, which act on each other all over the box.
        (scene(&[SPLITTING, "space.box=[4,4,13]", SALT], &[PAIRS, CHARGES]), vec![[1, 1, 2], [1, 1, 4]]),
        (scene(&[STAGED, "space.box=[4,4,15]", SALT], &[PAIRS, CHARGES, EXCLUDING]), vec![[1, 1, 3]]),
        (scene(&[GROOT_WARREN, "space.box=[4,7,9]", SALT], &[PAIRS, CHARGES, EXCLUDING]), vec![[1, 2, 2]]),
        (scene(&[COTTER_REICH, "space.box=[5,5,9]", SALT, FOLLOWED], &[PAIRS, CHARGES]), vec![[1, 1, 3]]),
        (scene(&[SPLITTING, "space.box=[4,4,13]", SALT], &[LANGEVIN, CHARGES]), vec![[1, 1, 2]]),
        (scene(&[STAGED, "space.box=[4,4,15]", SALT], &[PAIRS, WAVES, EXCLUDING]), vec![[1, 1, 3]]),
        // Nothing but bonds and baths; tethers, with pairs that are visited once and twice, and with none.
        (scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS], &[LANGEVIN, SPRINGS]), vec![[1, 1, 3]]),
        (scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS], &[LANGEVIN, TETHERS, RUBBING]), vec![[1, 1, 2]]),
        (
            scene(&[SPLITTING, "space.box=[4,9]", CHAINS], &[LANGEVIN, TETHERS, r#"{"type":"dpd","repulsion":25}"#]),
            vec![[1, 4, 1]],
        ),
        (scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS], &[PAIRS, TETHERS, SPRINGS]), vec![[1, 1, 3]]),
        (
            scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS], &[r#"{"type":"dpd","repulsion":25}"#, TETHERS]),
            vec![[1, 1, 2]],
        ),
        // Steps that are not split: friction along bonds beside pairs and densities, and baths and tethers without
        // pairs.
        (scene(&[COTTER_REICH, "space.box=[4,4,13]", CHAINS], &[PAIRS, RUBBING]), vec![[1, 1, 3]]),
        (scene(&[GROOT_WARREN, "space.box=[4,4,13]", CHAINS], &[MANY_BODY, RUBBING]), vec![[1, 1, 2]]),
        (scene(&[COTTER_REICH, "space.box=[4,4,13]", CHAINS], &[LANGEVIN, TETHERS, RUBBING]), vec![[1, 1, 3]]),
    ]
}

/// What ranks give, with bonds that are expected to be longer as long as some are too long.
fn divided(scene: &Checked, parts: [u32; 3], batch: u64) -> (Bytes, u32) {
    let (_, state) = start(scene);
    // States pass in several messages.
    let mut options = Options { particles_at_once: Some(100), ..Options::default() };
    loop {
        let attempt = || -> Result<Bytes, EngineError> {
            let mut team = team(scene, Division { parts }, options, &state);
            team.advance(STEPS, batch)?;
            let (state, reported) = (team.state()?, team.reported()?);
            let samples = team.finish()?;
            // Charges without pairs act on the mesh alone: nobody has to know the particles of others.
            let particles = scene.model().particles();
            let needs_copies = particles.pair_force.is_some() || particles.bonds.is_some();
            let exchanged = |copies: u64| if needs_copies { copies > 0 } else { copies == 0 };
            assert!(team.traffic().iter().all(|traffic| traffic.exchanges >= STEPS && exchanged(traffic.copies)));
            Ok(Bytes { state, reported, samples })
        };
        match attempt() {
            Ok(bytes) => return (bytes, options.lengthened),
            Err(EngineError::Overreached { .. }) => options = options.with_longer_bonds(),
            Err(error) => panic!("{error}"),
        }
    }
}

/// Every integrator, two dimensions, angles, many-body repulsion, walls, shear, friction along bonds and tethers once.
const OFTEN: [usize; 10] = [1, 4, 5, 6, 8, 9, 10, 11, 15, 18];

#[test]
fn bonds_across_boundaries_give_the_bytes_of_one_rank() {
    compare(true);
}

#[test]
#[ignore = "minutes: the other scenes of bonds_across_boundaries_give_the_bytes_of_one_rank"]
fn bonds_across_boundaries_give_the_bytes_of_one_rank_in_other_scenes() {
    compare(false);
}

fn compare(often: bool) {
    let cases = cases().into_iter().enumerate().filter(|(number, _)| OFTEN.contains(number) == often);
    for (scene, divisions) in cases.map(|(_, case)| case).filter(|(scene, _)| fits(scene)) {
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        for (number, parts) in divisions.into_iter().enumerate() {
            let (shared, lengthened) = divided(&scene, parts, [8, 1, STEPS][number % 3]);
            assert!(same(&alone, &shared), "{} in {parts:?}", serde_json::to_string(&scene).unwrap());
            assert!(lengthened <= 1, "{lengthened}");
        }
    }
}

/// The scenes that are shipped, for some steps.
#[test]
fn shipped_scenes_give_the_bytes_of_one_rank() {
    for (name, parts) in [("polymer-melt", [1, 1, 2]), ("diblock-copolymer", [1, 2, 2]), ("surfactants", [2, 2, 1])] {
        let scene = built_in(name, &["time.equilibration=0", "output={}", EVERY_THIRD]);
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        assert!(same(&alone, &divided(&scene, parts, 8).0), "{name}");
    }
}

/// Chains are measured by the first rank, of the particles of all.
#[test]
fn chains_are_measured_as_by_one_rank() {
    let sizes = r#"output.chain_sizes={"every":4}"#;
    let radial = r#"output.radial_distribution={"every":6,"range":1.5,"bins":20}"#;
    for integrator in [SPLITTING, GROOT_WARREN] {
        let scene = scene(&[integrator, "space.box=[4,4,13]", RINGS, sizes, radial], &[PAIRS, SPRINGS]);
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        assert!([0, 1, 2].iter().all(|sampler| alone.samples.iter().any(|sample| sample.sampler == *sampler)));
        assert!(same(&alone, &divided(&scene, [1, 1, 3], 8).0), "{integrator}");
    }
}

/// What was saved by one number of ranks goes on with another.
#[test]
fn bonded_ranks_continue_from_each_others_states() {
    for (list, divisions) in [
        (vec![PAIRS, RUBBING], [[1, 1, 2], [1, 1, 3]]),
        (vec![PAIRS, SPRINGS, ANGLES, TETHERS], [[1, 1, 4], [1, 1, 2]]),
    ] {
        let scene = scene(&[SPLITTING, "space.box=[4,4,13]", CHAINS, FOLLOWED], &list);
        continues(&scene, divisions);
    }
}

/// Springs that are longer than expected: with wider halos the bytes are those of one rank, and a rank may know all of the box.
#[test]
fn long_bonds_widen_halos() {
    let springs = |more| {
        format!(
            r#"{{"type":"bonds","potential":{{"type":"harmonic","stiffness":900}},"exclude_repulsion":true{more}}}"#
        )
    };
    for (integrator, friction) in [(GROOT_WARREN, ""), (SPLITTING, r#","friction":6"#)] {
        let list = [PAIRS, &springs(friction)];
        // They start much longer than their temperature lets them become.
        let chains = r#"particles=[{"species":"A","count":240,"chain":{"beads":6,"spacing":1.9}}]"#;
        let scene = scene(&[integrator, "space.box=[4,4,12]", chains, "time.step=0.005"], &list);
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        let (shared, lengthened) = divided(&scene, [1, 1, 3], 8);
        assert!(same(&alone, &shared), "{integrator}");
        assert!(lengthened >= 2, "{lengthened}");
    }
}

/// A bond that its potential does not allow is told with the same words, however many ranks there are.
#[test]
fn impossible_bonds_are_told_as_by_one_rank() {
    let short = r#"{"type":"bonds","potential":{"type":"fene","stiffness":30,"extent":0.9}}"#;
    let scene = scene(&[GROOT_WARREN, "space.box=[4,4,9]", CHAINS, "time.step=0.08", "temperature=4"], &[PAIRS, short]);
    let (_, state) = start(&scene);
    let mut alone = crate::support::engine(&scene, &state, Options::default());
    let expected = alone.advance(400, 8).and_then(|()| alone.finish()).unwrap_err();
    let EngineError::Unstable(expected) = expected else { panic!("{expected}") };
    assert!(expected.is(mesoscope::plan::FailureKind::Bond), "{expected:?}");
    for parts in [[1, 1, 2], [1, 1, 3]] {
        let mut options = Options::default();
        let found = loop {
            let mut team = team(&scene, Division { parts }, options, &state);
            match team.advance(400, 8).and_then(|()| team.finish()).unwrap_err() {
                EngineError::Overreached { .. } if options.lengthened < 9 => options = options.with_longer_bonds(),
                EngineError::Unstable(found) => break found,
                error => panic!("{error}"),
            }
        };
        assert_eq!(found, expected);
    }
}
