//! Walls with mistakes.

use serde_json::{Value, json};

use crate::support::mistakes::Correct;
use mesoscope::scene::{Integrator, PairRelaxation};

const CHANNEL: Correct = Correct(base);

fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [10, 10, 10], "walls": {"z": {"upper_velocity": [1, 0, 0]}}},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [{"species": "water", "count": 300}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
    })
}

#[test]
fn the_base_is_right_and_keeps_its_integrator() {
    let scene = CHANNEL.accepted(&[]);
    assert_eq!(
        *scene.system.particle_integrator().unwrap(),
        Integrator::Splitting { relaxation: Some(PairRelaxation::MeanField) }
    );
    assert_eq!(CHANNEL.warnings(&[]), Vec::<String>::new());
}

#[test]
fn axes_and_velocities() {
    CHANNEL.refused_with(
        &["space.box=[10,10]", r#"space.walls={"z":{}}"#],
        &["space.walls.z: found on an axis that the box has not", "one of the 2 axes of the box"],
    );
    CHANNEL.refused_with(&[r#"space.walls={"w":{}}"#], &["space.walls.w"]);
    CHANNEL.refused_with(&[r#"space.walls.z.reflection="sticky""#], &["space.walls.z.reflection", "bounce-back"]);
    CHANNEL.refused_with(
        &["space.walls.z.lower_velocity=[1,0]"],
        &["space.walls.z.lower_velocity: found 2 components", "3, one for each axis"],
    );
    CHANNEL.refused_with(
        &["space.walls.z.upper_velocity=[0,0,0.5]"],
        &["space.walls.z.upper_velocity: found 0.5 along z, across the wall", "walls move along themselves"],
    );
    CHANNEL.refused_with(
        &[r#"space.walls.z.reflection="specular""#],
        &["space.walls.z.upper_velocity: found a velocity of a wall with specular reflection", "bounce-back"],
    );
    CHANNEL.refused_with(
        &["space.walls.x={}"],
        &["space.walls.z.upper_velocity: found 1 along x, across which there are walls too", "axes without walls"],
    );
    CHANNEL.refused_with(
        &["space.walls.y={}"],
        &[
            "space.walls.z.upper_velocity: found a wall that moves beside walls across y",
            "or `specular` reflection across y",
        ],
    );
    CHANNEL.accepted(&[r#"space.walls.y={"reflection":"specular"}"#]);
    CHANNEL.accepted(&[r#"space.walls={"x":{"reflection":"specular","lower_velocity":[0,0,0]},"y":{}}"#]);
}

#[test]
fn walls_are_two_cutoffs_apart() {
    CHANNEL.refused_with(
        &["space.box=[10,10,1.5]"],
        &["space.box[2]: found 1.5", "at least 2, two cutoffs of 1: walls nearer to each other"],
    );
    CHANNEL.accepted(&["space.box=[10,10,2]"]);
}

/// A step in which a wall takes particles further than the cutoff cannot be right.
#[test]
fn fast_walls() {
    CHANNEL.accepted(&["space.walls.z.upper_velocity=[20,0,0]"]);
}

const HARMONIC_CHAIN: &str = r#"interactions=[{"type":"harmonic-chain","cluster_size":16,"spacing":16.0,
    "pulse":{"clusters":200,"width":2.0,"amplitude":32.0},"equilibrium":{"clusters":1024}}]"#;

/// Whatever is bound to a periodic box is refused with the reason.
#[test]
fn what_takes_no_walls() {
    let langevin = r#"interactions=[{"type":"langevin","friction":1}]"#;
    for accepted in [r#"interactions.0.bath={"type":"memory","rate":3}"#, langevin, "particles.0.fixed=true"] {
        CHANNEL.accepted(&[accepted]);
    }
    let tethers = r#"interactions=[{"type":"dpd","repulsion":25},{"type":"tether","stiffness":3}]"#;
    CHANNEL.refused_with(
        &[tethers],
        &["space.walls: found together with tethers in interactions[1]; accepted: walls without tethers (physics:"],
    );
    let chains = ["space.box=[2048]", r#"space.walls={"x":{}}"#, "particles=[]", HARMONIC_CHAIN];
    let problems = CHANNEL.problems(&chains);
    let named = "space.walls: found together with harmonic chains in interactions[0]";
    assert!(problems.iter().any(|problem| problem.contains(named)), "{problems:#?}");
    for other in [r#"{"type":"voronoi","viscosity":1}"#, r#"{"type":"shallow-water","mesh":[16,16],"wave_speed":1}"#] {
        let changes = ["space.box=[10,10]", r#"space.walls={"y":{}}"#, &format!("interactions=[{other}]")];
        let problems = CHANNEL.problems(&changes);
        assert!(problems.iter().any(|problem| problem.contains("space.walls: found in a scene of ")), "{problems:#?}");
    }
    CHANNEL.accepted(&[r#"output.radial_distribution={"every":10,"range":2}"#]);
    CHANNEL.refused_with(
        &[r#"output.viscosity={"every":2,"window":8}"#],
        &["output.viscosity: found together with walls in space.walls", "have the viscosity of a flow"],
    );
    for profile in ["opposed", "sinusoidal"] {
        let force = |axis: &str| {
            format!(
                r#"interactions=[{{"type":"dpd","repulsion":25}},
                    {{"type":"body-force","force":[1,0,0],"profile":"{profile}","axis":"{axis}"}}]"#
            )
        };
        CHANNEL.refused_with(
            &[&force("z")],
            &[r#"interactions[1].axis: found "z", across which there are walls"#, "uniform"],
        );
        CHANNEL.accepted(&[&force("y")]);
    }
}

/// Positions that are listed lie between the walls, which a periodic axis takes modulo the box; what is at a wall is taken in.
#[test]
fn places_behind_walls() {
    let listed = |position: &str| {
        format!(r#"particles=[{{"species":"water","placement":{{"type":"listed","positions":[[1,1,1],{position}]}}}}]"#)
    };
    for (position, found) in [("[1,1,10.5]", "found 10.5"), ("[1,1,-0.001]", "found -0.001")] {
        CHANNEL.refused_with(
            &[&listed(position)],
            &["particles[0].placement.positions[1][2]", found, "behind a wall", "0 to 10, between the walls"],
        );
    }
    CHANNEL.accepted(&[&listed("[1,-5,5]")]);
    let scene = CHANNEL.accepted(&[&listed("[1,1,10]")]);
    let (model, state) = crate::support::start(&scene);
    assert_eq!(state.positions[1][2], model.units.ends()[2] - 1);
    CHANNEL.refused_with(
        &[
            "space.box=[10,10]",
            r#"space.walls={"y":{}}"#,
            r#"particles=[{"species":"water","count":9,"placement":{"type":"circle","center":[5,2],"radius":3}}]"#,
        ],
        &["particles[0].placement: found a circle of radius 3 that reaches behind a wall across y"],
    );
}

/// Bonds lead through no wall.
#[test]
fn bonds_through_walls() {
    let bonded = |positions: &str| {
        [
            format!(r#"particles=[{{"species":"water","placement":{{"type":"listed","positions":{positions}}}}}]"#),
            r#"interactions=[{"type":"dpd","repulsion":25},{"type":"bonds","pairs":[[0,1]],"potential":{"type":"harmonic","stiffness":2}}]"#
                .to_owned(),
        ]
    };
    let [particles, interactions] = bonded("[[1,1,0.25],[1,1,9.75]]");
    CHANNEL.refused_with(
        &[&particles, &interactions],
        &["space.walls.z: found a bond between particles 0 and 1, 9.5000 apart along z", "lead through no wall"],
    );
    let [particles, interactions] = bonded("[[1,0.25,4],[1,9.75,4.5]]");
    CHANNEL.accepted(&[&particles, &interactions]);
}

const LAYER: &str =
    r#"{"species":"wall","number_density":3,"placement":{"type":"behind-walls","axis":"z","thickness":1}}"#;

/// A layer with a change, beside the fluid.
fn layer(changes: &[&str]) -> String {
    let mut layer: Value = serde_json::from_str(LAYER).unwrap();
    for change in changes {
        let (path, value) = change.split_once('=').unwrap();
        match path.split_once('.') {
            Some((first, second)) => layer[first][second] = serde_json::from_str(value).unwrap(),
            None => layer[path] = serde_json::from_str(value).unwrap(),
        }
    }
    format!(r#"particles=[{{"species":"water","count":300}},{layer}]"#)
}

#[test]
fn layers_behind_walls() {
    let scene = CHANNEL.accepted(&[&layer(&[])]);
    assert_eq!(
        *scene.system.particle_integrator().unwrap(),
        Integrator::Splitting { relaxation: Some(PairRelaxation::MeanField) }
    );
    assert_eq!(CHANNEL.warnings(&[&layer(&[])]), Vec::<String>::new());
    let (model, state) = crate::support::start(&scene);
    assert_eq!((model.mobile_particles(), state.len()), (300, 900));
    CHANNEL.refused_with(
        &["space.walls={}", &layer(&[])],
        &[r#"particles[1].placement.axis: found "z", across which there are no walls"#, "into `space.walls.z`"],
    );
    CHANNEL.refused_with(
        &["space.box=[10,10]", r#"space.walls={"y":{}}"#, &layer(&[])],
        &[r#"particles[1].placement.axis: found "z""#, "one of the 2 axes of the box"],
    );
    for thickness in ["0", "-1"] {
        CHANNEL.refused_with(
            &[&layer(&[&format!("placement.thickness={thickness}")])],
            &["particles[1].placement.thickness"],
        );
    }
    CHANNEL.refused_with(
        &[&layer(&["placement.thickness=11"])],
        &["particles[1].placement.thickness: found 11", "at most 10, the distance of the walls"],
    );
    CHANNEL.refused_with(&[&layer(&[r#"placement.wall="left""#])], &["particles[1].placement.wall", "lower"]);
    CHANNEL.refused_with(
        &[&layer(&[r#"species="water""#])],
        &["particles[1].species: found `water`", "another name than `water` in particles[0]"],
    );
    CHANNEL.refused_with(
        &[&layer(&["fixed=true"])],
        &["particles[1].fixed: found true", "particles behind walls are frozen"],
    );
    CHANNEL.refused_with(
        &[&layer(&[r#"velocities={"type":"rest"}"#])],
        &["particles[1].velocities: found velocities", "that of their wall"],
    );
    CHANNEL.refused_with(&[&layer(&[r#"chain={"beads":3}"#])], &["particles[1].chain: found a chain"]);
    let noise = r#"interactions=[{"type":"dpd","repulsion":25},{"type":"coloured-noise","strength":1,"time":1}]"#;
    CHANNEL.accepted(&[&layer(&[]), noise]);
    let warnings = CHANNEL.warnings(&[&layer(&["placement.thickness=0.9"])]);
    assert!(warnings.iter().any(|warning| warning.contains("less than the cutoff of 1")), "{warnings:?}");
    // Specular walls move if something behind them drags the fluid along.
    CHANNEL.accepted(&[r#"space.walls.z.reflection="specular""#, &layer(&[])]);
    CHANNEL.accepted(&[&layer(&[]), r#"output.diffusion={"every":2,"window":8}"#]);
}

/// All that goes together with no layer, at once.
#[test]
fn what_takes_no_layers() {
    let other = r#"{"species":"end","count":9,"placement":{"type":"behind-walls","axis":"x","thickness":1}}"#;
    let two = layer(&[]).replace("}}]", &format!("}}}},{other}]"));
    let interactions = r#"interactions=[{"type":"dpd","repulsion":25,"many_body":{"repulsion":9}},
        {"type":"langevin","friction":1},
        {"type":"bonds","pairs":[[0,1],[1,300]],"potential":{"type":"harmonic","stiffness":2}},
        {"type":"bonds","pairs":[[301,3]],"friction":1},
        {"type":"body-force","force":[1,0,0],"species":["wall"]}]"#;
    let changes = [
        r#"space.walls={"x":{},"z":{}}"#,
        &two,
        interactions,
        r#"output.stress={"every":2}"#,
        r#"output.profiles={"axis":"z","every":2,"quantities":["stress"]}"#,
    ];
    let problems = CHANNEL.problems(&changes);
    for expected in [
        r#"particles[2].placement.axis: found "x" beside "z" in particles[1]"#,
        "interactions[0].many_body: found together with layers of frozen particles in particles[1].placement",
        "interactions[2].pairs[1]: found particle 300, which is frozen",
        "interactions[3].pairs[0]: found particle 301, which is frozen",
        "interactions[4].species[0]: found `wall`",
        "output.stress: found together with layers of frozen particles",
        "output.profiles.quantities: found together with layers of frozen particles",
    ] {
        assert!(problems.iter().any(|problem| problem.contains(expected)), "{expected}\n{problems:#?}");
    }
}
