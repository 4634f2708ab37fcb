//! The examples of the README: its scene is correct, and its commands run as they stand there.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::process::Command;

const README: &str = include_str!("../README.md");

/// The contents of all fenced blocks of a language.
fn blocks(language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    README.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

fn mesoscope(directory: &std::path::Path, arguments: &[&str]) {
    let output = Command::new(env!("CARGO_BIN_EXE_mesoscope"))
        .current_dir(directory)
        .args(arguments)
        .output()
        .expect("the program starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "mesoscope {arguments:?}: {errors}");
}

#[test]
fn the_scene_of_the_program_is_correct() {
    let programs = blocks("rust,no_run");
    let loads: Vec<&str> = programs.iter().flat_map(|program| program.split("scene::load(").skip(1)).collect();
    assert!(!loads.is_empty());
    for load in loads {
        let call = load.split_once(")?").unwrap().0;
        let mut texts = call.split('"').skip(1).step_by(2);
        let (name, changes) = (texts.next().unwrap(), texts.map(str::to_owned).collect::<Vec<_>>());
        if let Err(error) = mesoscope::scene::load(name, &changes) {
            panic!("scene::load({call}): {error}");
        }
    }
}

#[test]
fn the_commands_run() {
    let directory = tempfile::tempdir().unwrap();
    let commands: Vec<String> =
        blocks("console").iter().flat_map(|block| block.lines().map(str::to_owned).collect::<Vec<_>>()).collect();
    assert!(commands.len() >= 8, "found only {commands:?}");
    for command in &commands {
        let mut arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
        // Fewer steps of fewer particles, or the README would take minutes.
        if arguments.first() == Some(&"run") {
            arguments.extend(["--steps", "40"]);
            if arguments[1].starts_with("dpd") {
                arguments.extend(["--set", "space.box=[6,6,6]", "--set", "time.equilibration=20"]);
                arguments.extend(["--set", "output.radial_distribution.every=10"]);
            }
            if arguments[1].starts_with("edpd") {
                arguments.extend(["--set", "time.equilibration=0", "--set", "output.diffusion.window=4"]);
            }
        }
        if arguments.first() == Some(&"resume") {
            let steps = arguments.iter().position(|argument| *argument == "--steps").expect("steps to go on to") + 1;
            let shipped: u64 = mesoscope::scene::load("dpd-fluid", &[]).unwrap().time.steps;
            assert!(arguments[steps].parse::<u64>().unwrap() > shipped, "nothing would be left to do");
            arguments[steps] = "60";
        }
        mesoscope(directory.path(), &arguments);
    }
    for file in [
        "dpd-fluid/energies.png",
        "dpd-fluid/run.json",
        "fine/energies.csv",
        "shallow-water/depth.npy",
        "dpd-fluid-sweep/sweep.csv",
    ] {
        assert!(directory.path().join(file).exists(), "{file} is missing");
    }
}

#[test]
fn the_scene_runs() {
    let scenes = blocks("json");
    assert_eq!(scenes.len(), 1);
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("mine.json"), &scenes[0]).unwrap();
    mesoscope(directory.path(), &["run", "mine.json", "--quiet"]);
    assert!(directory.path().join("mine/energies.png").exists());
}

#[test]
fn the_pictures_are_there_and_small() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let pictures: Vec<&str> = README.split("](").skip(1).map(|rest| rest.split(')').next().unwrap()).collect();
    let pictures: Vec<&str> = pictures.into_iter().filter(|path| path.starts_with("assets/")).collect();
    assert!(pictures.len() >= 4);
    let bytes: u64 = pictures.iter().map(|path| std::fs::metadata(root.join(path)).expect(path).len()).sum();
    assert!(bytes < 2_000_000, "the gallery has {bytes} bytes");
}
