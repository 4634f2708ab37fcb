//! Several ranks: the same bytes as one.

use mesoscope::engine::{Shown, Stepper as _};
use mesoscope::plan::{Division, Hardware, Options, Part, Plan, Traversal};
use mesoscope::ranks::Team;
use mesoscope::run;
use mesoscope::scene::Checked;
use mesoscope::state::State;

use crate::support::bytes::{self, Bytes, harvest, same};
use crate::support::{
    COTTER_REICH, GROOT_WARREN, MIXTURE, MIXTURE_FORCE, PREDICTED, SPLITTING, STAGED, adapter, fluid, gpu, hardware,
    start,
};

pub const STEPS: u64 = 30;
pub const EVERY_THIRD: &str = "output.energies.every=3";
const GAUSSIAN: &str = "noise.distribution=gaussian";

pub const FOLLOWED: &str = r#"output.trajectory={"every":10}"#;
/// Samples so far apart that particles cross the box between them.
const DIFFUSING: &str = r#"output.diffusion={"every":14,"window":3}"#;
const OPPOSED: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
    {"type":"body-force","force":[0.3,0,0.1],"profile":"opposed","axis":"z"}]"#;
const RADIAL: &str = r#"output.radial_distribution={"every":5,"range":2.4,"bins":40}"#;
const PARTIAL: &str = r#"output.radial_distribution.species="all-pairs""#;
const DIFFUSING_B: &str = "output.diffusion.species=B";
const OPPOSED_IN_PLANE: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
    {"type":"body-force","force":[0.3,0.1],"profile":"opposed","axis":"y"}]"#;
const COUETTE: &str = r#"space.walls={"y":{"upper_velocity":[1.5,0,0]}}"#;
const LAYERED: &str = r#"particles=[{"species":"A","number_density":3},
    {"species":"wall","number_density":3,"placement":{"type":"behind-walls","axis":"y","thickness":1}}]"#;
const POROUS: &str =
    r#"particles=[{"species":"A","number_density":2.5},{"species":"B","number_density":0.5,"fixed":true}]"#;
const BATHED: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"langevin","friction":2},
    {"type":"tether","stiffness":2}]"#;
const SHEARED: &str = r#"space.shear={"rate":1.2,"gradient":"z"}"#;
const MANY_BODY: &str = r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}]"#;

/// Scenes of every integrator, in three dimensions and two, alone and mixed, driven, between walls and sheared, with what each can be
/// divided into.
fn cases() -> Vec<(Vec<&'static str>, Vec<[u32; 3]>)> {
    vec![
        (vec![SPLITTING, "space.box=[4,4,13]"], vec![[1, 1, 2], [1, 1, 4]]),
        (vec![SPLITTING, "space.box=[8.5,9,8.5]", MIXTURE, MIXTURE_FORCE], vec![[2, 2, 2]]),
        (vec![SPLITTING, "space.box=[9,3]", GAUSSIAN], vec![[2, 1, 1]]),
        (vec![STAGED, "space.box=[4,4,15]"], vec![[1, 1, 3]]),
        (vec![GROOT_WARREN, "space.box=[5,5,9]", FOLLOWED, "temperature=9"], vec![[2, 2, 2], [1, 1, 3], [1, 2, 4]]),
        (vec![SPLITTING, "space.box=[4,4,10]", FOLLOWED, DIFFUSING, "temperature=9"], vec![[1, 1, 3]]),
        (
            vec![
                PREDICTED,
                "space.box=[12,16]",
                MIXTURE,
                MIXTURE_FORCE,
                RADIAL,
                PARTIAL,
                r#"output.clusters={"every":5,"distance":0.5,"least":2}"#,
                FOLLOWED,
                DIFFUSING,
                DIFFUSING_B,
                "temperature=9",
            ],
            vec![[1, 4, 1], [4, 2, 1]],
        ),
        (vec![SPLITTING, "space.box=[4,4,13]", OPPOSED], vec![[1, 1, 3]]),
        (vec![GROOT_WARREN, "space.box=[4,7,9]", OPPOSED, COUETTE], vec![[1, 2, 1], [1, 2, 3]]),
        (vec![SPLITTING, "space.box=[6,5,9]", COUETTE], vec![[1, 1, 2]]),
        (vec![STAGED, "space.box=[4,4,13]", COUETTE, LAYERED], vec![[1, 1, 2]]),
        (vec![PREDICTED, "space.box=[4,5,9]", COUETTE, LAYERED], vec![[1, 2, 1], [1, 3, 2]]),
        (vec![SPLITTING, "space.box=[4,9,10]", SHEARED], vec![[1, 2, 1], [1, 1, 3]]),
        (vec![PREDICTED, "space.box=[5,6,6]", SHEARED, MIXTURE, MIXTURE_FORCE], vec![[1, 2, 2]]),
        (vec![GROOT_WARREN, "space.box=[4,4,9]", MANY_BODY], vec![[1, 1, 2]]),
        (vec![COTTER_REICH, "space.box=[4,7,9]", MIXTURE, MIXTURE_FORCE, GAUSSIAN], vec![[1, 2, 2], [1, 3, 1]]),
        (vec![STAGED, "space.box=[4,4,13]", POROUS], vec![[1, 1, 2], [1, 1, 3]]),
        (vec![COTTER_REICH, "space.box=[4,4,13]", MIXTURE, BATHED, FOLLOWED, "temperature=9"], vec![[1, 1, 2]]),
        (vec![PREDICTED, "space.box=[4,7,9]", POROUS, COUETTE, MANY_BODY], vec![[1, 2, 1]]),
    ]
}

