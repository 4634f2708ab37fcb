//! Shear with mistakes.

use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const SHEARED: Correct = Correct(base);

fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10], "shear": {"rate": 0.1, "flow": "x", "gradient": "y"}},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [{"species": "water", "count": 300}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
    })
}

#[test]
fn the_base_is_right() {
    SHEARED.accepted(&[]);
    assert_eq!(SHEARED.warnings(&[]), Vec::<String>::new());
    SHEARED.accepted(&[r#"space.shear={"rate":-0.1,"gradient":"z"}"#]);
    SHEARED.accepted(&["space.box=[10,10]"]);
    SHEARED.accepted(&[r#"integrator={"type":"groot-warren","lambda":0.65}"#]);
}

#[test]
fn axes() {
    SHEARED.refused_with(
        &[r#"space.shear.gradient="x""#],
        &["space.shear.gradient: found \"x\", along the flow", "y or z"],
    );
    SHEARED.refused_with(
        &[r#"space.shear.flow="y""#],
        &["space.shear.flow: found \"y\"", "cells of neighbours lie in rows"],
    );
    SHEARED.refused_with(&[r#"space.shear.gradient="w""#], &["space.shear.gradient"]);
    SHEARED.refused_with(&[r#"space.shear={"rate":1}"#], &["space.shear", "gradient"]);
    SHEARED.refused_with(
        &["space.box=[10,10]", r#"space.shear.gradient="z""#],
        &["space.shear.gradient: found \"z\", an axis that the box has not", "y, in two dimensions"],
    );
    SHEARED.refused_with(
        &["space.box=[10,2.5,10]"],
        &["space.box[1]: found 2.5", "at least 3, three cutoffs of 1", "not at the other"],
    );
    SHEARED.accepted(&["space.box=[10,3,10]"]);
    SHEARED.accepted(&["space.box=[2,3,2]"]);
}

#[test]
fn rates() {
    SHEARED.refused_with(&[r#"space.shear.rate="fast""#], &["space.shear.rate"]);
    // The flow at a boundary goes half of the edge times the rate times the step.
    SHEARED.refused_with(
        &["space.shear.rate=25"],
        &["space.shear.rate: found 25.000", "goes 1.250 in a step", "at most 20.000", "the cutoff, 1.000"],
    );
    SHEARED.accepted(&["space.shear.rate=19"]);
    SHEARED.refused_with(&["space.shear.rate=-1e30"], &["space.shear.rate: found -1.00e30"]);
    SHEARED.accepted(&["space.shear.rate=0"]);
    // Boundaries may be displaced, by any number of boxes, and stay so.
    SHEARED.accepted(&["space.shear.displacement=-37.25"]);
    SHEARED.accepted(&["space.shear.rate=0", "space.shear.displacement=2.5", r#"output.stress={"every":10}"#]);
    SHEARED.refused_with(&[r#"space.shear.displacement="far""#], &["space.shear.displacement"]);
}

/// Baths, lists and random forces follow the boundaries; friction of single particles is of either velocity.
#[test]
fn what_takes_shear() {
    let beside =
        |interaction: &str| format!(r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{interaction}]"#);
    SHEARED.accepted(&[r#"integrator={"type":"cotter-reich"}"#]);
    SHEARED.accepted(&[r#"interactions.0.bath={"type":"memory","rate":3}"#]);
    for interaction in [
        r#"{"type":"langevin","friction":1}"#,
        r#"{"type":"langevin","friction":1,"velocity":"laboratory"}"#,
        r#"{"type":"langevin","friction":1,"velocity":"peculiar","bath":{"type":"memory","rate":3}}"#,
        r#"{"type":"coloured-noise","strength":1,"time":0.05}"#,
    ] {
        SHEARED.accepted(&[&beside(interaction)]);
    }
    let unknown = beside(r#"{"type":"langevin","friction":1,"velocity":"thermal"}"#);
    SHEARED.refused_with(&[&unknown], &["interactions[1].velocity", "\"peculiar\"", "\"laboratory\""]);
    let laboratory = beside(r#"{"type":"langevin","friction":1,"velocity":"laboratory"}"#);
    let warned = SHEARED.warnings(&[&laboratory]).join(" ");
    assert!(warned.contains("interactions[1].velocity: friction relative to the box slows the flow"), "{warned}");
    SHEARED.refused_with(
        &[&laboratory, r#"space={"box":[10,10,10]}"#],
        &["interactions[1].velocity: found in a box without shear", "no `velocity`"],
    );
}

/// Whatever is bound to a box at rest is refused with the reason.
#[test]
fn what_takes_no_shear() {
    SHEARED.refused_with(
        &["particles.0.fixed=true"],
        &["space.shear: found together with fixed particles in particles[0].fixed", "(physics: images of a fixed"],
    );
    let beside =
        |interaction: &str| format!(r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{interaction}]"#);
    SHEARED.refused_with(
        &[&beside(r#"{"type":"tether","stiffness":3}"#)],
        &["space.shear: found together with tethers in interactions[1]", "images of the end of a tether"],
    );
    SHEARED.refused_with(
        &[r#"space.walls={"z":{}}"#],
        &["space.shear: found together with walls in space.walls", "walls that move make a shear flow too"],
    );
    let force = r#"{"type":"body-force","force":[1,0,0],"profile":"sinusoidal","axis":"z"}"#;
    SHEARED.accepted(&[&beside(force)]);
    SHEARED.accepted(&[&beside(r#"{"type":"body-force","force":[1,0,0]}"#)]);
    SHEARED.refused_with(
        &[&beside(&force.replace("\"z\"", "\"x\""))],
        &[
            "interactions[1].axis: found \"x\", along the flow of `space.shear`",
            "images of a place have the same force",
        ],
    );
    for other in [r#"{"type":"voronoi","viscosity":1}"#, r#"{"type":"shallow-water","mesh":[16,16],"wave_speed":1}"#] {
        let problems = SHEARED.problems(&["space.box=[10,10]", &format!("interactions=[{other}]")]);
        assert!(problems.iter().any(|problem| problem.contains("space.shear: found in a scene of ")), "{problems:#?}");
    }
    SHEARED.refused_with(
        &[r#"output.stress={"every":1,"window":8}"#],
        &["output.stress.window: found together with shear in space.shear", "that of the mean stress"],
    );
    SHEARED.accepted(&[r#"output.stress={"every":10}"#, r#"output.profiles={"axis":"y","every":10}"#]);
    for (name, frameless) in [
        ("autocorrelations", r#"{"quantity":"velocity","every":2,"window":8}"#),
        ("histograms", r#"{"quantity":"velocity","every":2,"range":4}"#),
    ] {
        SHEARED.accepted(&[&format!("output.{name}=[{frameless}]")]);
        let framed = frameless.replace('}', r#","frame":"centre-of-mass"}"#);
        let found = format!("output.{name}[0].frame: found `centre-of-mass` in a scene with shear");
        SHEARED.refused_with(&[&format!("output.{name}=[{framed}]")], &[&found, "linear profile"]);
    }
    for analysis in [
        r#"diffusion={"every":2,"window":8}"#,
        r#"radial_distribution={"every":10,"range":2}"#,
        r#"viscosity={"every":2,"window":8}"#,
    ] {
        let name = analysis.split('=').next().unwrap();
        let named = format!("output.{name}: found together with shear in space.shear");
        SHEARED.refused_with(&[&format!("output.{analysis}")], &[&named, &format!("`{name}` without shear (")]);
    }
    let chains = r#"particles=[{"species":"water","count":300,"chain":{"beads":5,"spacing":0.8}}]"#;
    let bonds = beside(r#"{"type":"bonds","potential":{"type":"harmonic","stiffness":10}}"#);
    SHEARED.accepted(&[r#"output.chain_sizes={"every":10}"#, chains, &bonds]);
}
