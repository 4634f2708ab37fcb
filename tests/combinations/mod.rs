//! All pairs of features: two that go together run as the reference does, and on two ranks with the bytes of one; two
//! that do not are refused, with the reason of the table.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use mesoscope::engine::{EngineError, Stepper as _};
use mesoscope::families::combinations::{
    Feature::{self, *},
    REFUSALS, Reason,
};
use mesoscope::plan::{Division, Options};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand::seq::SliceRandom;
use serde_json::{Value, json};

use crate::determinism::ranks::{fits, team};
use crate::support::bytes::{self, Bytes, same};
use crate::support::{SideBySide, gpu, hardware, start};

const STEPS: u64 = 4;

/// Features of which a scene has one at most, as they are values of one key; the harmonic chain is a scene by itself.
fn are_alternatives(features: [Feature; 2]) -> bool {
    const VALUES: [&[Feature]; 5] = [
        &[Pairs, PairsWithMemory],
        &[Langevin, LangevinWithMemory],
        &[UniformForce, VaryingForce],
        &[Splitting, GrootWarren, CotterReich],
        &[State, Molecules],
    ];
    features.contains(&HarmonicChain) || VALUES.iter().any(|values| features.iter().all(|one| values.contains(one)))
}

/// A scene with these features.
fn scene_with(features: &BTreeSet<Feature>) -> Value {
    let has = |feature: Feature| features.contains(&feature);
    let any = |some: &[Feature]| some.iter().any(|feature| has(*feature));
    let line = has(Line);
    let chained = any(&[Bonds, FrictionOfBonds, MemoryOfBonds, Exclusion, Angles, ChainSizes]);
    let across = if line { "x" } else { "y" };
    // Of a length that two ranks can divide, with three particles in a unit of volume.
    let lengths = if line { json!([60]) } else { json!([4, 5, 13]) };
    let count = if line { 90 } else { 390 };
    let memory = json!({"type": "memory", "rate": 3});
    let first = if line { [0.4, 0.0, 0.0] } else { [0.4, 0.0, 0.3] };
    let force = &first[..if line { 1 } else { 3 }];

    let mut interactions = Vec::new();
    if any(&[Pairs, PairsWithMemory, SeveralPairForces, ManyBody, Exclusion]) {
        let mut pairs = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
        if has(PairsWithMemory) {
            pairs["bath"] = memory.clone();
        }
        if has(ManyBody) {
            pairs["many_body"] = json!({"repulsion": 10});
        }
        interactions.push(pairs);
    }
    if has(SeveralPairForces) {
        interactions.push(json!({"type": "dpd", "repulsion": -6, "cutoff": 0.8}));
    }
    if has(Langevin) {
        interactions.push(json!({"type": "langevin", "friction": 1.5}));
    }
    if has(LangevinWithMemory) {
        interactions.push(json!({"type": "langevin", "friction": 1.5, "bath": memory}));
    }
    if has(ColouredNoise) {
        interactions.push(json!({"type": "coloured-noise", "strength": 1, "time": 0.1}));
    }
    let bonds = |own: Value| {
        let mut bonds = json!({"type": "bonds"});
        if !has(Molecules) {
            bonds["species"] = json!(["A"]);
        }
        bonds.as_object_mut().unwrap().extend(own.as_object().unwrap().clone());
        bonds
    };
    // Molecules are what bonds join.
    if any(&[Bonds, Exclusion]) || has(ChainSizes) && has(Molecules) {
        let mut own = json!({"potential": {"type": "harmonic", "stiffness": 20, "length": 0.5}});
        if has(Exclusion) {
            own["exclude_repulsion"] = json!(true);
        }
        if has(Electrostatics) {
            own["exclude_charges"] = json!(true);
        }
        interactions.push(bonds(own));
    }
    if has(FrictionOfBonds) {
        interactions.push(bonds(json!({"friction": 2})));
    }
    if has(MemoryOfBonds) {
        interactions.push(bonds(json!({"friction": 2, "bath": memory})));
    }
    if has(Angles) {
        let mut angles = json!({"type": "angles", "stiffness": 3});
        if !has(Molecules) {
            angles["species"] = json!(["A"]);
        }
        interactions.push(angles);
    }
    if has(Tethers) {
        interactions.push(json!({"type": "tether", "stiffness": 4}));
    }
    if has(Electrostatics) {
        // Molecules have as many of one charge as of the other only by chance.
        interactions.push(json!({"type": "electrostatics", "bjerrum_length": 1.1, "background": true}));
    }
    if has(UniformForce) {
        interactions.push(json!({"type": "body-force", "force": force}));
    }
    if has(VaryingForce) {
        let along = if line { "x" } else { "z" };
        interactions.push(json!({"type": "body-force", "force": force, "profile": "sinusoidal", "axis": along}));
    }
    if has(HarmonicChain) {
        let pulse = json!({"amplitude": 0, "width": 1});
        interactions.push(json!({
            "type": "harmonic-chain", "chains": 1, "clusters": 4, "cluster_size": 4, "stiffness": 10, "spacing": 1,
            "pulse": pulse,
        }));
    }

    let mut groups = vec![json!({"species": "A"}), json!({"species": "B", "mass": 2})];
    if !has(Molecules) {
        for group in &mut groups {
            group["count"] = json!(count);
        }
        if chained {
            groups[0]["chain"] = json!({"beads": 3, "spacing": 0.5});
        }
    }
    if has(Electrostatics) {
        groups[0]["charge"] = json!(-1);
        groups[1]["charge"] = json!(1.5);
    }
    if has(FixedParticles) {
        groups[1]["fixed"] = json!(true);
    }
    if has(Layers) {
        let placement = json!({"type": "behind-walls", "axis": across, "thickness": 1});
        groups.push(json!({"species": "W", "number_density": 3, "placement": placement}));
    }

    let mut output = json!({"energies": {"every": 1}});
    let analyses = [
        (RadialDistribution, "radial_distribution", json!({"every": 2, "range": 1.5, "bins": 10})),
        (StructureFactor, "structure_factor", json!({"every": 2, "range": 9, "bins": 5, "vectors": 2})),
        (Clusters, "clusters", json!({"every": 2, "distance": 0.5})),
        (Diffusion, "diffusion", json!({"every": 1, "window": 2})),
        (ChainSizes, "chain_sizes", json!({"every": 2})),
        (Viscosity, "viscosity", json!({"every": 1, "window": 8})),
        (Autocorrelations, "autocorrelations", json!([{"quantity": "velocity", "every": 1, "window": 2}])),
        (Histograms, "histograms", json!([{"quantity": "velocity", "every": 2}])),
        (Stress, "stress", json!({"every": 1})),
        (StressWindow, "stress", json!({"every": 1, "window": 2})),
        (Profiles, "profiles", json!({"axis": across, "every": 2, "bins": 5})),
        (StressProfiles, "profiles", json!({"axis": across, "every": 2, "bins": 5, "quantities": ["stress"]})),
    ];
    for (feature, key, value) in analyses {
        if has(feature) {
            output[key] = value;
        }
    }

    let mut scene = json!({
        "title": "two features", "space": {"box": lengths}, "time": {"step": 0.01, "steps": 1000}, "temperature": 1,
        "particles": groups, "interactions": interactions, "output": output,
    });
    if has(Walls) {
        scene["space"]["walls"] = json!({across: {}});
    }
    if has(Shear) {
        scene["space"]["shear"] = json!({"rate": 0.7, "gradient": "y"});
    }
    if has(Molecules) {
        // Beads at a distance of the cutoff, the default, would interact in one implementation and not in the other.
        let molecule = json!({
            "beads": ["A", "A", "A"], "bonds": [[0, 1], [1, 2]], "angles": [[0, 1, 2]], "count": count / 3,
            "spacing": 0.6,
        });
        scene["molecules"] = json!([molecule, {"beads": ["B"], "count": count}]);
    }
    for (feature, name) in [(Splitting, "splitting"), (GrootWarren, "groot-warren"), (CotterReich, "cotter-reich")] {
        if has(feature) {
            scene["integrator"] = json!({"type": name});
        }
    }
    scene
}

