//! `mesoscope sweep` as its user meets it: variants, tables, plots, messages and exit codes.

use std::fs;
use std::path::Path;

use mesoscope::output::{Summary, files, read_table};
use mesoscope::scene::AnalysisId;
use mesoscope::sweep::{SweepSummary, VariantState};
use serde_json::{Value, json};

use crate::support::program::{
    Place, bytes, fails, listing, mesoscope, picture, size, succeeds, succeeds_and_tells, text,
};

/// A scene of 192 particles that takes small pictures.
fn place() -> Place {
    Place::of(json!({
        "title": "small fluid",
        "space": {"box": [4, 4, 4]},
        "time": {"step": 0.03, "steps": 40, "equilibration": 10},
        "temperature": 1,
        "particles": [{"species": "fluid", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 2},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
            "radial_distribution": {"every": 5, "range": 2},
        },
    }))
}

/// The arguments of a sweep into the directory of this name.
fn sweep_into(place: &Place, out: &str, further: &[&str]) -> Vec<String> {
    let own = ["sweep".to_owned(), place.scene(), "--out".to_owned(), place.argument(out)];
    own.into_iter().chain(further.iter().map(|argument| (*argument).to_owned())).collect()
}

fn summary(place: &Place, out: &str) -> SweepSummary {
    SweepSummary::load(&place.path(out)).unwrap()
}

