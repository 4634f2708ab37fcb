//! Many-body repulsions with mistakes.

use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const LIQUID: Correct = Correct(base);

fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [{"species": "water", "count": 6000}, {"species": "oil", "count": 300}],
        "interactions": [{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25}}],
    })
}

#[test]
fn the_base_is_right_and_keeps_its_integrator() {
    let scene = LIQUID.accepted(&[]);
    assert!(matches!(
        scene.system.particle_integrator(),
        Some(mesoscope::scene::Integrator::Splitting { relaxation: Some(_) })
    ));
    // Attraction alone would be warned of.
    assert_eq!(LIQUID.warnings(&[]), Vec::<String>::new());
    assert!(LIQUID.warnings(&["interactions.0.many_body.repulsion=0"]).join(" ").contains("collapse"));
    let steep = LIQUID.warnings(&["time.step=0.05"]).join(" ");
    assert!(steep.contains("repulsion shakes"), "{steep}");
}

#[test]
fn ranges_and_strengths() {
    LIQUID.refused_with(
        &["interactions.0.many_body.cutoff=1.1"],
        &["interactions[0].many_body.cutoff: found 1.1", "at most 1, the largest cutoff"],
    );
    LIQUID.accepted(&[
        "interactions.0.many_body.cutoff=1.1",
        r#"interactions.0.pairs=[{"between":["oil","oil"],"cutoff":1.2}]"#,
    ]);
    LIQUID.refused_with(&["interactions.0.many_body.cutoff=0.009"], &["many_body.cutoff", "at least 0.01"]);
    LIQUID.refused_with(&["interactions.0.many_body.cutoff=0"], &["many_body.cutoff"]);
    LIQUID.refused_with(&["interactions.0.many_body.repulsion=-25"], &["many_body.repulsion: found -25"]);
    LIQUID.refused_with(&[r#"interactions.0.many_body={"repulsion":25,"range":1}"#], &["many_body.range"]);
}

/// The interactions with one more.
fn beside(other: &str) -> String {
    format!(r#"interactions=[{{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{{"repulsion":25}}}},{other}]"#)
}

/// The force derives from a potential only if all pairs have the same coefficients.
#[test]
fn coefficients_of_pairs_of_species() {
    let own =
        |many_body: &str| format!(r#"interactions.0.pairs=[{{"between":["oil","oil"],"many_body":{many_body}}}]"#);
    LIQUID.accepted(&[&own(r#"{"repulsion":25}"#)]);
    LIQUID.refused_with(
        &[&own(r#"{"repulsion":20}"#)],
        &["interactions[0].pairs[0].many_body: found another", "no potential", "doi:10.1103/PhysRevE.87.045303"],
    );
    LIQUID.refused_with(&[&own(r#"{"repulsion":25}"#), "interactions.0.many_body=null"], &["pairs[0].many_body"]);
}

#[test]
fn what_it_does_not_go_with() {
    LIQUID.refused_with(
        &[r#"interactions.0.bath={"type":"memory","rate":5}"#, r#"integrator={"type":"cotter-reich"}"#],
        &[
            "interactions[0]: found together with a many-body repulsion in interactions[0].many_body",
            "are found in cells",
        ],
    );
    let rubbing = beside(r#"{"type":"bonds","pairs":[[0,1]],"friction":1}"#);
    LIQUID.accepted(&[&rubbing, r#"integrator={"type":"cotter-reich"}"#]);
    LIQUID.accepted(&[&rubbing, "particles.1.fixed=true", r#"integrator={"type":"splitting"}"#]);
    for beside in [
        beside(r#"{"type":"coloured-noise","strength":1,"time":0.1}"#),
        beside(r#"{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}}"#),
        beside(r#"{"type":"tether","stiffness":1}"#),
    ] {
        LIQUID.accepted(&[&beside, "particles.1.fixed=true"]);
    }
    LIQUID.refused_with(
        &[&beside(r#"{"type":"bonds","pairs":[[0,1]],"exclude_repulsion":true}"#)],
        &["interactions[0].many_body: found together with `exclude_repulsion` in interactions[1]"],
    );
    // Without strength it is as if it were not there.
    let memory = r#"interactions.0.bath={"type":"memory","rate":5}"#;
    LIQUID.accepted(&["interactions.0.many_body.repulsion=0", memory]);
}