/// What became of a pair.
#[derive(Debug, PartialEq)]
enum Outcome {
    Compared,
    Refused,
    TooLarge,
}

/// Two features with those that they need.
fn with_needed(pair: [Feature; 2]) -> BTreeSet<Feature> {
    pair.iter().flat_map(|feature| feature.requires().iter().copied().chain([*feature])).collect()
}

/// Runs two features together, unless the adapter has too few storage buffers for them, or finds the mistake that names
/// the reason why they do not go together.
fn compare(pair: [Feature; 2]) -> Outcome {
    let features = with_needed(pair);
    let text = scene_with(&features).to_string();
    let refusals: Vec<_> = features
        .iter()
        .flat_map(|feature| features.range(feature..).filter_map(|other| feature.refusal(*other)))
        .collect();
    let scene = match scene::parse("test", &text, &[]) {
        Ok(scene) => scene,
        Err(error) => {
            let error = error.to_string();
            assert!(!refusals.is_empty(), "{pair:?} is refused, and no table says why: {error}");
            for refusal in refusals {
                assert!(error.contains(&format!("({})", refusal.reason)), "{pair:?}: {error}");
            }
            return Outcome::Refused;
        }
    };
    assert!(refusals.is_empty(), "{pair:?} is accepted, and the table says {refusals:?}");
    for feature in &features {
        assert!(feature.place(&scene).is_some(), "{feature:?} is not in the scene of {pair:?}");
    }
    let (model, state) = start(&scene);
    let plan = run::plan(&scene, hardware(), Options::default());
    if plan.storage_buffers > gpu().device().limits().max_storage_buffers_per_shader_stage {
        return Outcome::TooLarge;
    }
    let mut both = SideBySide::new(scene.clone(), model.clone(), &state, Options::default());
    both.steps(3, 200, &format!("{pair:?}"), |_, found, _| {
        if model.conserves_momentum() {
            assert_eq!(found.total_momentum(), state.total_momentum(), "{pair:?}");
        }
    });
    both.energies(&format!("{pair:?}"));
    let shared = features.iter().all(|feature| Ranks.refusal(*feature).is_none());
    if shared && fits(&scene) {
        let alone = bytes::run(&scene, Options::default(), STEPS, STEPS);
        assert!(same(&alone, &divided(&scene)), "{pair:?} on two ranks");
    }
    Outcome::Compared
}

