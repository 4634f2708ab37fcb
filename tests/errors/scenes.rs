//! Wrong scenes and wrong command lines: each names the place, what was found and what is accepted, and exits with 2.

use std::process::{Command, Output, Stdio};

use mesoscope::scene::{self, SceneError};
use serde_json::{Value, json};

use crate::support::mistakes::Correct;

fn mesoscope(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mesoscope")).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

const FLUID: Correct = Correct(base);

/// A small correct scene.
fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [
            {"species": "water", "count": 300},
            {"species": "oil", "count": 300},
        ],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
    })
}

#[test]
fn the_base_is_right() {
    FLUID.parse(&[]).unwrap();
}

#[test]
fn unknown_keys() {
    FLUID.refused_with(
        &["interactions.0.fricton=4"],
        &["interactions[0].fricton: unknown key; did you mean `friction`? accepted: type, cutoff, weight_exponent"],
    );
    for symbol in ["gamma", "gama"] {
        FLUID.refused_with(&[&format!("interactions.0.{symbol}=4")], &["did you mean `friction`?"]);
    }
    FLUID.refused_with(&["particles.0.densty=3"], &["did you mean `number_density`?"]);
    FLUID.refused_with(&["tempreature=1"], &["tempreature: unknown key; did you mean `temperature`?"]);
    FLUID.refused_with(&["integrator.type=splitting", "integrator.lambda=0.5"], &["integrator.lambda: unknown key"]);
    FLUID.refused_with(&["particles.0.placement.type=random", "particles.0.placement.spread=1"], &["placement.spread"]);
    FLUID.refused_with(&["wavelets=1"], &["wavelets: unknown key; accepted: version, title"]);
}

