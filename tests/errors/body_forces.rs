//! Body forces with mistakes.

use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const WATER: &str = r#"interactions.1.species=["water"]"#;
const DRIVEN: Correct = Correct(base);

fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [{"species": "water", "count": 300}, {"species": "rock", "count": 30, "mass": 2}],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "body-force", "profile": "opposed", "axis": "y", "force": [1, 0, 0]},
        ],
    })
}

#[test]
fn the_base_is_right_and_keeps_its_integrator() {
    let scene = DRIVEN.accepted(&[]);
    assert!(matches!(
        scene.system.particle_integrator(),
        Some(mesoscope::scene::Integrator::Splitting { relaxation: Some(_) })
    ));
    assert_eq!(DRIVEN.warnings(&[]), Vec::<String>::new());
}

#[test]
fn profiles_and_axes() {
    DRIVEN.refused_with(&["interactions.1.axis=null"], &["interactions[1].axis: found none", "an `axis` along which"]);
    DRIVEN.refused_with(&[r#"interactions.1.profile="uniform""#], &["interactions[1].axis: found one", "no `axis`"]);
    DRIVEN.refused_with(&[r#"interactions.1.axis="w""#], &["interactions[1].axis"]);
    DRIVEN.refused_with(
        &["interactions.1.waves=2"],
        &["interactions[1].waves: found 2", "no `waves`, or the profile `sinusoidal`"],
    );
    DRIVEN.refused_with(
        &[r#"interactions.1.profile="sinusoidal""#, "interactions.1.waves=0"],
        &["interactions[1].waves"],
    );
    DRIVEN.refused_with(
        &["space.box=[10,10]", "interactions.1.force=[1,0]", r#"interactions.1.axis="z""#],
        &[r#"interactions[1].axis: found "z""#, "one of the 2 axes of the box"],
    );
    DRIVEN.refused_with(&["interactions.1.force=[1,0]"], &["interactions[1].force: found 2 components", "3, one for"]);
    DRIVEN.refused_with(&["interactions.1.force=[]"], &["interactions[1].force"]);
    DRIVEN.refused_with(
        &[r#"interactions=[{"type":"body-force","force":[1,0,0],"species":["rock"]},
            {"type":"body-force","profile":"sinusoidal","axis":"x","force":[1,0,0]}]"#],
        &["interactions[1]: found a body force of another profile", "than interactions[0]"],
    );
    DRIVEN.accepted(&[
        r#"interactions=[{"type":"body-force","profile":"opposed","axis":"y","force":[0,0,3],"species":["rock"]},
            {"type":"body-force","profile":"opposed","axis":"y","force":[0,0,1]}]"#,
    ]);
}

#[test]
fn species() {
    DRIVEN.refused_with(&[r#"interactions.1.species=["watr"]"#], &["interactions[1].species[0]", "water"]);
    DRIVEN.refused_with(
        &[r#"interactions.1.species=["rock"]"#, "particles.1.fixed=true"],
        &["interactions[1].species[0]: found `rock`, whose particles are fixed"],
    );
    DRIVEN.accepted(&["particles.1.fixed=true"]);
}

/// The impulse of half a step has to fit 2²⁷ units of momentum, and not to vanish in 2⁻²⁴ of one.
#[test]
fn strengths() {
    for force in ["4000", "-1e30"] {
        let force = format!("interactions.1.force=[0,{force},0]");
        DRIVEN.refused_with(
            &[&force, WATER],
            &["interactions[1].force: found ", "species `water`", "accepted: less than "],
        );
    }
    DRIVEN.refused_with(&["interactions.1.force=[0,1e-15,0]", WATER], &["accepted: at least ", "or no force"]);
    DRIVEN.accepted(&["interactions.1.force=[0,100,1e-6]"]);
}

#[test]
fn families_without_body_forces() {
    for other in [r#"{"type":"voronoi","viscosity":1}"#, r#"{"type":"shallow-water","mesh":[16,16],"wave_speed":1}"#] {
        let problems =
            DRIVEN.problems(&["space.box=[10,10]", &format!("interactions.0={other}"), "interactions.1.force=[1,0]"]);
        assert!(problems.iter().any(|problem| problem.contains("only interaction")), "{problems:#?}");
    }
}