fn borrowed(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

fn states(summary: &SweepSummary) -> Vec<VariantState> {
    summary.variants.iter().map(|variant| variant.state).collect()
}

const FRICTION: &str = "interactions.0.friction";

#[test]
fn every_variant_is_the_run_it_would_be_alone() {
    let place = place();
    let vary = format!("{FRICTION}=1,4.5,9");
    let (said, told) =
        succeeds_and_tells(&borrowed(&sweep_into(&place, "out", &["--vary", &vary, "--jobs", "2", "--set", "seed=7"])));
    let out = place.path("out");
    for part in ["small fluid: 3 variants of interactions.0.friction, 2 at a time", "friction=4.5", "sweep.csv"] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    assert!(told.contains("3 of 3  friction="), "{told}");
    for value in ["1", "4.5", "9"] {
        let (alone, set) = (place.argument(value), format!("{FRICTION}={value}"));
        let arguments = ["run", &place.scene(), "--out", &alone, "--set", "seed=7", "--set", &set];
        succeeds(&arguments);
        let variant = out.join(format!("friction={value}"));
        assert_eq!(listing(&variant), listing(Path::new(&alone)));
        for name in listing(&variant).iter().filter(|name| *name != files::SUMMARY) {
            assert!(bytes(&variant.join(name)) == bytes(&Path::new(&alone).join(name)), "{name} of {value} differs");
        }
        let [one, other] = [&variant, Path::new(&alone)].map(|path| Summary::load(&path.join(files::SUMMARY)).unwrap());
        assert_eq!((one.means, one.results, one.scene), (other.means, other.results, other.scene));
    }
    let sweep = place.argument("out");
    fails(&["resume", &sweep], 2, &["holds a sweep, not a run", &format!("mesoscope sweep --resume {sweep}")]);
    // A variant is a run like any other.
    let variant = place.argument("out/friction=9");
    assert!(succeeds(&["plot", &variant]).contains(files::ENERGIES_PLOT));
    succeeds(&["resume", &variant, "--steps", "44"]);
}

#[test]
fn table_summary_and_plots() {
    let place = place();
    let arguments = sweep_into(
        &place,
        "out",
        &[
            "--vary",
            "interactions[0].friction=1,9",
            "--vary",
            "time.step=.02,.03",
            "--also",
            "temperature=0",
            "--quiet",
        ],
    );
    let output = mesoscope(&borrowed(&arguments));
    assert_eq!((text(&output.stdout), text(&output.stderr)), ("", ""));
    let out = place.path("out");
    let names = [
        "friction=1,step=0.02",
        "friction=1,step=0.03",
        "friction=9,step=0.02",
        "friction=9,step=0.03",
        "temperature=0",
    ];
    let summary = summary(&place, "out");
    assert_eq!(summary.variants.iter().map(|variant| variant.name.as_str()).collect::<Vec<_>>(), names);
    assert_eq!(states(&summary), [VariantState::Finished; 5]);
    assert_eq!(summary.vary[1].values, [json!(0.02), json!(0.03)]);
    assert_eq!(summary.base["title"], "small fluid");

    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 6);
    let header: Vec<&str> = lines[0].split(',').collect();
    assert_eq!(
        header[..8],
        ["variant", FRICTION, "time.step", "temperature", "state", "steps", "particles", "wall_seconds"]
    );
    assert!(lines[2].starts_with("\"friction=1,step=0.03\",1,0.03,,finished,40,192,"), "{}", lines[2]);
    assert!(lines[5].starts_with("temperature=0,,,0,finished,40,192,"), "{}", lines[5]);
    // What the table says of an observable is what the run says.
    let run = Summary::load(&out.join(names[1]).join(files::SUMMARY)).unwrap();
    let cells: Vec<&str> = lines[2].split("\",").nth(1).unwrap().split(',').collect();
    let cell = |name: &str| {
        let column = header.iter().position(|column| *column == name).unwrap() - 1;
        cells[column].parse::<f64>().unwrap()
    };
    for name in ["kinetic_energy", "total_energy", "pressure", "configurational_temperature"] {
        assert_eq!(cell(name), run.means[name]["value"].as_f64().unwrap(), "{name}");
        assert_eq!(cell(&format!("{name}_error")), run.means[name]["error"].as_f64().unwrap(), "{name}");
    }
    assert_eq!(
        cell("radial_distribution.peak_height"),
        run.results["radial_distribution"]["peak_height"]["value"].as_f64().unwrap()
    );

    // A key that is varied keeps its name, and an observable of that name gives way.
    assert_eq!(cell("temperature_mean"), run.means["temperature"]["value"].as_f64().unwrap());

    // A plot for every quantity that changes, of the size that the scene asks for.
    let plots: Vec<String> = listing(&out).into_iter().filter(|name| name.starts_with("sweep-")).collect();
    let expected = [
        "configurational_temperature",
        "kinetic_energy",
        "means-2",
        "means-3",
        "means",
        "potential_energy",
        "pressure",
    ];
    let expected = expected.into_iter().chain(["pressure_conservative", "temperature", "total_energy"]);
    assert_eq!(plots, expected.map(|quantity| format!("sweep-{quantity}.png")).collect::<Vec<_>>());
    for name in &plots {
        assert_eq!(size(&out.join(name)), (640, 480), "{name}");
    }
    // Blue, vermilion, green and purple: every variant but the black one has a curve in its colour.
    let picture = picture(&out.join("sweep-total_energy.png"));
    for colour in [[0x00, 0x72, 0xB2], [0xD5, 0x5E, 0x00], [0x00, 0x9E, 0x73], [0xCC, 0x79, 0xA7]] {
        let close = |pixel: &&image::Rgba<u8>| (0..3).all(|channel| pixel[channel].abs_diff(colour[channel]) < 40);
        assert!(picture.pixels().filter(close).count() > 40, "no curve of colour {colour:?}");
    }
    let before = bytes(&out.join("sweep-pressure.png"));
    fs::remove_file(out.join("sweep-pressure.png")).unwrap();
    assert!(succeeds(&["plot", &place.argument("out")]).contains("sweep-pressure.png"));
    assert!(bytes(&out.join("sweep-pressure.png")) == before);
    succeeds(&["plot", &place.argument("out"), "--set", "output.plot.width=800"]);
    assert_eq!(size(&out.join("sweep-pressure.png")), (800, 480));
}

#[test]
fn mistakes_in_variants_run_nothing() {
    fails(&["sweep", "dpd-fluid", "--vary", "seed=1,2", "--jobs", "0"], 2, &["0 is not in 1..=65535"]);
    let place = place();
    let sweep = |further: &[&str]| sweep_into(&place, "out", further);
    let fails = |further: &[&str], parts: &[&str]| fails(&borrowed(&sweep(further)), 2, parts);
    fails(
        &["--vary", "interactions.0.fricton=1,2"],
        &["variants `fricton=1`, `fricton=2`: ", "interactions[0].fricton: unknown key", "did you mean `friction`"],
    );
    let message = fails(
        &["--vary", &format!("{FRICTION}=4.5,-1"), "--also", "time.step=0"],
        &["variant `friction=-1`: ", "interactions[0].friction: found -1", "variant `step=0`: ", "time.step"],
    );
    assert!(!message.contains("`friction=4.5`"), "{message}");
    fails(
        &["--vary", FRICTION, "--vary", "seed=1,1"],
        &["`--vary interactions.0.friction`", "key=value", "1 stands there twice"],
    );
    fails(&["--vary", "seed=1,2", "--plot", "presure"], &["no quantity `presure`", "pressure"]);
    assert!(mesoscope(&["sweep", "dpd-fluid"]).status.code() == Some(2), "nothing varied");
    assert!(!place.path("out").exists());
    let none = sweep_into(&place, "out", &["--vary", "seed=1,2", "--adapter", "abacus"]);
    self::fails(&borrowed(&none), 3, &["abacus", "0: "]);
    self::fails(&["sweep", "--resume", &place.argument("out")], 5, &["is no directory"]);
    let long = sweep_into(&place, "out", &["--vary", "seed=1,2", "--set", "time.steps=4000000000"]);
    self::fails(&borrowed(&long), 2, &["about ", " days", "--yes"]);
    assert!(!place.path("out").exists());
}