/// What two ranks give, with bonds that are expected to be longer as long as some are too long.
fn divided(scene: &Checked) -> Bytes {
    let (_, state) = start(scene);
    let mut options = Options::default();
    loop {
        let attempt = || -> Result<Bytes, EngineError> {
            let mut team = team(scene, Division { parts: [1, 1, 2] }, options, &state);
            team.advance(STEPS, STEPS)?;
            let (state, reported) = (team.state()?, team.reported()?);
            Ok(Bytes { state, reported, samples: team.finish()? })
        };
        match attempt() {
            Ok(bytes) => return bytes,
            Err(EngineError::Overreached { .. }) => options = options.with_longer_bonds(),
            Err(error) => panic!("{error}"),
        }
    }
}

/// All pairs but alternatives, in a random order.
fn pairs() -> Vec<[Feature; 2]> {
    let mut pairs = Vec::new();
    let features: Vec<Feature> =
        Feature::ALL.iter().copied().filter(|feature| ![Ranks, State].contains(feature)).collect();
    for (index, first) in features.iter().enumerate() {
        pairs.extend(features[..index].iter().map(|second| [*second, *first]).filter(|pair| !are_alternatives(*pair)));
    }
    pairs.shuffle(&mut StdRng::seed_from_u64(46));
    pairs
}

/// Parts of the pairs that are each a test.
const PARTS: usize = 12;

fn compare_part(part: usize) {
    let mut failed = Vec::new();
    let mut outcomes = Vec::new();
    for pair in pairs().into_iter().skip(part).step_by(PARTS) {
        match std::panic::catch_unwind(|| compare(pair)) {
            Ok(outcome) => outcomes.push(outcome),
            Err(panic) => failed.push(panic.downcast_ref::<String>().cloned().unwrap_or_else(|| format!("{pair:?}"))),
        }
    }
    assert!(failed.is_empty(), "{} pairs fail:\n{}", failed.len(), failed.join("\n"));
    let number = |wanted: Outcome| outcomes.iter().filter(|outcome| **outcome == wanted).count();
    assert!(number(Outcome::Compared) > 25 && number(Outcome::TooLarge) < 10, "{outcomes:?}");
}