#[test]
fn announced_numbers_that_are_none() {
    let announced = |key: &str, largest: &str| format!(r#"announced=[{{"key":"{key}","largest":{largest}}}]"#);
    FLUID.parse(&[&announced("interactions.0.repulsion", "100")]).unwrap();
    for key in ["time.steps", "seed", "space.box.0"] {
        let expected =
            format!("announced[0].key: found `{key}`, which cannot change between steps; accepted: temperature");
        FLUID.refused_with(&[&announced(key, "2")], &[&expected]);
    }
    for key in ["interactions.1.repulsion", "interactions.0.type", "interactions.0.fricton", "interactions.x"] {
        FLUID.refused_with(&[&announced(key, "2")], &["announced: found a path at which this scene has no number"]);
    }
    let negative =
        "announced: with the largest values at once, temperature: found -1.0; accepted: a number, zero or positive";
    FLUID.refused_with(&[&announced("temperature", "-1")], &[negative]);
    FLUID.refused_with(&[&announced("temperature", "\"hot\"")], &["announced[0].largest: found the text \"hot\""]);
    FLUID.refused_with(&["announced={}"], &["announced: found"]);
}

#[test]
fn an_override_that_goes_nowhere_hides_no_other_mistake() {
    assert_eq!(
        FLUID.problems(&["particles.3.count=1", "time.stp=1", "temperature=-1", "seed"]),
        [
            "override `particles.3.count=1`: found `3`; accepted: an index from 0 to 1 of the list `particles`; `particles.2=…` appends to it",
            "override `seed`: found no `=`; accepted: path.to.key=value, as in time.step=0.02",
            "time.stp: unknown key; did you mean `step`? accepted: step, steps, equilibration",
            "temperature: found -1; accepted: a number, zero or positive",
        ]
    );
    // Lists that are left out begin at their first index.
    FLUID.parse(&[r#"interactions.0.pairs.0.between=["water","oil"]"#, "interactions.0.pairs.0.repulsion=40"]).unwrap();
}

#[test]
fn what_cannot_be_read_hides_no_other_mistake() {
    let pairs = r#"interactions.0.pairs=[{"between":["water","wine"],"repulsion":4}]"#;
    let wine =
        "interactions[0].pairs[0].between[1]: found \"wine\"; accepted: a species of some particle group: water, oil";
    let late = "time.equilibration: found 1000; accepted: at most 100, the number of steps; `--set time.equilibration=0` \
                leaves it out";
    let theme = "output.plot.theme: found the text \"drk\"; did you mean `dark`? accepted: \"light\", \"dark\"";
    assert_eq!(FLUID.problems(&["output.plot.theme=drk", "time.equilibration=1000", pairs]), [theme, wine, late]);
    let found = FLUID.problems(&["integrator.type=groot-waren", "particles.0.count=many", "seed=-1", pairs]);
    assert_eq!(found.len(), 4, "{found:#?}");
    for part in ["integrator.type: found \"groot-waren\"", "particles[0].count: found the text", "seed: found -1", wine]
    {
        assert!(found.iter().any(|problem| problem.contains(part)), "{part}: {found:#?}");
    }
    // Without numbers that a scene has to give there is still much to say, but nothing that follows from them.
    let found = FLUID.problems(&["temperature=hot", "time={}", "time.equilibration=1000", pairs]);
    assert_eq!(found.len(), 4, "{found:#?}");
    for part in ["temperature: found the text \"hot\"", "time.step: missing", "time.steps: missing", wine] {
        assert!(found.iter().any(|problem| problem.contains(part)), "{part}: {found:#?}");
    }
    // A list with an entry that cannot be read says nothing further.
    let found = FLUID.problems(&[r#"interactions.0.pairs=[{"between":["water"]},{"between":["water","oil"]}]"#]);
    assert_eq!(found.len(), 1, "{found:#?}");
}

#[test]
fn values_out_of_range_or_of_another_type() {
    FLUID
        .refused_with(&["particles.0.mass=-1"], &["particles[0].mass: found -1; accepted: a number greater than zero"]);
    FLUID.refused_with(&["time.step=0"], &["time.step: found 0; accepted: a number greater than zero"]);
    FLUID.refused_with(
        &["space.box=[]"],
        &["space.box: found a list of 0 entries; accepted: a list of 1 to 3 entries, each a number greater than zero"],
    );
    FLUID.refused_with(&["space.box=[9,9,9,9]"], &["space.box: found a list of 4 entries"]);
    FLUID.refused_with(&["space.box=[9,9,-9]"], &["space.box[2]: found -9; accepted: a number greater than zero"]);
    FLUID.refused_with(
        &["time.steps=ten"],
        &["time.steps: found the text \"ten\"; accepted: a whole number, zero or positive, up to 18446744073709551615"],
    );
    FLUID.refused_with(&["time.steps=1.5"], &["time.steps: found 1.5; accepted: a whole number"]);
    FLUID.refused_with(&["time.steps=null"], &["time.steps: found null"]);
    FLUID.refused_with(&["version=2"], &["version: found 2; accepted: the number 1"]);
    FLUID.refused_with(&["integrator=splitting"], &["did you mean `{\"type\": \"splitting\"}`?"]);
    let relaxation = ["integrator.type=splitting", "integrator.relaxation=two-stage"];
    FLUID.refused_with(&relaxation, &["integrator.relaxation", "did you mean `two-stages`?", "mean-field"]);
    FLUID.refused_with(&["integrator.type=grot-warren"], &["integrator.type", "did you mean `groot-warren`?"]);
    FLUID.refused_with(&["noise.generator=pcg"], &["noise.generator", "did you mean `pcg4d`?", "threefry2x32-20"]);
    FLUID.refused_with(&["integrator.lambda=.5"], &["integrator.type: missing; accepted: `splitting`, `groot-warren`"]);
    assert_eq!(FLUID.parse(&["time.steps=1e5"]).unwrap().time.steps, 100_000);
}

#[test]
fn missing_keys() {
    let mut document = base();
    document["time"].as_object_mut().unwrap().remove("step");
    let error = scene::parse("test.json", &document.to_string(), &[]).unwrap_err().to_string();
    assert!(
        error.contains("scene `test.json` has 1 mistake:\n  time.step: missing; accepted: a number greater"),
        "{error}"
    );
}

#[test]
fn all_mistakes_at_once_of_shape_and_of_sense() {
    let found = FLUID.problems(&[
        "interactions.0.fricton=4",
        "particles.1.mass=-1",
        "time.step=0",
        "time.equilibration=200",
        r#"interactions.0.pairs=[{"between": ["water", "oli"], "repulsion": 40}]"#,
    ]);
    let paths: Vec<&str> = found.iter().map(|line| line.split(':').next().unwrap()).collect();
    assert_eq!(paths.len(), 5, "{found:#?}");
    for path in [
        "interactions[0].fricton",
        "particles[1].mass",
        "time.step",
        "time.equilibration",
        "interactions[0].pairs[0].between[1]",
    ] {
        assert!(paths.contains(&path), "{path} in {found:#?}");
    }
}

#[test]
fn stages_of_a_run() {
    for (stages, expected) in [
        (r#"[{"steps":0},{"steps":100}]"#, "stages[0].steps: found 0; accepted: a whole number of at least 1"),
        (r#"[{"steps":40},{"steps":50}]"#, "time.steps: found 100; accepted: 90, the sum of the steps of its stages"),
        (
            r#"[{"steps":100,"set":{"space.box":[3,3]}}]"#,
            "stages[0].set.space.box: found a key that cannot change in a run; accepted: time.step, temperature",
        ),
        (
            r#"[{"steps":100,"set":{"particles.0.count":5}}]"#,
            "stages[0].set.particles.0.count: found a key that cannot",
        ),
        (
            r#"[{"steps":100,"set":{"temperature":"cold"}}]"#,
            "stages[0].set.temperature: found \"cold\"; accepted: a number",
        ),
        (
            r#"[{"steps":100,"set":{"temperature":1,"interactions[0].friction":1,"interactions.0.friction":2}}]"#,
            "found a number that is given twice; accepted: each number once",
        ),
        (
            r#"[{"steps":60},{"steps":40,"set":{"temperature":-1}}]"#,
            "stages[1]: with its numbers, temperature: found -1; accepted: a number, zero or positive",
        ),
        (
            r#"[{"steps":100,"ramp":{"temperature":2}}]"#,
            "stages[0].ramp.temperature: found 2; accepted: a list of two numbers",
        ),
        (
            r#"[{"steps":100,"ramp_every":5}]"#,
            "stages[0].ramp_every: found steps between values of a ramp, of a stage without",
        ),
        (
            r#"[{"steps":100,"set":{"temperature":1},"ramp":{"temperature":[1,2]}}]"#,
            "stages[0].ramp.temperature: found a number that is given twice",
        ),
        // A time step beyond what any scheme is stable with, in the second stage only.
        (
            r#"[{"steps":60,"output":{"snapshot":{"every":5}}},{"steps":40}]"#,
            "stages[0].output.snapshot: found `snapshot`; accepted: `energies`, `trajectory` and analyses in a stage",
        ),
        (
            r#"[{"steps":60,"output":{"radial_distribution":{"every":5,"range":400}}},{"steps":40}]"#,
            "stages[0].output.radial_distribution.range: found 400; accepted: at most",
        ),
        (
            r#"[{"steps":60,"output":{"difusion":{"every":5,"window":4}}},{"steps":40}]"#,
            "stages[0].output.difusion: unknown key; did you mean `diffusion`?",
        ),
        (
            r#"[{"steps":60,"output":{"trajectory":{"every":5}}},
                {"steps":40,"output":{"trajectory":{"every":5,"format":"extended-xyz"}}}]"#,
            "stages[1].output.trajectory: found a trajectory of another format or of other species",
        ),
        (
            r#"[{"steps":60,"output":{"energies":null}},{"steps":40}]"#,
            "stages[0].output.energies: found null; accepted",
        ),
        (r#"[{"steps":60},{"steps":40,"set":{"time.step":5}}]"#, "stages[1]: with its numbers, time.step: found 5"),
        (r#"[{"steps":100,"ramp":{"time.step":[0.01,5]}}]"#, "stages[0]: with its numbers, time.step: found"),
        (
            r#"[{"steps":60},{"steps":40,"set":{"interactions.0.cutoff_of_all":2}}]"#,
            "stages[1]: with its numbers, interactions[0].cutoff_of_all: unknown key",
        ),
    ] {
        FLUID.refused_with(&[&format!("stages={stages}")], &[expected]);
    }
    // A number of values that no machine holds.
    let endless = r#"stages=[{"steps":1000000000000000,"ramp":{"temperature":[1,2]},"ramp_every":1}]"#;
    let expected = "stages: found 1000000000000000 stages and values of ramps; accepted: at most 4096";
    FLUID.refused_with(&["time.steps=1e15", endless], &[expected]);
}

#[test]
fn species_and_pairs() {
    FLUID.refused_with(
        &[r#"interactions.0.pairs=[{"between": ["water", "oyl"]}]"#],
        &["interactions[0].pairs[0].between[1]: found \"oyl\"", "did you mean `oil`?", "water, oil"],
    );
    FLUID.refused_with(
        &[r#"interactions.0.pairs=[{"between": ["water", "oil"]}, {"between": ["oil", "water"]}]"#],
        &["interactions[0].pairs[1]: pairs[0] defines `oil` with `water` already"],
    );
    let twice = r#"interactions=[
        {"type": "dpd", "friction": 1, "many_body": {"repulsion": 2}},
        {"type": "dpd", "pairs": [{"between": ["oil", "water"], "friction": 2}], "many_body": {"repulsion": 3}},
        {"type": "dpd", "friction": 1, "bath": {"type": "white", "temperature": 2}},
        {"type": "dpd", "cutoff": 0.005, "repulsion": 1}]"#;
    let mistakes = [
        "interactions[3].cutoff: found 0.005 between species that have no cutoff of their own; accepted: at least 0.01",
        "interactions[1].many_body: a second many-body repulsion, beside that of interactions[0]; accepted: one",
        "interactions[1].friction: friction between `water` and `oil`, which they have in interactions[0] too; accepted: the",
        "interactions[2].bath: another bath than that of interactions[0]; accepted: the `bath` of interactions[0]",
    ];
    // Attraction outweighs repulsion in contact, or further away.
    let both = |second: &str| {
        let pairs = format!(r#"interactions=[{{"type":"dpd","repulsion":25}},{{"type":"dpd",{second}}}]"#);
        FLUID.warnings(&[&pairs]).join(" ").contains("collapse")
    };
    assert!(both(r#""repulsion":-30,"cutoff":0.9"#) && both(r#""repulsion":-6,"cutoff":1.5"#));
    assert!(!both(r#""repulsion":-4,"cutoff":1.5"#));
    let found = FLUID.problems(&[twice]);
    assert_eq!(found.len(), mistakes.len(), "{found:#?}");
    for (found, expected) in found.iter().zip(mistakes) {
        assert!(found.starts_with(expected), "`{expected}` does not begin: {found}");
    }
    FLUID.refused_with(
        &["particles.1.species=water", "particles.1.mass=2"],
        &["particles[1].mass: found 2; accepted: 1, the mass of species `water` in particles[0]"],
    );
}

#[test]
fn coefficients_of_pairs() {
    let pair = |coefficients: &str| {
        format!(
            r#"interactions.0.pairs=[{{"between":["water","water"]}},{{"between":["water","oil"],{coefficients}}}]"#
        )
    };
    for exponent in ["-1", "101", "null", "\"two\""] {
        if exponent == "null" {
            FLUID.accepted(&[&pair(r#""weight_exponent":null"#)]);
            continue;
        }
        let path = "interactions[0].pairs[1].weight_exponent: found";
        FLUID.refused_with(&[&pair(&format!(r#""weight_exponent":{exponent}"#))], &[path, "100"]);
    }
    FLUID.refused_with(&["interactions.0.weight_exponent=101"], &["interactions[0].weight_exponent: found 101", "100"]);
    for cutoff in ["0", "-1"] {
        FLUID.refused_with(&[&pair(&format!(r#""cutoff":{cutoff}"#))], &["interactions[0].pairs[1].cutoff: found"]);
    }
    FLUID.refused_with(
        &[&pair(r#""cutoff":5.5"#)],
        &[
            "interactions[0].pairs[1].cutoff: found 5.5 between `oil` and `water`",
            "at most 5, half the shortest box edge: beyond it a particle would meet two images of a neighbour",
        ],
    );
    FLUID.accepted(&[&pair(r#""cutoff":5"#)]);
    FLUID.refused_with(
        &[&pair(r#""cutoff":0.009"#)],
        &["interactions[0].pairs[1].cutoff: found 0.009 between `oil` and `water`", "at least 0.01, a hundredth"],
    );
    let all = |cutoff: &str| {
        ["water", "oil"].map(|name| format!(r#"{{"between":["{name}","{name}"],"cutoff":{cutoff}}}"#)).join(",")
    };
    // Where every pair has a cutoff of its own, that of the interaction says nothing.
    let own = format!(r#"interactions.0.pairs=[{},{{"between":["oil","water"],"cutoff":2}}]"#, all("3"));
    FLUID.accepted(&[&own, "interactions.0.cutoff=6"]);
    FLUID.accepted(&[&own, "interactions.0.cutoff=0.01"]);
    let two_of_three = format!("interactions.0.pairs=[{}]", all("3"));
    FLUID.refused_with(&[&two_of_three, "interactions.0.cutoff=0.02"], &["interactions[0].cutoff: found 0.02"]);
    FLUID.refused_with(
        &[&two_of_three, "interactions.0.cutoff=6", "space.box=[10,20,20]"],
        &["space.box[0]: found 10; accepted: at least 12, two cutoffs of 6"],
    );
}

#[test]
fn laws_of_the_time_step_see_the_coefficients_of_each_pair() {
    let pairs = |water: &str, unlike: &str| {
        format!(
            r#"interactions.0.pairs=[{{"between":["water","water"],{water}}},{{"between":["oil","oil"],"friction":0,"repulsion":0}},
                {{"between":["water","oil"],"cutoff":1.5,"weight_exponent":1,{unlike}}}]"#
        )
    };
    // Γ of water is Σ γρ[ω]/3 with [ω] = 8πrc³/((s+1)(s+2)(s+3)): (7500·.3·8π/60 + 3000·.3·8π·3.375/24)/3.
    let found = FLUID.warnings(&[&pairs(r#""friction":7500"#, r#""friction":3000"#)]);
    assert!(found.len() == 1 && found[0].contains("`water` at a mean rate of 1374"), "{found:?}");
    // ω² of evenly spread neighbours is Σ aρV/rc / 3 = (15625·.3·4.19 + 6250·.3·14.14/1.5)/3; 5.50 neighbours make it 1.784 times
    // as large.
    let found = FLUID.warnings(&[&pairs(r#""repulsion":15625"#, r#""repulsion":6250"#)]);
    assert!(found.len() == 1 && found[0].contains("`water` at a frequency of about 198"), "{found:?}");
    let narrow = pairs(r#""cutoff":0.5"#, r#""repulsion":1"#);
    let found = FLUID.warnings(&[&narrow, "space.box=[10,10,4]"]);
    assert!(
        found.len() == 1 && found[0].contains("space.box[2]: the edge of 4 is under three cutoffs (4.5)"),
        "{found:?}"
    );
}

#[test]
fn numbers_of_particles() {
    FLUID.refused_with(&["particles.0.number_density=3"], &["particles[0]: both", "exactly one of"]);
    FLUID.refused_with(&["particles.0.count=null"], &["particles[0]: neither", "exactly one of"]);
    FLUID.refused_with(
        &["particles.0.count=1000000000000"],
        &["particles[0].count: found 1000000000300 particles", "93132 GiB at 100 bytes", "at most 4294967295"],
    );
    FLUID.refused_with(&["particles.0.count=1e12"], &["93132 GiB"]);
    FLUID.refused_with(&["particles.0.count=18446744073709551615"], &["particles[0].count", "GiB"]);
    FLUID.refused_with(
        &["particles.0.count=null", "particles.0.number_density=1e90"],
        &["particles[0].number_density", "GiB", "at most 4294967295"],
    );
    for few in [0, 1, 2] {
        let scene = FLUID.parse(&[&format!("particles.0.count={few}"), "particles.1.count=0"]).unwrap();
        assert_eq!(scene.particles[0].count, Some(few));
    }
    assert!(FLUID.parse(&["particles=[]"]).unwrap().particles.is_empty());
}

#[test]
fn listed_particles() {
    let group = |positions: &str, more: &str| {
        format!(r#"particles=[{{"species": "A", "placement": {{"type": "listed", "positions": {positions}}}{more}}}]"#)
    };
    FLUID.parse(&[&group("[[1,2,3],[4,5,6]]", "")]).unwrap();
    FLUID.parse(&[&group("[[1,2,3],[4,5,6]]", r#", "count": 2"#)]).unwrap();
    FLUID.refused_with(
        &[&group("[[1,2,3],[4,5]]", "")],
        &["particles[0].placement.positions[1]: found 2 components; accepted: 3"],
    );
    FLUID.refused_with(&[&group("[[1,2,3]]", r#", "count": 2"#)], &["particles[0].count: found 2; accepted: 1"]);
    FLUID.refused_with(&[&group("[[1,2,3]]", r#", "number_density": 2"#)], &["particles[0].number_density"]);
    let velocities = r#", "velocities": {"type": "listed", "velocities": [[0,0,0],[0,0]]}"#;
    let found = FLUID.problems(&[&group("[[1,2,3]]", velocities)]);
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!(
        found[0].contains("velocities.velocities: found a list of 2; accepted: one velocity for each"),
        "{found:#?}"
    );
    assert!(found[1].contains("velocities.velocities[1]: found 2 components"), "{found:#?}");
}

#[test]
fn lengths_and_durations() {
    FLUID
        .refused_with(&["space.box=[10,1.5,10]"], &["space.box[1]: found 1.5; accepted: at least 2, two cutoffs of 1"]);
    FLUID.refused_with(
        &["output.radial_distribution.every=10", "output.radial_distribution.range=6"],
        &["output.radial_distribution.range: found 6; accepted: at most 5, half the shortest box edge"],
    );
    let particles = r#"particles=[{"species":"head","count":9},{"species":"tail","count":9},{"species":"wall","count":4,"fixed":true}]"#;
    for (asked, refusal) in [
        (
            r#"radial_distribution={"every":1,"range":2,"species":"heat"}"#,
            "radial_distribution.species: found \"heat\"",
        ),
        (
            r#"radial_distribution={"every":1,"range":2,"species":["tail","tall"]}"#,
            "radial_distribution.species[1]: found \"tall\"",
        ),
        (
            r#"radial_distribution={"every":1,"range":2,"species":["tail"]}"#,
            "species: found a list of 1; accepted: text, or a list of 2 entries, each text",
        ),
        (
            r#"radial_distribution={"every":1,"range":2,"bins":700,"species":"all-pairs"}"#,
            "found 6 pairs of species with 700 bins each; accepted: at most 4096 bins in all: `bins` up to 682, or `species`",
        ),
        (
            r#"structure_factor={"every":1,"range":0.5}"#,
            "structure_factor.range: found 0.5; accepted: at least 0.6283, the wave number of one wave along the longest periodic",
        ),
        (
            r#"structure_factor={"every":1,"range":9,"bins":1000,"vectors":60,"species":"all-pairs"}"#,
            "structure_factor: found 1000 bins of 60 wave vectors and 3 species; accepted: at most 65536 in all",
        ),
        (
            r#"clusters={"every":1,"distance":6}"#,
            "output.clusters.distance: found 6; accepted: at most 5, half the shortest box edge",
        ),
        (r#"clusters={"every":1,"distance":1,"species":"tal"}"#, "clusters.species: found \"tal\""),
        (
            r#"profiles={"axis":"x","every":1,"species":"heads"}"#,
            "profiles.species: found \"heads\"; did you mean `head`?",
        ),
        (r#"structure_factor={"every":1,"range":9,"species":["tail","heads"]}"#, "species[1]: found \"heads\""),
        (r#"diffusion={"every":1,"window":2,"species":"wall"}"#, "diffusion.species: found \"wall\", which is held"),
        (r#"histograms=[{"quantity":"speed","every":1,"species":"Head"}]"#, "histograms[0].species: found \"Head\""),
        (r#"autocorrelations=[{"quantity":"force","every":1,"window":2,"species":"tails"}]"#, "did you mean `tail`?"),
    ] {
        FLUID.refused_with(&[particles, &format!("output.{asked}")], &[refusal]);
    }
    FLUID.refused_with(
        &[r#"output.stress={"every":1,"interfaces":4}"#],
        &["output.stress.interfaces: found 4; accepted: `normal`, the axis across them"],
    );
    let taken = particles.replace("head", "all-pairs");
    FLUID.refused_with(
        &[&taken, r#"output.radial_distribution={"every":1,"range":2,"species":"all-pairs"}"#],
        &["found \"all-pairs\", which is also a species"],
    );
    FLUID.refused_with(&["time.equilibration=101"], &["time.equilibration: found 101; accepted: at most 100"]);
    for analysis in ["diffusion", "viscosity"] {
        FLUID.refused_with(
            &[&format!("output.{analysis}={{\"every\": 5, \"window\": 20}}"), "time.equilibration=10"],
            &[&format!("output.{analysis}.window: found 20 samples"), "at most 18 samples", "at least 110"],
        );
        FLUID.parse(&[&format!("output.{analysis}={{\"every\": 5, \"window\": 20}}")]).unwrap();
    }
}

#[test]
fn profiles_have_an_axis_of_the_box_and_quantities_once() {
    let profiles = |more: &str| format!(r#"output.profiles={{"every":1,"axis":"z"{more}}}"#);
    FLUID.parse(&[&profiles("")]).unwrap();
    FLUID.refused_with(
        &[&profiles(""), "space.box=[10,10]"],
        &["output.profiles.axis: found \"z\"; accepted: an axis of the box"],
    );
    FLUID.refused_with(
        &[&profiles(r#","quantities":["velocity","density","velocity"]"#)],
        &["output.profiles.quantities[2]: found \"velocity\" again; accepted: every quantity at most once"],
    );
    FLUID.refused_with(&[&profiles(r#","quantities":[]"#)], &["output.profiles.quantities"]);
    FLUID.refused_with(&[&profiles(r#","bins":0"#)], &["output.profiles.bins: found 0"]);
    FLUID.refused_with(&["output.profiles.every=5"], &["output.profiles.axis"]);
}

#[test]
fn stresses_are_those_between_particles() {
    let stress = |more: &str| format!(r#"output.stress={{"every":2{more}}}"#);
    FLUID.parse(&[&stress(r#","normal":"y""#), "space.box=[10,10]"]).unwrap();
    FLUID.refused_with(&[&stress(r#","normal":"z""#), "space.box=[10,10]"], &["output.stress.normal: found \"z\""]);
    let fixed = r#"particles=[{"species":"A","count":3000},{"species":"B","count":9,"fixed":true}]"#;
    FLUID.refused_with(
        &[&stress(""), fixed],
        &["output.stress: found together with fixed particles in particles[1].fixed"],
    );
    let tethers = r#"interactions=[{"type":"tether","stiffness":1}]"#;
    FLUID.refused_with(&[&stress(""), tethers], &["output.stress: found together with tethers in interactions[0]"]);
    let line = [r#"particles=[{"species":"A","count":9}]"#, "interactions=[]", "space.box=[10]"];
    FLUID.refused_with(
        &[&[&stress("") as &str], &line[..]].concat(),
        &["output.stress: found together with a box of one dimension in space.box"],
    );
    // Noise that is not sampled is missing.
    FLUID.refused_with(&[&stress(r#","window":9"#)], &["output.stress.every: found 2; accepted: 1 with a `window`"]);
    FLUID.parse(&[&stress(r#","window":9"#), "interactions.0.friction=0"]).unwrap();
    FLUID.parse(&[r#"output.stress={"every":1,"window":9}"#]).unwrap();
    FLUID.refused_with(&[r#"output.stress={"every":1,"window":101}"#], &["output.stress.window: found 101 samples"]);
    FLUID.refused_with(
        &[r#"output.stress={"every":1,"window":9}"#, "temperature=0"],
        &["output.stress.window: found in a scene at a temperature of 0"],
    );
}

#[test]
fn steps_that_take_particles_too_far_are_refused() {
    FLUID.parse(&["temperature=9900", "interactions.0.friction=0"]).unwrap();
    FLUID.refused_with(
        &["temperature=1e12"],
        &[
            "time.step: found 0.01, in which thermal velocities of 1.00e6 take particles[0] 10000.000 far",
            "a step that takes them no further than the cutoff, 1.000: 1e-7 or less",
        ],
    );
    let rest = r#"particles=[{"species":"A","count":300,"velocities":{"type":"rest"}}]"#;
    // A bath would heat them, and without one they stay as they are.
    FLUID.refused_with(&[rest, "temperature=1e12"], &["thermal velocities"]);
    FLUID.parse(&[rest, "temperature=1e12", "interactions.0.friction=0"]).unwrap();
    let listed = r#"particles=[{"species":"A","placement":{"type":"listed","positions":[[1,1,1],[3,3,3]]},
        "velocities":{"type":"listed","velocities":[[0,101,0],[0,-101,0]]}}]"#;
    FLUID.refused_with(&[listed], &["velocities of 101.000 take particles[0] 1.010 far"]);
}

#[test]
fn friction_far_beyond_the_step_is_refused() {
    let explicit = r#"integrator={"type":"groot-warren"}"#;
    let strong = "interactions.0.friction=1e30";
    FLUID.refused_with(&[explicit, strong], &["friction relaxes the velocities of `water` 8.38e26 times over"]);
    // Pairs relax exactly, at any friction, and where neighbours are few nothing else happens.
    FLUID.parse(&[strong]).unwrap();
    FLUID.refused_with(&[strong, "particles.0.count=3000"], &["times over; accepted: at most "]);
}

/// ω² is aρV/(3rc m) (1 + .75 √(6/ρV))² of particles of mass m that have ρV others within rc.
#[test]
fn repulsion_far_beyond_the_step_is_refused() {
    let (dense, alone) = ("particles.0.count=100000", "particles.1.count=0");
    let neighbours = 100.0 * 4.0 / 3.0 * std::f64::consts::PI;
    let frequency = (25.0 * neighbours / 3.0).sqrt() * (1.0 + 0.75 * (6.0 / neighbours).sqrt());
    let step = |radians: f64| format!("time.step={}", radians / frequency);
    FLUID.refused_with(
        &[dense, alone, &step(2.501)],
        &["crowds of `water` oscillate by 2.501 radians", "accepted: at most 0.03"],
    );
    FLUID.parse(&[dense, alone, &step(2.499)]).unwrap();
    // Of a gas only pairs meet.
    FLUID.parse(&["time.step=0.3"]).unwrap();
}

#[test]
fn particles_in_one_place_are_warned_of() {
    let listed = r#"particles=[{"species":"A","placement":{"type":"listed","positions":[[1,1,1],[3,3,3],[1,1,1]]}}]"#;
    let found = FLUID.warnings(&[listed]);
    assert!(found.len() == 1 && found[0].contains("1 particles start where another one is"), "{found:?}");
}

#[test]
fn warnings_name_place_and_remedy() {
    let warned = |overrides: &[&str], expected: &str| {
        let warnings = FLUID.warnings(overrides);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains(expected), "{warnings:?}");
    };
    assert!(FLUID.warnings(&[]).is_empty());
    // The mean friction rate is γρ·(2π/15)/(3m): 628.3 for γ = 7500 at density 0.6.
    warned(
        &["interactions.0.friction=7500"],
        "time.step: friction relaxes the velocities of `water` at a mean rate of 628.",
    );
    // Evenly spread, 2.51 neighbours at density 0.6 give ω = 457.6; that of crowds is 1 + .75 √(6/2.51) times as much.
    warned(&["interactions.0.repulsion=250000"], "time.step: repulsion shakes `water` at a frequency of about 987.");
    warned(&["space.box=[2.5,10,10]"], "space.box[0]: the edge of 2.5 is under three cutoffs (3)");
    let moving = r#"particles=[{"species": "A", "count": 2, "velocities": {"type": "listed", "velocities": [[1,0,0],[1,0,0]]}}]"#;
    warned(&[moving], "particles: the listed velocities add up to a momentum of (2.000000, 0.000000, 0.000000)");
    // A bath on particles does not keep it.
    let bath = r#"interactions=[{"type": "langevin", "friction": 1}]"#;
    assert_eq!(FLUID.warnings(&[moving, bath]), Vec::<String>::new());
}

fn syntax(text: &str) -> (usize, usize, String) {
    match scene::parse("test.json", text, &[]) {
        Err(SceneError::Syntax { line, column, message, .. }) => (line, column, message),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn text_that_is_not_json() {
    let (line, column, message) = syntax("{\n  \"title\": \"x\",\n  \"seed\" 1\n}");
    assert_eq!((line, column), (3, 10));
    assert!(message.contains("expected `:`"), "{message}");
    for (text, expected) in [
        ("", "empty"),
        ("{\"temperature\": NaN}", "JSON has no NaN or Infinity"),
        ("{\"temperature\": -Infinity}", "JSON has no NaN or Infinity"),
        ("{\n // kT\n\"temperature\": 1}", "JSON has no comments"),
        ("{\"temperature\": 1e999}", "every number must be finite"),
        ("{\"temperature\": .5}", "a number starts with a digit"),
        ("{'temperature': 1}", "double quotes"),
        ("{\"temperature\": 1,}", "trailing comma"),
        ("{} {}", "trailing characters"),
    ] {
        let (_, _, message) = syntax(text);
        assert!(message.contains(expected), "{text}: {message}");
    }
    syntax(&"[".repeat(100_000));
}

#[test]
fn keys_given_twice() {
    let text = base().to_string().replacen("\"step\":0.01", "\"step\":0.01,\"step\":0.02", 1);
    let error = scene::parse("test.json", &text, &[]).unwrap_err().to_string();
    assert!(error.contains("time.step: the key is given more than once"), "{error}");
}

#[test]
fn a_document_that_is_no_object() {
    for text in ["[]", "3", "null", "\"dpd-fluid\""] {
        let error = scene::parse("test.json", text, &[]).unwrap_err().to_string();
        assert!(error.contains("top level: found") && error.contains("`title`"), "{error}");
    }
}

#[test]
fn the_program_lists_and_prints_scenes() {
    let output = mesoscope(&["scenes"]);
    assert!(output.status.success());
    for builtin in scene::builtin() {
        assert!(text(&output.stdout).contains(builtin.name));
        assert_eq!(text(&mesoscope(&["scenes", builtin.name]).stdout), builtin.text);
    }
    assert!(
        text(&output.stdout)
            .lines()
            .any(|line| { line.split_whitespace().collect::<Vec<_>>()[..3] == ["dpd-fluid", "24000", "3"] })
    );
    let output = mesoscope(&["scenes", "dpd-fliud"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).starts_with("error: no scene `dpd-fliud`"), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("did you mean `dpd-fluid`?"));
}

#[test]
fn the_program_prints_the_schema() {
    let output = mesoscope(&["schema"]);
    assert!(output.status.success());
    assert_eq!(serde_json::from_slice::<Value>(&output.stdout).unwrap(), scene::schema());
}

#[test]
fn the_program_refuses_with_exit_code_two() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("wrong.json");
    std::fs::write(&path, base().to_string().replace("friction", "fricton").replace("0.01", "0")).unwrap();
    let path = path.to_str().unwrap();
    let output = mesoscope(&["run", path]);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(message.starts_with(&format!("error: scene `{path}` has 2 mistakes:\n  time.step: found 0;")), "{message}");
    assert!(message.contains("\n  interactions[0].fricton: unknown key; did you mean `friction`?"), "{message}");
    assert!(message.contains("\nhint: "), "{message}");
    assert!(output.stdout.is_empty());

    for arguments in [
        &[][..],
        &["simulate"],
        &["run"],
        &["run", "dpd-fluid", "--stpes", "3"],
        &["run", "dpd-fluid", "--steps", "many"],
        &["run", "dpd-fluid", "--set", "time.step"],
        &["run", "no-such-file.json"],
        &["run", directory.path().to_str().unwrap()],
    ] {
        let output = mesoscope(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
        assert!(!output.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn files_that_are_not_text_or_have_no_end() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("picture.json");
    std::fs::write(&path, b"{\n\xff\xfe}").unwrap();
    let output = mesoscope(&["check", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("picture.json:2:1: this is not UTF-8 text"), "{}", text(&output.stderr));
    #[cfg(unix)]
    {
        let output = mesoscope(&["check", "/dev/zero"]);
        assert!(
            text(&output.stderr).contains("/dev/zero: it exceeds the limit of 512 MiB"),
            "{}",
            text(&output.stderr)
        );
    }
}

#[test]
fn a_reader_that_leaves_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_mesoscope"))
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[test]
fn a_flood_of_mistakes_is_counted() {
    let positions = vec![[1]; 30];
    let group = json!([{"species": "A", "placement": {"type": "listed", "positions": positions}}]);
    let error = FLUID.parse(&[&format!("particles={group}")]).unwrap_err().to_string();
    assert!(error.starts_with("scene `test.json` has 30 mistakes:"), "{error}");
    assert_eq!(error.lines().count(), 22, "{error}");
    assert!(error.ends_with("\n  and 10 more"), "{error}");
}
