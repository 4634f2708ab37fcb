//! Wrong scenes with bonds, angles, baths, tethers and fixed particles: each mistake names the place, what was found and what
//! is accepted; and time steps that cannot be stable, before a run finds out.

use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const CHAINS: Correct = Correct(base);

/// Chains in solvent.
fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [
            {"species": "polymer", "count": 100, "chain": {"beads": 10, "spacing": 0.8}},
            {"species": "water", "count": 300},
        ],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.8}},
            {"type": "angles", "stiffness": 2},
        ],
    })
}

const LINE: &str = "space.box=[100]";

#[test]
fn the_base_is_right_and_has_nothing_to_be_warned_of() {
    assert_eq!(CHAINS.warnings(&[]), Vec::<String>::new());
}

#[test]
fn scenes_of_couplings_have_an_integrator_of_their_own() {
    use mesoscope::scene::Integrator;
    let integrator =
        |overrides: &[&str]| CHAINS.parse(overrides).unwrap().system.particle_integrator().unwrap().clone();
    // Bonds and angles without a bath are no couplings of their own, and beside pairs what remembers nothing is none.
    for beside in [&[][..], &["interactions.1.friction=1"], &[r#"interactions.2={"type":"langevin","friction":1}"#]] {
        assert!(matches!(integrator(beside), Integrator::Splitting { relaxation: Some(_) }), "{beside:?}");
    }
    let alone = r#"interactions=[{"type":"bonds","friction":1}]"#;
    let memory = r#"interactions.1.bath={"type":"memory","rate":2}"#;
    assert_eq!(integrator(&[alone]), Integrator::CotterReich {});
    assert_eq!(integrator(&["interactions.1.friction=1", memory]), Integrator::CotterReich {});
    let fluid = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5}]"#;
    assert!(matches!(integrator(&[fluid]), Integrator::Splitting { relaxation: Some(_) }));
    assert_eq!(integrator(&[fluid, LINE]), Integrator::CotterReich {});
    assert_eq!(integrator(&[fluid, "particles.1.fixed=true"]), Integrator::CotterReich {});
}

