//! The published schema and the shipped scenes against each other, judged by an independent validator.

use mesoscope::scene::{self, Scene};
use serde_json::{Value, json};

fn shipped() -> Vec<(&'static str, Value)> {
    scene::builtin().iter().map(|builtin| (builtin.name, serde_json::from_str(builtin.text).unwrap())).collect()
}

#[test]
fn every_scene_file_is_built_in() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes");
    let mut files: Vec<String> = std::fs::read_dir(directory)
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    let mut names: Vec<&str> = scene::builtin().iter().map(|builtin| builtin.name).collect();
    files.sort();
    names.sort_unstable();
    assert_eq!(files, names);
}

#[test]
fn shipped_scenes_satisfy_the_schema() {
    let validator = jsonschema::draft202012::new(&scene::schema()).expect("the schema is a schema");
    for (name, document) in shipped() {
        let errors: Vec<String> = validator.iter_errors(&document).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
}

#[test]
fn shipped_scenes_load_without_warnings() {
    for (name, _) in shipped() {
        let scene = scene::load(name, &[]).unwrap_or_else(|error| panic!("{error}"));
        let warnings = mesoscope::families::warnings(&scene);
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
        assert!(scene.description.len() > 200, "{name} says what to expect");
    }
}

#[test]
fn shipped_scenes_survive_serialisation() {
    let validator = jsonschema::draft202012::new(&scene::schema()).unwrap();
    for (name, _) in shipped() {
        let scene = scene::load(name, &[]).unwrap();
        let written = serde_json::to_value(&scene).unwrap();
        assert!(validator.is_valid(&written), "{name}: the resolved scene satisfies the schema");
        assert_eq!(serde_json::from_value::<Scene>(written.clone()).unwrap(), *scene, "{name}");
        assert_eq!(scene::parse(name, &written.to_string(), &[]).unwrap(), scene, "{name}");
    }
}

/// The program's own reading of the schema agrees with the validator's on what is right and what is wrong.
#[test]
fn both_validators_agree() {
    let validator = jsonschema::draft202012::new(&scene::schema()).unwrap();
    let base = &shipped()[0].1;
    let changes = [
        ("/temperature", json!(-1)),
        ("/temperature", json!("hot")),
        ("/temperature", json!(null)),
        ("/temperature", json!(0)),
        ("/seed", json!(-1)),
        ("/seed", json!(1.5)),
        ("/seed", json!(7.0)),
        ("/seed", json!(u64::MAX)),
        ("/version", json!(2)),
        ("/title", json!("")),
        ("/space/box", json!([])),
        ("/space/box", json!([1, 2, 3, 4])),
        ("/space/box", json!([20, 0, 20])),
        ("/time/step", json!(0)),
        ("/time", json!({"step": 0.01})),
        ("/time", json!({"step": 0.01, "steps": 5, "stop": 6})),
        ("/integrator", json!({"type": "splitting", "lambda": 0.5})),
        ("/integrator", json!({"type": "groot-warren", "lambda": 0.5})),
        ("/integrator", json!({"type": "groot-warren", "lambda": 1.5})),
        ("/integrator", json!({"type": "leapfrog"})),
        ("/integrator", json!({})),
        ("/integrator", json!("splitting")),
        ("/particles/0/mass", json!(-1)),
        ("/particles/0", json!({"species": "A", "count": null, "number_density": 3})),
        ("/particles/0", json!({"species": "A", "count": 3})),
        ("/particles/0", json!({"species": "A", "count": 3, "number_density": 3})),
        ("/particles/0", json!({"species": "A"})),
        ("/particles/0", json!({"species": "A", "placement": {"type": "listed", "positions": [[1, 2, 3]]}})),
        (
            "/particles/0",
            json!({"species": "A", "count": 1, "placement": {"type": "listed", "positions": [[1, 2, 3]]}}),
        ),
        (
            "/particles/0",
            json!({"species": "A", "number_density": 1, "placement": {"type": "listed", "positions": [[1, 2, 3]]}}),
        ),
        ("/particles/0/placement", json!({"type": "random", "extra": 1})),
        ("/particles/0/placement", json!({"type": "listed"})),
        ("/interactions/0", json!({"type": "dpd", "fricton": 1})),
        ("/interactions/0/pairs", json!([{"between": ["fluid"]}])),
        ("/interactions/0/pairs", json!([{"between": ["fluid", "fluid", "fluid"]}])),
        ("/interactions", json!({})),
        ("/output/trajectory", json!(null)),
        ("/output/trajectory", json!({"every": 10, "format": "extended-xyz"})),
        ("/output/trajectory", json!({"every": 10, "format": "pdb"})),
        ("/output/radial_distribution/bins", json!(5000)),
        ("/output/snapshot", json!({"color": "speed", "radius": 0})),
        ("/output/plot", json!({"theme": "dark", "width": 100})),
    ];
    let mut right = 0;
    for (pointer, value) in changes {
        let mut document = base.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Object(object) => drop(object.insert(key.to_owned(), value.clone())),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            _ => unreachable!("parents are objects and lists"),
        }
        let ours = scene::parse("changed", &document.to_string(), &[]);
        let theirs = validator.is_valid(&document);
        right += usize::from(theirs);
        assert_eq!(ours.is_ok(), theirs, "{pointer} = {value}: {ours:?}");
        assert!(!matches!(ours, Err(scene::SceneError::SchemaMismatch { .. })), "{pointer} = {value}: {ours:?}");
    }
    assert!(right > 5, "some of the changes are right: {right}");
}