/// A variant that an adapter has no room for is named before anything is run or written.
#[test]
fn a_variant_that_no_adapter_has_room_for_is_refused() {
    let place = place();
    for command in ["sweep", "tradeoff"] {
        let mut arguments = sweep_into(&place, "out", &["--vary", "space.box.0=4,4e6", "--yes"]);
        command.clone_into(&mut arguments[0]);
        fails(
            &borrowed(&arguments),
            3,
            &["error: `box.0=4000000.0`: adapter ", " allows at most ", "this scene needs "],
        );
        assert!(!place.path("out").exists(), "{command}");
    }
}

#[test]
fn an_unstable_variant_does_not_stop_the_others() {
    let place = place();
    let arguments =
        sweep_into(&place, "out", &["--vary", "interactions.0.repulsion=25,690,10", "--jobs", "1", "--relative"]);
    let message = fails(
        &borrowed(&arguments),
        4,
        &["1 of 3 variants failed", "`repulsion=690`: the run became unstable at step ", "try a time step of"],
    );
    assert!(message.contains("3 of 3  repulsion=10  finished"), "{message}");
    let summary = summary(&place, "out");
    assert_eq!(states(&summary), [VariantState::Finished, VariantState::Failed, VariantState::Finished]);
    assert!(summary.variants[1].failure.as_ref().unwrap().contains("became unstable"));
    let table = fs::read_to_string(place.path("out/sweep.csv")).unwrap();
    assert!(table.lines().nth(2).unwrap().starts_with("repulsion=690,690,failed,,"), "{table}");
    assert_eq!(size(&place.path("out/sweep-total_energy.png")), (640, 480));
    read_table(&place.path("out/repulsion=10/energies.csv")).unwrap();
}

#[test]
fn nothing_is_overwritten_unless_asked() {
    let place = place();
    let sweep = |further: &[&str]| sweep_into(&place, "out", &[&["--quiet", "--plot", "pressure"], further].concat());
    succeeds(&borrowed(&sweep(&["--vary", "seed=1,2"])));
    fs::write(place.path("out/notes.txt"), "mine").unwrap();
    let before = listing(&place.path("out"));
    let again = sweep(&["--vary", "seed=3,4"]);
    fails(&borrowed(&again), 5, &["exists already", "--force", "--resume"]);
    assert_eq!(listing(&place.path("out")), before);
    fails(&borrowed(&[again.clone(), vec!["--force".into(), "--adapter".into(), "abacus".into()]].concat()), 3, &[]);
    assert_eq!(listing(&place.path("out")), before);
    succeeds(&borrowed(&[again, vec!["--force".to_owned()]].concat()));
    let expected =
        ["notes.txt", "seed=3", "seed=4", "sweep-averages.csv", "sweep-pressure.png", "sweep.csv", "sweep.json"];
    assert_eq!(listing(&place.path("out")), expected);
    // The directory of a single run holds results too.
    succeeds(&["run", &place.scene(), "--out", &place.argument("single"), "--quiet"]);
    fails(&borrowed(&sweep_into(&place, "single", &["--vary", "seed=1,2"])), 5, &["exists already", "checkpoint.bin"]);
}