fn scene(changes: &[&str]) -> Checked {
    fluid(&[&["time.steps=1000", EVERY_THIRD], changes].concat())
}

pub fn team(scene: &Checked, division: Division, options: Options, state: &State) -> Team<'static> {
    run::team(scene, gpu(), &adapter(), division, options, state).expect("ranks")
}

fn divided(scene: &Checked, parts: [u32; 3], batch: u64, options: Options) -> Bytes {
    let (_, state) = start(scene);
    let options = Options { particles_at_once: (batch == 1).then_some(100), ..options };
    let mut team = team(scene, Division { parts }, options, &state);
    team.advance(STEPS, batch).unwrap();
    assert!(team.traffic().iter().all(|traffic| traffic.exchanges >= STEPS && traffic.copies > 0));
    harvest(team, Vec::new())
}

/// Whether the device of the tests takes the plan of a rank: with walls or shear, plans for any GPU need more buffers.
pub fn fits(scene: &Checked) -> bool {
    let part = Some(Part { division: Division { parts: [2, 1, 1] }, rank: 0 });
    let options = Options { part, ..Options::default() };
    let plan = run::plan(scene, hardware(), options);
    plan.storage_buffers <= gpu().device().limits().max_storage_buffers_per_shader_stage
}

/// Compares ranks with one, in the cases with these numbers; how many scenes the adapter takes.
fn compare(numbers: &[usize]) -> usize {
    let cases = cases();
    let mut compared = 0;
    for (changes, divisions) in numbers.iter().map(|number| &cases[*number]) {
        let scene = scene(changes);
        if !fits(&scene) {
            continue;
        }
        compared += 1;
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        let followed = changes.contains(&FOLLOWED);
        assert_eq!(followed, alone.state.images.iter().flatten().filter(|image| **image != 0).count() > 9);
        for (number, parts) in divisions.iter().enumerate() {
            let batch = [8, 1, STEPS][number % 3];
            assert!(same(&alone, &divided(&scene, *parts, batch, Options::default())), "{changes:?} in {parts:?}");
        }
    }
    compared
}

/// Every integrator, two dimensions, diffusion, forces, walls, layers, shear, many-body repulsion and fixed particles once.
#[test]
fn any_number_of_ranks_gives_the_bytes_of_one() {
    // Those without walls and shear at least.
    assert!(compare(&[0, 3, 5, 6, 8, 11, 12, 14, 16, 17]) >= 7);
}

#[test]
#[ignore = "minutes: the other scenes of any_number_of_ranks_gives_the_bytes_of_one"]
fn any_number_of_ranks_gives_the_bytes_of_one_in_other_scenes() {
    assert!(compare(&[1, 2, 4, 7, 9, 10, 13, 15, 18]) >= 5);
}

/// Pairs are visited particle by particle, as on graphics cards.
fn by_particles() -> Options {
    Options { traversal: Some(Traversal::Rows), ..Options::default() }
}