#[test]
fn chains() {
    CHAINS.refused_with(
        &["particles.0.count=105"],
        &["particles[0].count: found 105; accepted: a multiple of 10, the beads of a chain: 100 or 110, say"],
    );
    CHAINS.refused_with(&["particles.0.count=7"], &["accepted: a multiple of 10, the beads of a chain: 10, say"]);
    CHAINS.refused_with(
        &[
            r#"particles.1={"species":"ring","chain":{"beads":3},"placement":{"type":"listed","positions":[[1,1,1],[2,2,2]]}}"#,
        ],
        &["particles[1].placement.positions: found a list of 2; accepted: a multiple of 3"],
    );
    CHAINS.refused_with(
        &["particles.0.chain.spacing=6"],
        &["particles[0].chain.spacing: found 6; accepted: at most 5, half the shortest box edge"],
    );
    CHAINS.refused_with(&["particles.0.chain.beads=1"], &["particles[0].chain.beads: found 1"]);
    let loose = CHAINS.warnings(&[r#"interactions=[{"type":"angles","stiffness":2}]"#]);
    assert_eq!(loose.len(), 1, "{loose:?}");
    assert!(
        loose[0].starts_with("particles[0].chain: no interaction `bonds` holds these chains together"),
        "{loose:?}"
    );
}

#[test]
fn names_and_numbers() {
    CHAINS.refused_with(
        &[r#"interactions.1.species=["polimer"]"#],
        &[
            "interactions[1].species[0]: found \"polimer\"; did you mean `polymer`?",
            "accepted: a species of some particle group: polymer, water",
        ],
    );
    CHAINS.refused_with(
        &[r#"interactions.1.species=["water"]"#],
        &[
            "interactions[1]: found no chains of these species; accepted: `pairs` of particle ids, or particles with a `chain`",
        ],
    );
    CHAINS.refused_with(
        &["interactions.1.pairs=[[2,400]]"],
        &["interactions[1].pairs[0][1]: found 400; accepted: a particle id from 0 to 399"],
    );
    CHAINS.refused_with(
        &["interactions.1.pairs=[[0,1],[3,3]]"],
        &["interactions[1].pairs[1]: found [3, 3]; accepted: particles that are all different"],
    );
    CHAINS.refused_with(
        &["interactions.1.pairs=[[0,1],[2,3],[1,0]]"],
        &["interactions[1].pairs[2]: pairs[0] lists the same particles; accepted: each of the pairs once"],
    );
    CHAINS.refused_with(
        &["interactions.2.triples=[[0,1,2],[4,5,4]]"],
        &["interactions[2].triples[1]: found [4, 5, 4]; accepted: particles that are all different"],
    );
    CHAINS.refused_with(
        &["interactions.1.pairs=[[0,1]]", r#"interactions.1.species=["polymer"]"#],
        &["interactions[1].species: found together with `pairs`"],
    );
    let many: Vec<[u32; 2]> = (0..9).map(|index| [index, 1000]).collect();
    let found = CHAINS.problems(&[&format!("interactions.1.pairs={}", json!(many))]);
    assert_eq!(found.len(), 6, "{found:#?}");
    assert_eq!(found[5], "interactions[1].pairs: 4 more like this; accepted: as above");
    CHAINS.refused_with(
        &[r#"interactions.2={"type":"langevin","friction":1,"species":[{"name":"watr","friction":2}]}"#],
        &["interactions[2].species[0].name: found \"watr\"; did you mean `water`?"],
    );
    CHAINS.refused_with(
        &[
            r#"interactions.2={"type":"langevin","species":[{"name":"water","friction":2},{"name":"water","friction":3}]}"#,
        ],
        &["interactions[2].species[1]: species[0] gives the friction of `water` already"],
    );
}

#[test]
fn interactions_without_anything_to_act_on() {
    let free = r#"particles=[{"species":"water","count":300}]"#;
    let found = CHAINS.problems(&[free]);
    assert_eq!(
        found,
        [
            "interactions[1]: found neither chains nor a list; accepted: `pairs` of particle ids, or particles with a \
             `chain` of at least 2 `beads`",
            "interactions[2]: found neither chains nor a list; accepted: `triples` of particle ids, or particles with a \
             `chain` of at least 3 `beads`",
        ]
    );
    CHAINS.refused_with(
        &["particles.0.chain.beads=2"],
        &["interactions[2]: found chains of 2 beads; accepted: `triples`"],
    );
}

#[test]
fn interactions_that_are_there_twice() {
    for (interaction, words) in [
        (r#"{"type":"langevin","friction":1}"#, "a second `langevin` interaction acts on the same particles again"),
        (
            r#"{"type":"coloured-noise","strength":1,"time":1}"#,
            "a second `coloured-noise` interaction acts on the same particles again",
        ),
        (r#"{"type":"tether","stiffness":1}"#, "a second `tether` interaction ties the same particles again"),
    ] {
        CHAINS.refused_with(
            &[&format!("interactions=[{interaction},{interaction}]")],
            &[&format!("interactions[1]: {words}; accepted: one `")],
        );
    }
    // The first of its kind may be anywhere.
    CHAINS.parse(&[
        r#"interactions=[{"type":"bonds","friction":1},{"type":"dpd","repulsion":25},{"type":"bonds","friction":1}]"#,
    ])
    .unwrap();
}

#[test]
fn baths() {
    let memory = r#"interactions.0.bath={"type":"memory","rate":10}"#;
    CHAINS.parse(&[memory]).unwrap();
    CHAINS.refused_with(
        &[memory, "interactions.0.bath.coupling=45"],
        &["interactions[0].friction: found 4.5; accepted: either friction or interactions[0].bath.coupling"],
    );
    CHAINS.refused_with(
        &[memory, "interactions.0.bath.rate=0"],
        &[
            "interactions[0].friction: found 4.5, which at a rate of 0 is no coupling at all: λ = αγ",
            "accepted: a `bath.coupling` λ in place of the friction",
        ],
    );
    CHAINS
        .parse(&[memory, "interactions.0.bath.rate=0", "interactions.0.bath.coupling=45", "interactions.0.friction=0"])
        .unwrap();
    CHAINS.parse(&[memory, "interactions.0.bath.coupling=0", "interactions.0.friction=0"]).unwrap();
    CHAINS.refused_with(
        &[memory, "interactions.0.bath.rate=1e90"],
        &[
            "interactions[0].friction: found 4.5, a coupling λ = αγ of 4.500e90; accepted: a coupling that single precision holds",
        ],
    );
    CHAINS.refused_with(
        &[r#"interactions.1.bath={"type":"memory","rate":1,"coupling":1e39}"#],
        &["interactions[1].bath.coupling: found 1.000e39; accepted: a coupling that single precision holds"],
    );
    CHAINS.refused_with(
        &[
            memory,
            "interactions.0.bath.coupling=45",
            "interactions.0.friction=0",
            r#"interactions.0.pairs=[{"between":["water","water"],"friction":3}]"#,
        ],
        &["interactions[0].pairs[0].friction: found 3; accepted: either friction or interactions[0].bath.coupling"],
    );
}

#[test]
fn integrators() {
    let split = r#"integrator={"type":"splitting"}"#;
    CHAINS.accepted(&[split, "interactions.1.exclude_repulsion=true"]);
    let both = "integrator.type: found `splitting` together with";
    CHAINS.accepted(&[split, "interactions.1.friction=2"]);
    let memory = r#"interactions.1.bath={"type":"memory","rate":3}"#;
    CHAINS.accepted(&[split, "interactions.1.friction=2", memory]);
    CHAINS.accepted(&[split, r#"interactions.2={"type":"coloured-noise","strength":1,"time":0.1}"#]);
    CHAINS.accepted(&[split, r#"interactions.2={"type":"langevin","friction":1,"bath":{"type":"memory","rate":2}}"#]);
    let rubbing = r#"interactions.2={"type":"bonds","pairs":[[0,2]],"friction":1}"#;
    CHAINS.refused_with(
        &[split, "interactions.1.friction=2", memory, rubbing],
        &[
            &format!("{both} friction along bonds in interactions[2] and memory in interactions[1]"),
            "or `cotter-reich`",
        ],
    );
    CHAINS.refused_with(
        &[split, r#"interactions.0.bath={"type":"memory","rate":10}"#],
        &[
            "integrator.type: found together with pairs with memory in interactions[0]; accepted: `splitting` without",
            "(not implemented: a split step",
            "`cotter-reich` takes them",
        ],
    );
    let star = |arms: u32| {
        let pairs: Vec<[u32; 2]> = (1..=arms).map(|arm| [0, arm]).collect();
        format!(r#"interactions.1={{"type":"bonds","friction":1,"pairs":{pairs:?}}}"#)
    };
    CHAINS.parse(&[split, &star(32)]).unwrap();
    CHAINS.refused_with(
        &[split, &star(33)],
        &["found `splitting` and 33 bonds with friction at particle 0; accepted: at most 32 at one particle"],
    );
    let fluid = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5}]"#;
    CHAINS
        .refused_with(&[fluid, LINE, r#"integrator={"type":"splitting"}"#], &["together with a box of one dimension"]);
    CHAINS.parse(&[fluid, "particles.1.fixed=true", r#"integrator={"type":"splitting"}"#]).unwrap();
    for water in ["gyro", "rotate"] {
        CHAINS.refused_with(
            &[&format!(r#"integrator={{"type":"{water}"}}"#)],
            &[&format!("integrator.type: found \"{water}\" in a scene of particles"), "`cotter-reich`"],
        );
    }
    let groot_warren = r#"integrator={"type":"groot-warren"}"#;
    CHAINS.parse(&[groot_warren]).unwrap();
    CHAINS.parse(&[groot_warren, "interactions.1.friction=1"]).unwrap();
    let memory = r#"interactions.1.bath={"type":"memory","rate":10}"#;
    CHAINS.refused_with(
        &[groot_warren, "interactions.1.friction=1", memory],
        &["integrator.type: found together with a bath with memory on every bond in interactions[1]", "takes both"],
    );
    CHAINS.refused_with(
        &[groot_warren, r#"interactions.0.bath={"type":"memory","rate":10}"#],
        &["integrator.type: found together with pairs with memory in interactions[0]", "`groot-warren` without pairs"],
    );
    let langevin = r#"interactions.2={"type":"langevin","friction":4}"#;
    let warnings = |integrator: &str| CHAINS.warnings(&[integrator, langevin, "time.step=0.01"]).join(" ");
    assert!(!warnings(groot_warren).contains("predicted"));
    let predicts = warnings(r#"integrator={"type":"groot-warren","lambda":0.9}"#);
    assert!(predicts.contains("integrator.lambda: friction of particles or bonds sees predicted"), "{predicts}");
    assert!(predicts.contains("% too low"), "{predicts}");
    CHAINS.refused_with(
        &[groot_warren, r#"interactions.2={"type":"langevin","friction":1,"bath":{"type":"memory","rate":2}}"#],
        &["integrator.type: found together with a bath with memory on every particle in interactions[2]"],
    );
}

#[test]
fn lengths() {
    CHAINS.refused_with(
        &["interactions.1.potential.length=5"],
        &["interactions[1].potential.length: found 5; accepted: less than 5, half the shortest box edge"],
    );
    // The margin of the list gives way.
    CHAINS.parse(&["space.box=[2.4,10,10]", "particles.0.count=20"]).unwrap();
    CHAINS.refused_with(
        &[r#"interactions.1.potential={"type":"fene","stiffness":30,"extent":0.7}"#],
        &[
            "interactions[1].potential.extent: found 0.7, and a distance of 0.800000 between particles 0 and 1 at the start; \
             accepted: more than 0.800000, by which that bond starts off its length 0; a first stage with a `push_off`",
        ],
    );
    // Where bonds have a largest force, those of any length begin.
    let short = r#"interactions.1.potential={"type":"fene","stiffness":30,"extent":0.7}"#;
    CHAINS.parse(&[short, r#"stages=[{"steps":40,"push_off":50},{"steps":60}]"#]).unwrap();
    CHAINS.parse(&[short, "push_off=50"]).unwrap();
    CHAINS.refused_with(
        &[short, r#"stages=[{"steps":40},{"steps":60,"push_off":50}]"#],
        &["interactions[1].potential.extent: found 0.7"],
    );
    CHAINS.refused_with(&[r#"stages=[{"steps":100,"push_off":0}]"#], &["stages[0].push_off: found 0"]);
    CHAINS.refused_with(
        &["interactions.1.potential=null", r#"stages=[{"steps":100,"push_off":5}]"#],
        &["stages[0].push_off: found a largest force of bonds, in a scene without bonds that have a potential"],
    );
    CHAINS.parse(&[r#"interactions.1.potential={"type":"fene","stiffness":30,"extent":0.7,"length":0.2}"#]).unwrap();
}

#[test]
fn lines_and_fixed_particles() {
    CHAINS.refused_with(
        &[r#"particles=[{"species":"bead","count":10}]"#, "interactions=[]", "output.chain_sizes.every=10"],
        &["output.chain_sizes: found in a scene without chains; accepted: a scene with chains"],
    );
    CHAINS.refused_with(
        &[LINE, r#"output.viscosity={"every":1,"window":10}"#],
        &["output.viscosity: found together with a box of one dimension in space.box", "(physics: there is no shear"],
    );
    CHAINS.refused_with(
        &[r#"particles.1={"species":"polymer","count":10,"fixed":true}"#],
        &["particles[1].fixed: found true; accepted: false as in particles[0]"],
    );
    let water = r#"interactions=[{"type":"shallow-water","mesh":[16,16],"wave_speed":1}]"#;
    let found = CHAINS.problems(&["space.box=[10,10]", water, "particles.1.fixed=true"]);
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!(found.iter().any(|line| {
        line.starts_with("particles[0].chain: found in a scene of shallow water; accepted: no chains in shallow water")
    }));
    assert!(found.iter().any(|line| {
        line.starts_with("particles[1].fixed: found in a scene of shallow water; accepted: particles that move")
    }));
}

#[test]
fn all_mistakes_at_once() {
    let found = CHAINS.problems(&[
        "particles.0.count=105",
        r#"interactions.0.bath={"type":"memory","rate":0}"#,
        r#"interactions.1.species=["polimer"]"#,
        "interactions.1.potential.length=7",
        "interactions.2.triples=[[0,1,1]]",
        r#"integrator={"type":"splitting"}"#,
        "time.equilibration=1000",
    ]);
    let paths: Vec<&str> = found.iter().map(|line| line.split(": ").next().unwrap()).collect();
    assert_eq!(
        paths,
        [
            "interactions[0].friction",
            "interactions[1].species[0]",
            "interactions[1].potential.length",
            "interactions[2].triples[0]",
            "integrator.type",
            "particles[0].count",
            "time.equilibration",
        ],
        "{found:#?}"
    );
}

/// The largest stable step or strength that a refusal names: at it the scene is accepted, and a little above not.
fn edge(overrides: &[&str], phrase: &str, key: &str) -> f64 {
    let found = CHAINS.problems(overrides);
    assert_eq!(found.len(), 1, "{found:#?}");
    let start = found[0].find(phrase).unwrap_or_else(|| panic!("`{phrase}` is not in {}", found[0])) + phrase.len();
    let number: f64 = found[0][start..].split([',', ' ', ';']).next().unwrap().parse().unwrap();
    let with = |value: f64| CHAINS.parse(&[overrides, &[&format!("{key}={value}")]].concat());
    with(number).unwrap_or_else(|error| panic!("{error}"));
    assert!(with(1.11 * number).is_err(), "{number} is not the edge: {}", found[0]);
    number
}

const ALONE: &str = r#"particles=[{"species":"bead","count":200,"chain":{"beads":2}}]"#;

#[test]
fn bonds_too_stiff_for_the_step() {
    // K dt²/µ = 4 at dt = √(4·½/2e5), in either integrator.
    let stiff = |integrator: &'static str| {
        [
            ALONE,
            integrator,
            r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":200000,"length":1}}]"#,
        ]
    };
    for integrator in [r#"integrator={"type":"cotter-reich"}"#, r#"integrator={"type":"groot-warren"}"#] {
        let overrides = stiff(integrator);
        let found = edge(&overrides, "accepted: at most ", "time.step");
        assert!((found - 0.003_1).abs() < 1e-9, "{found}");
        assert!(CHAINS.problems(&overrides)[0].starts_with(
            "time.step: found 0.01, at which B + W is 40.0000 for the bonds of interactions[0], of reduced mass 0.5"
        ));
    }
    // A fixed end makes the mass whole.
    let held = r#"particles=[{"species":"wall","count":1,"fixed":true},{"species":"bead","count":1}]"#;
    let bonds = r#"interactions=[{"type":"bonds","pairs":[[0,1]],"potential":{"type":"harmonic","stiffness":41000,"length":1}}]"#;
    assert!(CHAINS.problems(&[held, bonds])[0].contains("of reduced mass 1;"));
}

/// Longer chains are stiffer: the largest eigenvalue of n beads in a line is 4K/m cos²(π/2n).
#[test]
fn chains_on_a_line_are_stiffer_than_their_bonds() {
    let chain =
        |beads: u32| format!(r#"particles=[{{"species":"bead","count":{},"chain":{{"beads":{beads}}}}}]"#, 2 * beads);
    let bonds = |stiffness: f64| {
        format!(
            r#"interactions=[{{"type":"bonds","potential":{{"type":"harmonic","stiffness":{stiffness},"length":1}}}}]"#
        )
    };
    for beads in [2_u32, 3, 8, 40] {
        let cosine = (std::f64::consts::PI / (2.0 * f64::from(beads))).cos();
        let limit = 4.0 / (4.0 * cosine * cosine) / 1e-4;
        let at = |share: f64| CHAINS.parse(&[LINE, &chain(beads), &bonds(share * limit)]);
        at(0.98).unwrap_or_else(|error| panic!("{beads}: {error}"));
        let error = at(1.02).expect_err("too stiff").to_string();
        assert!(error.contains("for "), "{error}");
        // In space a chain is as stiff as that where it is straight, which is worth a warning.
        let overrides = ["space.box=[90,90,90]", &chain(beads), &bonds(1.02 * limit)];
        if beads > 2 {
            let warned = CHAINS.warnings(&overrides);
            assert!(
                warned[0].contains("for all bonds together: 4 is the limit of stability, which is passed at times"),
                "{warned:?}"
            );
        }
    }
}

/// α = 0, α → 1e9, λ = 0, γ = 1e6: what is stable is accepted, and what is not is refused.
#[test]
fn baths_at_the_ends_of_their_ranges() {
    let bath = |scheme: &str, rate: f64, friction: f64| {
        format!(
            r#"interactions=[{{"type":"bonds","friction":{friction},"bath":{{"type":"memory","rate":{rate},"scheme":"{scheme}"}}}}]"#
        )
    };
    for scheme in ["cotter-reich", "symmetric", "exponential"] {
        CHAINS.parse(&[ALONE, &bath(scheme, 1e9, 0.0)]).unwrap();
        assert!(CHAINS.parse(&[ALONE, &bath(scheme, 0.0, 1.0)]).is_err());
        CHAINS.parse(&[ALONE, &bath(scheme, 1e9, 1e-9)]).unwrap();
        let friction = edge(&[ALONE, &bath(scheme, 1e9, 1e6)], "or a friction of at most ", "interactions.0.friction");
        // λₑ dt²/µ = 4: λₑ = γα for `symmetric`, and 2γ/dt for the others, whose limit is that of white noise.
        let expected = if scheme == "symmetric" { 2e4 / 1e9 } else { 100.0 };
        assert!((friction / expected - 1.0).abs() < 0.1, "{scheme}: {friction}");
        let step = edge(&[ALONE, &bath(scheme, 1e9, 1e6)], "accepted: at most ", "time.step");
        assert!(step <= 1e-6, "{scheme}: {step}");
    }
    let endless = |coupling: f64| {
        format!(r#"interactions=[{{"type":"bonds","bath":{{"type":"memory","rate":0,"coupling":{coupling}}}}}]"#)
    };
    CHAINS.parse(&[ALONE, &endless(0.0)]).unwrap();
    let most = edge(&[ALONE, &endless(1e6)], "or a coupling of at most ", "interactions.0.bath.coupling");
    assert!((most / 2e4 - 1.0).abs() < 0.1, "{most}");

    let single = r#"particles=[{"species":"bead","count":200}]"#;
    let langevin = [single, r#"interactions=[{"type":"langevin","friction":1e6}]"#];
    let most = edge(&langevin, "or a friction of at most ", "interactions.0.friction");
    assert!((most / 200.0 - 1.0).abs() < 0.1, "{most}");
    assert!(CHAINS.problems(&langevin)[0].contains("for every `bead` of mass 1;"));
    let tether = [single, r#"interactions=[{"type":"tether","stiffness":50000}]"#];
    assert!((edge(&tether, "accepted: at most ", "time.step") - 0.0089).abs() < 2e-4);

    // Pairs of a fluid, with memory: half of the mean eigenvalue is certain.
    let fluid = r#"interactions=[{"type":"dpd","repulsion":25,"friction":1e6,"bath":{"type":"memory","rate":100}}]"#;
    let dense = r#"particles=[{"species":"bead","number_density":3}]"#;
    edge(&[dense, fluid], "accepted: at most ", "time.step");
    assert!(CHAINS.problems(&[dense, fluid])[0].contains("for the bath of pairs of `bead` with their neighbours"));
}

#[test]
fn steps_near_the_edge_are_warned_of() {
    let langevin = r#"interactions=[{"type":"langevin","friction":60}]"#;
    let single = r#"particles=[{"species":"bead","count":200}]"#;
    let found = CHAINS.warnings(&[single, langevin]);
    assert_eq!(
        found,
        [
            "time.step: B + W = (λₑ + K)dt²/m is 1.200 for every `bead` of mass 1: 4 is the limit of stability, and up to 1 is \
          advisable; a step of 0.0083 is safe"
        ]
    );
    assert!(CHAINS.warnings(&[single, langevin, "time.step=0.0083"]).is_empty());
}

#[test]
fn springs_too_weak_or_too_stiff_for_the_box_are_warned_of() {
    let springs = |stiffness: &str| {
        format!(r#"interactions=[{{"type":"bonds","potential":{{"type":"harmonic","stiffness":{stiffness}}}}}]"#)
    };
    let warned = |stiffness: &str, more: &[&str], expected: &str| {
        let changes = springs(stiffness);
        let found = CHAINS.warnings(&[&[changes.as_str()], more].concat());
        assert!(found.iter().any(|warning| warning.contains(expected)), "{found:?}");
    };
    assert_eq!(CHAINS.warnings(&[&springs("1")]), Vec::<String>::new());
    // √(kT/K) is 10 in half a box of 5.
    warned("0.01", &[], "heat stretches these springs by √(kT/K) = 10.000 about their length at rest of 0.000");
    // And 1e-5, where the box is resolved to 2e-5.
    let wide = ["space.box=[100000,100000,100000]", "time.step=1e-6"];
    warned("1e10", &wide, "positions are resolved to 2.33e-5");
}