#[test]
fn the_run_of_another_scene_is_not_taken_for_a_variant() {
    let place = place();
    succeeds(&borrowed(&sweep_into(&place, "out", &["--vary", "seed=1,2", "--quiet"])));
    let second = place.path("out").join("seed=2");
    fs::remove_dir_all(&second).unwrap();
    let foreign = place.argument("out/seed=2");
    succeeds(&["run", &place.scene(), "--set", "seed=7", "--out", &foreign, "--quiet"]);
    let before = bytes(&second.join(files::ENERGIES));
    fails(&["sweep", "--resume", &place.argument("out")], 5, &["seed=2", "belongs to another run than `sweep.json`"]);
    assert_eq!(bytes(&second.join(files::ENERGIES)), before);
    assert_eq!(states(&summary(&place, "out")), [VariantState::Finished, VariantState::Failed]);
    fs::remove_dir_all(&second).unwrap();
    succeeds(&["sweep", "--resume", &place.argument("out")]);
}

#[test]
fn a_damaged_table_fails_its_variant_only() {
    let place = place();
    succeeds(&borrowed(&sweep_into(&place, "out", &["--vary", "seed=1,2", "--quiet"])));
    let second = place.path("out").join("seed=2");
    let plot = place.path("out").join("sweep-pressure.png");
    fs::remove_file(&plot).unwrap();
    fs::write(second.join(files::ENERGIES), "lost\n\u{fffd}\n").unwrap();
    let told = ["energies.csv", "hint: `mesoscope sweep --resume` runs a variant again once its directory is removed"];
    fails(&["sweep", "--resume", &place.argument("out")], 5, &told);
    assert_eq!(states(&summary(&place, "out")), [VariantState::Finished, VariantState::Failed]);
    assert!(plot.exists(), "the plots show the others");
    fs::remove_dir_all(&second).unwrap();
    succeeds(&["sweep", "--resume", &place.argument("out"), "--quiet"]);
    assert_eq!(states(&summary(&place, "out")), [VariantState::Finished; 2]);
}

#[test]
fn an_interrupted_sweep_can_be_finished() {
    let place = place();
    let vary = ["--vary", "seed=1,2,3", "--quiet"];
    succeeds(&borrowed(&sweep_into(&place, "whole", &vary)));
    succeeds(&borrowed(&sweep_into(&place, "parts", &vary)));
    // As if it had been killed: one variant finished, one on its way, one not begun, and the last was never noted.
    let parts = place.path("parts");
    fs::remove_dir_all(parts.join("seed=3")).unwrap();
    fs::remove_dir_all(parts.join("seed=2")).unwrap();
    let second = place.argument("parts/seed=2");
    succeeds(&["run", &place.scene(), "--set", "seed=2", "--steps", "20", "--out", &second, "--quiet"]);
    let mut noted: Value = serde_json::from_slice(&bytes(&parts.join("sweep.json"))).unwrap();
    for variant in noted["variants"].as_array_mut().unwrap() {
        variant["state"] = json!("waiting");
    }
    fs::write(parts.join("sweep.json"), noted.to_string()).unwrap();
    for name in ["sweep.csv", "sweep-pressure.png"] {
        fs::remove_file(parts.join(name)).unwrap();
    }
    let first = fs::metadata(parts.join("seed=1/energies.csv")).unwrap().modified().unwrap();
    let said = succeeds(&["sweep", "--resume", &place.argument("parts")]);
    assert!(said.contains("2 of 3 variants left of seed"), "{said}");
    assert_eq!(fs::metadata(parts.join("seed=1/energies.csv")).unwrap().modified().unwrap(), first, "run again");
    assert_eq!(states(&summary(&place, "parts")), [VariantState::Finished; 3]);
    let whole = place.path("whole");
    assert_eq!(listing(&whole), listing(&parts));
    for name in listing(&whole).iter().filter(|name| name.starts_with("sweep-")) {
        assert!(bytes(&whole.join(name)) == bytes(&parts.join(name)), "{name} differs");
    }
    for seed in [1, 2, 3] {
        for name in [files::ENERGIES, files::CHECKPOINT, AnalysisId::RadialDistribution.table()] {
            let name = format!("seed={seed}/{name}");
            assert!(bytes(&whole.join(&name)) == bytes(&parts.join(&name)), "{name} differs");
        }
    }
    // Nothing is left to run: the plots are drawn again, with another look where one is given.
    let before = bytes(&parts.join("sweep-total_energy.png"));
    succeeds(&["sweep", "--resume", &place.argument("parts"), "--relative", "--plot", "total_energy"]);
    assert!(bytes(&parts.join("sweep-total_energy.png")) != before);
    assert!(summary(&place, "parts").plots.relative);
}