/// The plan of the last rank, on any adapter.
fn plan_of_part(scene: &Checked, parts: [u32; 3], options: Options) -> Plan {
    let division = Division { parts };
    let part = Some(Part { division, rank: division.ranks() - 1 });
    run::plan(scene, Hardware::default(), Options { part, ..options })
}

/// The first rank measures the particles of all, which are more than it has room for in its own part.
#[test]
fn all_particles_are_measured_by_the_first_of_many_ranks() {
    let measured = r#"output={"energies":{"every":3},"diffusion":{"every":2,"window":3},"viscosity":{"every":3,"window":8},
        "chain_sizes":{"every":5}}"#;
    let chains = r#"particles=[{"species":"A","count":6000,"chain":{"beads":3,"spacing":0.5}}]"#;
    let bonds = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"bonds","potential":{"type":"harmonic","stiffness":20,"length":0.5}}]"#;
    let parts = [1, 1, 6];
    for integrator in [SPLITTING, COTTER_REICH] {
        let scene = scene(&[integrator, "space.box=[4,4,125]", chains, bonds, measured]);
        let plan = plan_of_part(&scene, parts, Options::default());
        assert!(plan.part.unwrap().slots < 5000);
        let (_, state) = start(&scene);
        let alone = bytes::run(&scene, Options::default(), 6, 6);
        let mut team = team(&scene, Division { parts }, Options::default().with_longer_bonds(), &state);
        team.advance(6, 6).unwrap();
        assert!(same(&alone, &harvest(team, Vec::new())), "{integrator}");
    }
}

/// Whether a rank goes on while particles are exchanged.
fn overlaps(plan: &Plan) -> bool {
    let Some(part) = &plan.part else { return false };
    let overlaps = part.passages.iter().any(|passage| passage.after != passage.until);
    assert_eq!(overlaps, part.overlapped > 0.0, "{part:?}");
    overlaps
}

/// Scenes whose parts have inner cells, with a division: in layers and in columns, cut across the rows of cells and between them.
fn overlapping() -> Vec<(Vec<&'static str>, [u32; 3])> {
    vec![
        (vec![GROOT_WARREN, "space.box=[4,4,14]", FOLLOWED, "temperature=9"], [1, 1, 2]),
        (vec![PREDICTED, "space.box=[14,22]", MIXTURE, MIXTURE_FORCE], [2, 3, 1]),
        (vec![PREDICTED, "space.box=[4,17,5]", COUETTE, LAYERED], [1, 2, 1]),
        (vec![SPLITTING, "space.box=[4,5,21]", SHEARED], [1, 1, 2]),
        // Its samples look further than its forces reach, at some steps; and no face of a part is one of cells, as those that are looked
        // at too early would be known there by chance.
        (vec![SPLITTING, "space.box=[5,5,20.5]", RADIAL], [1, 1, 2]),
        (vec![GROOT_WARREN, "space.box=[5,5,20.5]", RADIAL], [1, 1, 2]),
        (vec![SPLITTING, "space.box=[4,4,20]", FOLLOWED, "temperature=9"], [1, 1, 2]),
        (vec![STAGED, "space.box=[4,3.5,25]", MIXTURE, MIXTURE_FORCE, GAUSSIAN], [1, 1, 2]),
        (vec![COTTER_REICH, "space.box=[14,4,15]"], [2, 1, 2]),
        (vec![SPLITTING, "space.box=[17,17]", OPPOSED_IN_PLANE], [2, 2, 1]),
        (vec![GROOT_WARREN, "space.box=[4,19,3]", MANY_BODY], [1, 2, 1]),
        (vec![SPLITTING, "space.box=[4,5,22]", COUETTE], [1, 1, 2]),
    ]
}

/// Of scenes in which the device goes on with inner cells while particles are exchanged, with reports in between and without: how many
/// the adapter takes.
fn compare_overlapping(cases: &[(Vec<&str>, [u32; 3])]) -> usize {
    let mut compared = 0;
    for (number, (changes, parts)) in cases.iter().enumerate() {
        let scene = scene(changes);
        assert!(overlaps(&plan_of_part(&scene, *parts, by_particles())), "{changes:?}");
        if !fits(&scene) {
            continue;
        }
        compared += 1;
        // On lavapipe another traversal.
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        let batch = [8, 1, STEPS][number % 3];
        assert!(same(&alone, &divided(&scene, *parts, batch, by_particles())), "{changes:?} in {parts:?}");
    }
    compared
}

