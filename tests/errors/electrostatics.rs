//! Charges and fields with mistakes.

use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const SALT: Correct = Correct(base);

fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10]},
        "time": {"step": 0.02, "steps": 100},
        "temperature": 1,
        "particles": [
            {"species": "water", "count": 600},
            {"species": "cation", "count": 30, "charge": 2},
            {"species": "anion", "count": 60, "charge": -1},
        ],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "electrostatics", "bjerrum_length": 1.1},
        ],
    })
}

#[test]
fn the_base_is_right() {
    SALT.accepted(&[]);
    assert_eq!(SALT.warnings(&[]), Vec::<String>::new());
}

#[test]
fn charges_are_neutral_in_integers_or_have_a_background() {
    SALT.refused_with(
        &["particles.1.charge=1"],
        &["interactions[1]: found charges that add up to -30", "\"background\": true"],
    );
    SALT.accepted(&["particles.1.charge=1", "interactions.1.background=true"]);
    // A third is rounded to 2⁻¹⁶; three of them are one less 2⁻¹⁶.
    let thirds = ["particles.1.count=30", "particles.1.charge=0.3333333333", "particles.2.count=10"];
    SALT.refused_with(&thirds, &["charges that add up to -0.000"]);
    SALT.refused_with(
        &["particles.1.charge=0", "particles.2.charge=0"],
        &["interactions[1]: found no particle with a charge"],
    );
    SALT.refused_with(&["particles.1.charge=2000"], &["particles[1].charge"]);
    let twice = r#"particles=[{"species":"a","count":3,"charge":1},{"species":"a","count":3,"charge":-1}]"#;
    let problems = SALT.problems(&[twice]);
    assert!(problems.iter().any(|problem| problem.contains("particles[1].charge: found -1")), "{problems:?}");
}

#[test]
fn the_mesh_resolves_the_charges_and_fits() {
    SALT.refused_with(&["interactions.1.spacing=1.3"], &["interactions[1].spacing: found 1.3", "2 times the width"]);
    SALT.refused_with(
        &["interactions.1.width=0.6", "interactions.1.decay=0.9"],
        &["interactions[1].decay: found beside `width`", "not both"],
    );
    SALT.refused_with(
        &["interactions.1.method=waves", "interactions.1.spacing=0.01"],
        &["interactions[1].method: found `waves`, some ", "at most 1,048,576 waves", "`mesh` sums them faster"],
    );
    SALT.refused_with(&["interactions.1.decay=3"], &["interactions[1].spacing: found 0.5", "at most 0.471405"]);
    SALT.refused_with(&["interactions.1.width=0.2"], &["interactions[1].spacing: found 0.5"]);
    SALT.refused_with(
        &["space.box=[1000,10,10]"],
        &["interactions[1].spacing: found 0.5, 2000 nodes along an edge of 1000", "1024 nodes"],
    );
    SALT.refused_with(&["interactions.1.order=5"], &["interactions[1].order: found 5", "4 or 6 points"]);
    SALT.refused_with(&["interactions.1.order=8"], &["interactions[1].order"]);
    SALT.refused_with(&["interactions.1.bjerrum_length=0"], &["interactions[1].bjerrum_length"]);
    let coarse = SALT.warnings(&["interactions.1.spacing=0.9", "interactions.1.order=4"]);
    assert!(
        coarse.len() == 1 && coarse[0].starts_with("interactions[1].spacing: forces between charges"),
        "{coarse:?}"
    );
}

