//! Signals that ask a run or a sweep to stop: what was computed is kept, and the rest can follow.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod program;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use mesoscope::output::{checkpoint, files, read_table};
use mesoscope::sweep::{SweepSummary, VariantState};
use program::{Place, bytes, command, succeeds, text};
use serde_json::json;

/// A scene of 192 particles.
fn place() -> Place {
    Place::of(json!({
        "title": "small fluid",
        "space": {"box": [4, 4, 4]},
        "time": {"step": 0.03, "steps": 50_000_000, "equilibration": 10},
        "temperature": 1,
        "particles": [{"species": "fluid", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 7},
            "trajectory": {"every": 50},
            "radial_distribution": {"every": 20, "range": 1.5},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }))
}

/// Starts the program, sends it a signal once a table has a few rows, and returns its exit code and what it says on standard
/// error.
fn interrupted(arguments: &[&str], signal: &str, table: &Path) -> (Option<i32>, String) {
    let mut child = command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !read_table(table).is_ok_and(|table| table.rows.len() > 3) {
        assert!(child.try_wait().unwrap().is_none(), "it has ended by itself");
        assert!(begun.elapsed() < Duration::from_mins(1), "it does not begin");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    (output.status.code(), text(&output.stderr).to_owned())
}

#[test]
fn an_interrupted_run_goes_on_where_it_was() {
    for signal in ["-INT", "-TERM"] {
        let place = place();
        let (parts, table) = (place.argument("parts"), place.path("parts").join(files::ENERGIES));
        let (code, said) = interrupted(&["run", &place.scene(), "--out", &parts], signal, &table);
        assert_eq!(code, Some(130), "{said}");
        let step = checkpoint::load(&place.path("parts").join(files::CHECKPOINT)).unwrap().state.step;
        assert!(step > 0);
        let told = format!("interrupted at step {step}; `mesoscope resume {parts}` goes on from there");
        assert!(said.ends_with(&format!("{told}\n")) && !said.contains("error"), "{said}");

        let steps = (step + 35).to_string();
        succeeds(&["resume", &parts, "--steps", &steps, "--quiet"]);
        succeeds(&["run", &place.scene(), "--out", &place.argument("whole"), "--steps", &steps, "--quiet"]);
        for name in [files::ENERGIES, files::CHECKPOINT, files::TRAJECTORY_GSD, files::RADIAL_DISTRIBUTION] {
            let [whole, parts] = ["whole", "parts"].map(|run| bytes(&place.path(run).join(name)));
            assert!(whole == parts, "{name} differs after step {step}");
        }
    }
}

#[test]
fn an_interrupted_sweep_goes_on_where_it_was() {
    let place = place().with("/time/steps", json!(6000));
    let (out, table) = (place.argument("out"), place.path("out/seed=1").join(files::ENERGIES));
    let arguments = ["sweep", &place.scene(), "--vary", "seed=1,2,3", "--jobs", "1", "--out", &out];
    let (code, said) = interrupted(&arguments, "-INT", &table);
    assert_eq!(code, Some(130), "{said}");
    let states = |place: &Place| {
        SweepSummary::load(&place.path("out")).unwrap().variants.iter().map(|variant| variant.state).collect::<Vec<_>>()
    };
    let finished = states(&place).iter().filter(|state| **state == VariantState::Finished).count();
    assert!(finished < 3 && !states(&place).contains(&VariantState::Failed), "{:?}", states(&place));
    let told =
        format!("interrupted after {finished} of 3 variants; `mesoscope sweep --resume {out}` finishes the sweep\n");
    assert!(said.ends_with(&told) && !said.contains("error"), "{said}");

    succeeds(&["sweep", "--resume", &out, "--quiet"]);
    assert_eq!(states(&place), [VariantState::Finished; 3]);
    // The variant that was under way is the same as if it had not been stopped.
    succeeds(&["run", &place.scene(), "--set", "seed=1", "--out", &place.argument("alone"), "--quiet"]);
    let [alone, swept] = ["alone", "out/seed=1"].map(|run| bytes(&place.path(run).join(files::ENERGIES)));
    assert!(alone == swept);
}