#[test]
fn exchanges_during_a_step_give_the_bytes_of_one_rank() {
    assert!(compare_overlapping(&overlapping()[..5]) >= 3);
}

#[test]
#[ignore = "minutes: the other scenes of exchanges_during_a_step_give_the_bytes_of_one_rank"]
fn exchanges_during_a_step_give_the_bytes_of_one_rank_in_other_scenes() {
    assert!(compare_overlapping(&overlapping()[5..]) >= 5);
}

/// All else is exchanged between two kernels: of narrow parts, with bonds, with tethers, whose impulses copies gather
/// too, and where eight particles are visited together. Alone a rank has nobody to wait for.
#[test]
fn exchanges_overlap_where_there_is_something_to_do() {
    const WIDE: &str = "space.box=[4,4,20]";
    let plan =
        |changes: &[&str], parts, options| plan_of_part(&scene(&[&[SPLITTING], changes].concat()), parts, options);
    let wide = plan(&[WIDE], [1, 1, 2], by_particles());
    assert!(overlaps(&wide));
    // Ten layers of four rows, and one on either side that rounding may touch; of these two inner ones, which both turns look at.
    let workgroups = |name: &str| wide.kernels.iter().find(|kernel| kernel.name == name).unwrap().workgroups;
    assert_eq!([workgroups("relax_edges"), workgroups("relax_inner")], [4 * 12, 4 * 2]);
    let clusters = Options { traversal: Some(Traversal::Clusters), ..Options::default() };
    let bonds = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"bonds","potential":{"type":"harmonic","stiffness":50,"length":0.6}}]"#;
    let chains = r#"particles=[{"species":"A","count":240,"chain":{"beads":6,"spacing":0.6}}]"#;
    for (changes, parts, options) in [
        (vec!["space.box=[4,4,13]"], [1, 1, 2], by_particles()),
        (vec![WIDE], [1, 1, 2], clusters),
        (vec![WIDE, bonds, chains], [1, 1, 2], by_particles()),
        (vec![WIDE, BATHED], [1, 1, 2], by_particles()),
        (vec![WIDE], [1, 1, 1], by_particles()),
    ] {
        assert!(!overlaps(&plan(&changes, parts, options)), "{changes:?}");
    }
}

/// That what was saved by ranks of one division goes on with the bytes of one rank, by ranks of another and alone.
#[track_caller]
pub fn continues(scene: &Checked, [first, second]: [[u32; 3]; 2]) {
    const FIRST: u64 = 11;
    let alone = bytes::run(scene, Options::default(), STEPS, 8);
    let (_, state) = start(scene);
    let mut before = team(scene, Division { parts: first }, Options::default(), &state);
    before.advance(FIRST, 4).unwrap();
    let kept = before.state().unwrap();
    let mut samples = before.finish().unwrap();
    samples.retain(|sample| sample.step < FIRST);
    let mut after = team(scene, Division { parts: second }, Options::default(), &kept);
    after.advance(STEPS - FIRST, 8).unwrap();
    assert!(same(&alone, &harvest(after, samples.clone())), "by ranks");
    let mut after = crate::support::engine(scene, &kept, Options::default());
    after.advance(STEPS - FIRST, 8).unwrap();
    assert!(same(&alone, &harvest(after, samples)), "alone");
}

#[test]
fn ranks_continue_from_each_others_states() {
    for (changes, divisions) in [
        (vec![SPLITTING, "space.box=[4,4,13]"], [[1, 1, 2], [1, 1, 3]]),
        (vec![PREDICTED, "space.box=[12,16]", MIXTURE, MIXTURE_FORCE], [[1, 4, 1], [2, 1, 1]]),
    ] {
        continues(&scene(&changes), divisions);
    }
}

/// Distances of pairs are counted once, though several ranks know of a pair.
#[test]
fn pairs_are_counted_once() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let scene = scene(&[integrator, "space.box=[5,5,16]", RADIAL]);
        let alone = bytes::run(&scene, Options::default(), STEPS, 8);
        assert!(alone.samples.iter().any(|sample| sample.sampler == 1 && sample.sums.iter().sum::<i64>() > 1000));
        assert!(same(&alone, &divided(&scene, [1, 1, 3], 8, Options::default())), "{integrator}");
    }
}