#[test]
fn scenes_without_what_charges_need() {
    SALT.refused_with(&["temperature=0"], &["interactions[1]: found at a temperature of 0"]);
    SALT.refused_with(&["space.box=[10,10]"], &["interactions[1]: found in a box of two dimensions"]);
    SALT.refused_with(&[r#"space.walls={"z":{}}"#], &["electrostatics", "walls", "not implemented"]);
    SALT.refused_with(&[r#"space.shear={"rate":0.1,"gradient":"z"}"#], &["electrostatics", "shear", "not implemented"]);
    let two =
        r#"interactions=[{"type":"electrostatics","bjerrum_length":1},{"type":"electrostatics","bjerrum_length":2}]"#;
    SALT.refused_with(&[two], &["interactions[1]: a second `electrostatics` interaction"]);
    let idle = SALT.warnings(&[r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5}]"#]);
    assert_eq!(idle, ["particles[1].charge: neither `electrostatics` nor an `electric-field` acts on charges"]);
}

/// Bonds that exclude charges where nothing acts on charges.
#[test]
fn excluded_charges() {
    let bonds = |pair: &str| format!(r#"interactions.2={{"type":"bonds","pairs":[{pair}],"exclude_charges":true}}"#);
    assert_eq!(SALT.warnings(&[&bonds("[0,1]")]), [""; 0]);
    // Charges of 2 and -1 attract each other like a spring of .92.
    let spring = |stiffness: f64| {
        let potential = format!(r#"{{"type":"harmonic","stiffness":{stiffness}}}"#);
        format!(
            r#"interactions.2={{"type":"bonds","pairs":[[600,630]],"potential":{potential},"exclude_charges":true}}"#
        )
    };
    assert_eq!(SALT.warnings(&[&spring(5.0)]), [""; 0]);
    let warnings = SALT.warnings(&[&spring(0.9)]);
    assert!(
        warnings.len() == 1 && warnings[0].contains("the attraction that is taken back one of 0.922"),
        "{warnings:?}"
    );
    let without = r#"interactions=[{"type":"bonds","pairs":[[0,1]],"exclude_charges":true}]"#;
    let warnings = SALT.warnings(&[without]);
    assert!(warnings[0].starts_with("interactions[0].exclude_charges: nothing is excluded"), "{warnings:?}");
}

#[test]
fn analyses_of_charge() {
    let factor = |more: &str| format!(r#"output.structure_factor={{"every":10,"range":6,"charges":true{more}}}"#);
    SALT.accepted(&[&factor("")]);
    SALT.refused_with(
        &[&factor(r#","species":"water""#)],
        &["output.structure_factor.species: found together with the charge in `charges`; accepted: one of them"],
    );
    let profiles =
        |more: &str| format!(r#"output.profiles={{"axis":"z","bins":10,"every":10,"quantities":["charge"]{more}}}"#);
    SALT.accepted(&[&profiles("")]);
    SALT.refused_with(
        &[&profiles(r#","species":"water""#)],
        &["output.profiles.species: found together with the charge in `quantities`; accepted: one of them"],
    );
    let neutral =
        ["particles.1.charge=0", "particles.2.charge=0", "interactions.1={\"type\":\"langevin\",\"friction\":1}"];
    SALT.refused_with(
        &[&neutral[..], &[&factor("")]].concat(),
        &["output.structure_factor.charges: found no particle with a charge; accepted: a `charge` other than 0"],
    );
    SALT.refused_with(
        &[&neutral[..], &[&profiles("")]].concat(),
        &["output.profiles.quantities: found no particle with a charge; accepted: a `charge` other than 0"],
    );
}

#[test]
fn charges_too_strong_for_integers() {
    let few = ["particles.1.count=1", "particles.2.count=1", "particles.1.charge=128", "particles.2.charge=-128"];
    let strong = [&few[..], &["interactions.1.bjerrum_length=10"]].concat();
    SALT.refused_with(&strong, &["interactions[1].bjerrum_length: found charges that push each other by"]);
}

/// ω² = 4π lB Σq²/mV = 2.26 lB.
#[test]
fn charges_that_swing_too_fast_for_a_step() {
    let swing = |length: f64| format!("interactions.1.bjerrum_length={length}");
    let warnings = SALT.warnings(&[&swing(1200.0)]);
    assert!(warnings.len() == 1 && warnings[0].contains("swing against each other by 1.04 radians"), "{warnings:?}");
    SALT.accepted(&[&swing(4400.0)]);
    SALT.refused_with(
        &[&swing(4450.0)],
        &["interactions[1].bjerrum_length: found charges that swing against each other by 2.01 radians", "less than 2"],
    );
}

#[test]
fn fields() {
    let field = |more: &str| format!(r#"interactions=[{{"type":"electric-field","field":[1,0,0]{more}}}]"#);
    SALT.accepted(&[&field("")]);
    SALT.accepted(&[&field(r#","frequency":0.5"#)]);
    SALT.refused_with(&[&field(r#","frequency":6"#)], &["interactions[0].frequency: found 6", "ten steps"]);
    SALT.refused_with(&[&field(r#","frequency":0"#)], &["interactions[0].frequency"]);
    let short = r#"interactions=[{"type":"electric-field","field":[1,0]}]"#;
    SALT.refused_with(&[short], &["interactions[0].field: found 2 components", "3, one for each axis"]);
    SALT.refused_with(
        &[&field(""), "particles.1.charge=0", "particles.2.charge=0"],
        &["interactions[0]: found no particle with a charge"],
    );
    let both = r#"interactions=[{"type":"electric-field","field":[1,0,0],"frequency":0.5},
        {"type":"body-force","force":[1,0,0]}]"#;
    SALT.refused_with(&[both], &["interactions[1]: found a body force of another profile", "interactions[0]"]);
    let steady = r#"interactions=[{"type":"electric-field","field":[1,0,0]},{"type":"body-force","force":[1,0,0]}]"#;
    SALT.accepted(&[steady]);
    // The phase of a field is that of its steps.
    SALT.refused_with(
        &[
            &field(r#","frequency":0.5"#),
            r#"stages=[{"steps":50},{"steps":50,"set":{"interactions.0.frequency":0.6}}]"#,
        ],
        &["stages[1].set.interactions.0.frequency: found a key that cannot change in a run"],
    );
    let stages = r#"stages=[{"steps":50},{"steps":50,"set":{"time.step":0.01}}]"#;
    SALT.accepted(&[&field(""), stages]);
    SALT.refused_with(
        &[&field(r#","frequency":0.5"#), stages],
        &["stages[1].set.time.step: found a change of the time step of a field that oscillates"],
    );
}