macro_rules! parts {
    ($($(#[$ignored:meta])? $name:ident $part:literal)*) => {
        $(#[test] $(#[$ignored])? fn $name() { compare_part($part); })*
    };
}

parts! {
    pairs_of_features_0 0
    pairs_of_features_1 1
    pairs_of_features_2 2
    pairs_of_features_3 3
    #[ignore = "minutes: other pairs"] pairs_of_features_4 4
    #[ignore = "minutes: other pairs"] pairs_of_features_5 5
    #[ignore = "minutes: other pairs"] pairs_of_features_6 6
    #[ignore = "minutes: other pairs"] pairs_of_features_7 7
    #[ignore = "minutes: other pairs"] pairs_of_features_8 8
    #[ignore = "minutes: other pairs"] pairs_of_features_9 9
    #[ignore = "minutes: other pairs"] pairs_of_features_10 10
    #[ignore = "minutes: other pairs"] pairs_of_features_11 11
}

/// Of two refusals of the same pair one would never be read.
#[test]
fn every_pair_is_refused_once() {
    let mut seen = BTreeSet::new();
    for refusal in REFUSALS {
        for other in refusal.others {
            let pair = [refusal.feature.min(*other), refusal.feature.max(*other)];
            assert!(pair[0] != pair[1] && seen.insert(pair), "{pair:?}");
        }
    }
    assert!(REFUSALS.iter().filter(|refusal| refusal.reason.is_missing()).count() <= 15);
}

/// The page of the documentation.
fn page() -> String {
    let mut text = "\
# What goes together

Everything that a scene of particles can have goes with everything else, but for the pairs in these two tables;
`check` names the mistake and the reason. This page is made from the table of the program
(`src/families/particles/combinations.rs`) by `MESOSCOPE_RECORD=1 cargo test --test library combinations`. Tests run
all other pairs, but for starts from a file, beside the float64 reference and, where ranks can share them, on two ranks.

"
    .to_owned();
    for (missing, heading, column) in
        [(true, "Not implemented", "What is missing"), (false, "Without a meaning", "Why")]
    {
        writeln!(text, "## {heading}\n\n| | does not go with | {column} |\n|---|---|---|").unwrap();
        for refusal in REFUSALS.iter().filter(|refusal| refusal.reason.is_missing() == missing) {
            let others: Vec<&str> = refusal.others.iter().map(|other| other.name()).collect();
            let (Reason::Physics(why) | Reason::NotImplemented(why)) = refusal.reason;
            writeln!(text, "| {} | {} | {why} |", refusal.feature.name(), others.join(", ")).unwrap();
        }
        text.push('\n');
    }
    let columns = [Walls, Layers, Shear, ManyBody, Splitting, GrootWarren, CotterReich, Ranks];
    let heads: Vec<&str> = columns.iter().map(|column| column.name()).collect();
    writeln!(text, "## At a glance\n\n✓ goes together; ○ is not implemented; – has no meaning.\n").unwrap();
    writeln!(text, "| | {} |\n|---|{}", heads.join(" | "), ":-:|".repeat(columns.len())).unwrap();
    for row in Feature::ALL.iter().copied().filter(|row| !columns.contains(row) && *row != HarmonicChain) {
        write!(text, "| {} |", row.name()).unwrap();
        for column in columns {
            let features = with_needed([row, column]);
            let refusals = features.iter().flat_map(|one| features.range(one..).filter_map(|two| one.refusal(*two)));
            let cell = match refusals.map(|refusal| refusal.reason.is_missing()).min() {
                None => "✓",
                Some(false) => "–",
                Some(true) => "○",
            };
            write!(text, " {cell} |").unwrap();
        }
        text.push('\n');
    }
    text
}

#[test]
fn the_page_of_the_documentation_is_made_from_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/combinations.md");
    if std::env::var_os("MESOSCOPE_RECORD").is_some() {
        std::fs::write(&path, page()).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(written == page(), "docs/combinations.md is not that of the table: MESOSCOPE_RECORD=1 writes it");
}