/// Ranks tell each other of what lies within the range of distances only where these are counted, and however far beyond the next part it
/// is.
#[test]
fn ranks_know_more_at_the_steps_at_which_distances_are_counted() {
    let shared = |scene: &Checked| {
        let (_, state) = start(scene);
        let mut team = team(scene, Division { parts: [1, 1, 6] }, Options::default(), &state);
        team.advance(STEPS, 8).unwrap();
        let sent = team.traffic().iter().map(|traffic| traffic.bytes).sum::<u64>();
        (sent as f64, harvest(team, Vec::new()))
    };
    // Exchanges with a halo of one cutoff or two and with one of the range, 3.5: one a step of the first integrator; of the second also one
    // in each report, of which energies ask for one every three steps.
    for (integrator, rarely, always) in
        [(GROOT_WARREN, 27.0 + 3.0 * 3.5, 30.0 * 3.5), (SPLITTING, 39.0 * 2.0 + 3.0 * 3.5, 30.0 * 2.0 + 30.0 * 3.5)]
    {
        let counting = |every: u64| {
            let radial = format!(r#"output.radial_distribution={{"every":{every},"range":3.5,"bins":35}}"#);
            scene(&[integrator, "space.box=[7,7,20]", &radial])
        };
        let (sent, found) = shared(&counting(10));
        assert!(same(&bytes::run(&counting(10), Options::default(), STEPS, 8), &found), "{integrator}");
        // Some 1 800 h copies in all, of positions that are random at first: 2.4 % in a single exchange.
        let ratio = sent / shared(&counting(1)).0;
        assert!((ratio / (rarely / always) - 1.0).abs() < 0.05, "{integrator}: {ratio}");
    }
}

/// A picture of a sample shows the same particles on any number of ranks, in whatever messages they pass.
#[test]
fn any_number_of_ranks_shows_the_same_sample() {
    for (integrator, parts, particles_at_once) in [(GROOT_WARREN, [1, 1, 2], None), (SPLITTING, [1, 1, 3], Some(100))] {
        let scene = scene(&[integrator, "space.box=[5,5,16]", MIXTURE, MIXTURE_FORCE]);
        let (_, state) = start(&scene);
        let mut alone = crate::support::engine(&scene, &state, Options::default());
        alone.advance(STEPS, 8).unwrap();
        let shown = alone.shown(300).unwrap();
        let species = |kind: u32| shown.state.species.iter().filter(|species| **species == kind).count();
        // 300 of 1 200, one in three of the second kind, within five standard deviations.
        assert!(shown.state.len().abs_diff(300) < 75 && species(1).abs_diff(100) < 45, "{}", shown.state.len());
        let options = Options { particles_at_once, ..Options::default() };
        let mut team = team(&scene, Division { parts }, options, &state);
        team.advance(STEPS, 8).unwrap();
        assert!(team.shown(300).unwrap() == shown, "{integrator} in {parts:?}");
        assert_eq!(team.shown(1200).unwrap(), Shown::all(alone.reported().unwrap()));
    }
}

/// A run that fails does so at the same step with the same words, however many ranks it has; the ranks can begin again.
#[test]
fn failures_are_those_of_one_rank() {
    let scene = scene(&[GROOT_WARREN, "space.box=[4,4,14]", "time.step=0.16"]);
    let (_, state) = start(&scene);
    let mut alone = crate::support::engine(&scene, &state, Options::default());
    let expected = alone.advance(200, 8).and_then(|()| alone.finish()).unwrap_err().to_string();
    assert!(expected.contains("unstable at step"), "{expected}");
    assert!(overlaps(&plan_of_part(&scene, [1, 1, 2], by_particles())));
    for (parts, options) in [([1, 1, 3], Options::default()), ([1, 1, 2], by_particles())] {
        let mut team = team(&scene, Division { parts }, options, &state);
        let found = team.advance(200, 8).and_then(|()| team.finish()).unwrap_err().to_string();
        assert_eq!(found, expected);
        assert!(team.advance(1, 1).is_err(), "what has failed does not go on");
    }
}
