//! What reaches a terminal is text, whatever scenes and names hold and whatever the environment lacks.

use serde_json::json;

use crate::support::program::{Place, command, mesoscope, succeeds, text};

/// Clears the screen, colours what follows, returns to the start of the line and turns the direction of writing round.
const NASTY: &str = "\u{1b}[2J\u{1b}[31m\r\u{9b}0m\u{7}\u{202e}\u{2066}\nerror: forged\u{2028}";

fn place() -> Place {
    Place::of(json!({
        "title": format!("title{NASTY}"),
        "space": {"box": [4, 4, 4]},
        "time": {"step": 0.03, "steps": 4},
        "temperature": 1,
        "particles": [{"species": format!("species{NASTY}"), "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"plot": {"width": 320, "height": 240}, "snapshot": {"width": 64, "height": 64}},
    }))
}

/// Nothing but line breaks acts on the terminal, and no line was forged.
#[track_caller]
fn harmless(arguments: &[&str], code: i32) -> String {
    let output = mesoscope(arguments);
    let said = [text(&output.stdout), text(&output.stderr)].concat();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said:?}");
    let acts = |c: char| c.is_control() && c != '\n' || "\u{202e}\u{2066}\u{2028}".contains(c);
    assert!(!said.contains(acts), "{arguments:?}: {said:?}");
    assert!(!said.lines().any(|line| line.starts_with("error: forged")), "{arguments:?}: {said}");
    said
}

#[test]
fn what_scenes_say_is_escaped() {
    let place = place();
    let (scene, out) = (place.scene(), place.argument("out"));
    let said = harmless(&["run", &scene, "--out", &out], 0);
    assert!(
        said.starts_with(
            r"title\u{1b}[2J\u{1b}[31m\r\u{9b}0m\u{7}\u{202e}\u{2066}\nerror: forged\u{2028}: 192 particles"
        ),
        "{said}"
    );
    harmless(&["check", &scene], 0);
    harmless(&["sweep", &scene, "--vary", "seed=1,2", "--out", &place.argument("swept")], 0);
    // Warnings name the species: this friction is too strong for the step.
    let said = harmless(&["check", &scene, "--set", "interactions.0.friction=100"], 0);
    assert!(said.contains(r"`species\u{1b}[2J"), "{said}");
    // So do mistakes, and they name keys.
    let pair = format!(r#"interactions.0.pairs=[{{"between":["species","{}"]}}]"#, "other\\u001b[2J\\nerror: forged");
    harmless(&["check", &scene, "--set", &pair], 2);
    let key = format!("key{NASTY}");
    harmless(&["check", &place.with("/space", json!({"box": [4, 4, 4], key: 1})).scene()], 2);
}

#[test]
fn names_of_files_are_escaped() {
    let place = place();
    let scene = place.scene();
    let out = place.argument(&format!("out{NASTY}"));
    let said = harmless(&["run", &scene, "--out", &out], 0);
    assert!(said.contains(r"out\u{1b}[2J\u{1b}[31m\r"), "{said}");
    harmless(&["resume", &out], 0);
    harmless(&["plot", &out], 0);
    harmless(&["run", &scene, "--out", &out], 5);
    harmless(&["run", &place.argument(&format!("none{NASTY}"))], 2);
    let broken = place.argument(&format!("broken{NASTY}.json"));
    std::fs::write(&broken, "{").unwrap();
    harmless(&["check", &broken], 2);
    harmless(&["resume", &place.argument(&format!("no run{NASTY}"))], 5);
}

/// Mesa's layer that selects devices looks for a display there, and complains once for every adapter.
#[test]
fn a_missing_runtime_directory_is_not_complained_about() {
    for directory in [None, Some(""), Some("relative"), Some("/nonexistent")] {
        for arguments in [&["adapters"][..], &["check", "dpd-fluid"]] {
            let mut command = command(arguments);
            match directory {
                None => command.env_remove("XDG_RUNTIME_DIR"),
                Some(directory) => command.env("XDG_RUNTIME_DIR", directory),
            };
            let output = command.output().unwrap();
            assert!(output.status.success());
            assert_eq!(text(&output.stderr), "", "{directory:?} {arguments:?}");
        }
    }
}

#[test]
fn short_runs_and_seeds_need_no_settings() {
    let place = place()
        .with("/title", json!("fluid"))
        .with("/particles/0/species", json!("A"))
        .with("/time", json!({"step": 0.03, "steps": 4000, "equilibration": 1000}))
        .with("/output/diffusion", json!({"every": 5, "window": 100}));
    let (scene, out) = (place.scene(), place.argument("out"));
    let output = mesoscope(&["run", &scene, "--out", &out, "--steps", "20", "--seed", "7"]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    let equilibration = "time.equilibration: shortened from 1000 to 5 of 20 steps";
    let window = "output.diffusion.window: shortened from 100 samples of 5 steps to 3 of 5 steps";
    assert!(said.contains(&format!("note: {equilibration}\nnote: {window}\n")), "{said}");
    assert!(said.matches(equilibration).count() == 1, "said once: {said}");
    let summary = |name: &str| {
        let path = place.path(name).join(mesoscope::output::files::SUMMARY);
        mesoscope::output::Summary::load(&path).unwrap()
    };
    let found = summary("out");
    assert_eq!((found.scene.seed, found.scene.time.steps, found.scene.time.equilibration), (7, 20, 5));
    assert_eq!(&found.warnings[..2], [equilibration, window]);
    // A resumed run says so too.
    succeeds(&["resume", &out, "--steps", "25", "--quiet"]);
    assert_eq!(&summary("out").warnings[..2], [equilibration, window]);
    let said = harmless(&["check", &scene, "--steps", "20", "--seed", "7"], 0);
    assert!(said.contains(equilibration), "{said}");
    // What is set stays as it is set.
    let said = harmless(&["check", &scene, "--steps", "20", "--set", "time.equilibration=30"], 2);
    assert!(said.contains("time.equilibration: found 30"), "{said}");
    let swept = place.argument("swept");
    let vary = ["--vary", "interactions.0.friction=1,2"];
    let sweep = [&["sweep", &scene, "--out", &swept, "--steps", "20", "--seed", "9"], &vary[..]].concat();
    let said = harmless(&sweep, 0);
    assert!(said.contains(&format!("note: {equilibration}\n")), "{said}");
    let found = summary("swept/friction=2");
    assert_eq!((found.scene.seed, found.scene.time.equilibration, found.warnings[0].as_str()), (9, 5, equilibration));
    succeeds(&["sweep", "--resume", &swept, "--quiet"]);
}
