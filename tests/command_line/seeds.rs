//! `--seeds` of every command that runs something: independent runs, and the means over them.

use std::fs;
use std::path::Path;

use mesoscope::measure::statistics::independent;
use mesoscope::output::{Summary, files as run_files};
use mesoscope::stability::StabilitySummary;
use mesoscope::sweep::SweepSummary;
use mesoscope::tradeoff::{ChoiceState, TradeoffSummary};
use serde_json::json;

use crate::support::program::{Place, bytes, fails, succeeds};

/// The fluid of tradeoffs, in a run too short to know its error.
fn place() -> Place {
    let mut scene = crate::tradeoff::fluid();
    (scene["seed"], scene["time"]["steps"], scene["output"]["snapshot"]) = (json!(5), json!(120), json!(null));
    Place::of(scene)
}

/// The mean of a column in the run of a directory.
fn mean(directory: &Path, column: &str) -> f64 {
    let summary = Summary::load(&directory.join(run_files::SUMMARY)).unwrap();
    summary.means[column]["value"].as_f64().unwrap()
}

#[test]
fn runs_with_several_seeds_are_those_of_each_seed_and_their_mean() {
    let place = place();
    let alone = succeeds(&["run", &place.scene(), "--out", &place.argument("alone"), "--seed", "6"]);
    assert!(alone.contains("independent runs (--seeds 10)"), "{alone}");
    let said = succeeds(&["run", &place.scene(), "--out", &place.argument("out"), "--seeds", "3"]);
    assert!(said.contains("wrote ") && said.contains("sweep-averages.csv"), "{said}");
    let out = place.path("out");
    let energies = |run: &str| bytes(&place.path(run).join(run_files::ENERGIES));
    assert_eq!(energies("out/seed=6"), energies("alone"));
    let summary: SweepSummary = SweepSummary::load(&out).unwrap();
    let means: Vec<f64> = ["seed=5", "seed=6", "seed=7"].iter().map(|name| mean(&out.join(name), "pressure")).collect();
    let found = independent(&means).unwrap();
    assert_eq!(summary.averages.len(), 1);
    let average = &summary.averages[0].means["pressure"];
    assert_eq!((average["value"].as_f64(), average["error"].as_f64()), (Some(found.value), found.error));
    assert!(found.error.unwrap() > 0.0);
    fails(&["run", &place.scene(), "--out", &place.argument("out")], 5, &["out` has a sweep"]);
    // A sweep takes them beside what it varies, and beside further variants.
    let further = ["--vary", "temperature=1,2", "--also", "interactions.0.friction=1", "--seeds", "2", "--quiet"];
    succeeds(&[&["sweep", &place.scene(), "--out", &place.argument("sweep")][..], &further].concat());
    let summary = SweepSummary::load(&place.path("sweep")).unwrap();
    assert_eq!(summary.averages.iter().map(|average| average.seeds).collect::<Vec<_>>(), [2, 2, 2]);
    for (arguments, part) in [
        (&["--seeds", "0"][..], "0 seeds; accepted: 1 to 1024"),
        (&["--seeds", "2", "--ranks", "2"], "--ranks"),
        (&["--seeds", "2", "--no-pictures"], "--no-pictures"),
    ] {
        fails(&[&["run", &place.scene(), "--out", &place.argument("other")][..], arguments].concat(), 2, &[part]);
    }
    assert!(!place.path("other").exists());
}

/// Choices are assessed by means over seeds, and a step that is unstable with one of them is unstable.
#[test]
fn choices_are_compared_by_means_over_seeds() {
    let place = place();
    let (scene, out) = (place.scene(), place.argument("out"));
    let own = ["tradeoff", &scene, "--out", &out, "--vary", "time.step=0.02,0.04,0.2", "--seeds", "3"];
    let further = ["--measure", "temperature", "--finer", "integrator.type=groot-warren", "--quiet"];
    succeeds(&[&own[..], &further].concat());
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    let names = ["step=0.04", "step=0.04,seed=6", "step=0.04,seed=7"].map(|name| place.path("out").join(name));
    let means = names.each_ref().map(|name| mean(name, "temperature"));
    let average = means.iter().sum::<f64>() / 3.0;
    // Two errors are the 95 % interval of Student's distribution with two degrees of freedom.
    let scatter = (means.iter().map(|mean| (mean - average).powi(2)).sum::<f64>() / 6.0).sqrt();
    let choice = &summary.choices[1];
    let measured = choice.value("temperature").unwrap();
    assert!((measured.value - average).abs() < 1e-12 && !measured.from_few_samples, "{measured:?}");
    assert!((2.0 * measured.standard_error.unwrap() / scatter - 4.303).abs() < 1e-6, "{measured:?} {scatter}");
    let error = choice.error("temperature").unwrap();
    assert_eq!((error.error, error.uncertainty), (measured.value - 1.0, measured.standard_error));
    assert_eq!(summary.choices[2].state, ChoiceState::Unstable);
    let run = Summary::load(&names[1].join(run_files::SUMMARY)).unwrap();
    assert_eq!((run.scene.seed, run.steps, run.scene.time.step), (6, 120, 0.04));
    let page = fs::read_to_string(place.path("out").join("tradeoff.md")).unwrap();
    assert!(page.contains("Every choice ran with 3 seeds"), "{page}");
    // It goes on without a run, and is what it was.
    succeeds(&["tradeoff", "--resume", &out, "--quiet"]);
    let again = TradeoffSummary::load(&place.path("out")).unwrap();
    assert_eq!(again.choices[1].measured, choice.measured);
    fails(&["tradeoff", &scene, "--vary", "seed=1,2", "--seeds", "2"], 2, &["`seed` cannot be varied"]);
}

/// Places of molecules and the noise after a start from a run follow from the seed where a scene is read, so that each
/// further seed of a choice is the run that `run --seed` makes.
#[test]
fn further_seeds_of_choices_are_runs_of_scenes_with_these_seeds() {
    let place = Place::of(json!({
        "title": "dimers",
        "space": {"box": [5, 5, 5]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 1,
        "molecules": [{"beads": ["A", "A"], "bonds": [[0, 1]], "count": 100, "spacing": 0.7}],
        "particles": [{"species": "A"}],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.7}},
        ],
        "output": {"energies": {"every": 4}, "plot": {"width": 640, "height": 480}, "snapshot": null},
    }));
    let energies = |run: &str| bytes(&place.path(run).join(run_files::ENERGIES));
    let scene = place.scene();
    let own = ["--vary", "time.step=0.02", "--measure", "temperature", "--seeds", "2", "--quiet"];
    succeeds(&[&["tradeoff", &scene, "--out", &place.argument("molecules")][..], &own].concat());
    succeeds(&["run", &scene, "--seed", "1", "--out", &place.argument("alone"), "--quiet"]);
    assert_eq!(energies("molecules/step=0.02,seed=1"), energies("alone"));
    assert_ne!(energies("molecules/step=0.02"), energies("alone"));
    // A run of the same scene goes on where another ended; one with another seed has noise of its own.
    let start = serde_json::to_string(&json!({"file": place.argument("alone")})).unwrap();
    let set = [format!("state={start}"), "seed=1".to_owned(), "molecules=[]".to_owned()];
    let set = ["--set", &set[0], "--set", &set[1], "--set", &set[2]];
    succeeds(&[&["tradeoff", &scene, "--out", &place.argument("state")][..], &own, &set].concat());
    assert_ne!(energies("state/step=0.02"), energies("state/step=0.02,seed=2"));
}

#[test]
fn maps_judge_means_over_seeds() {
    let place = place();
    let (scene, out) = (place.scene(), place.argument("out"));
    let own = ["stability", &scene, "--out", &out, "--vary", "time.step=0.02,0.3", "--bisections", "0"];
    // What a tolerance decides at once ends after a quarter of the time; none is reached that is never certain.
    let further = ["--measure", "temperature", "--reference", "temperature=2", "--tolerance", "1%", "--quiet"];
    succeeds(&[&own[..], &further, &["--seeds", "2"]].concat());
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    let [right, unstable] = &summary.rows[0].cells[..] else { panic!("{summary:?}") };
    assert!(unstable.reason.as_deref().is_some_and(|reason| reason.contains(" with the seed ")), "{unstable:?}");
    let error = right.error("temperature").unwrap();
    // Half of what was given, with an error from the scatter of two means.
    assert!((error.error + 0.5).abs() < 0.1 && error.uncertainty.is_some_and(|error| error > 0.0), "{error:?}");
    succeeds(&[&["stability", &scene, "--out", &place.argument("one")][..], &own[4..], &further].concat());
    let one = StabilitySummary::load(&place.path("one")).unwrap();
    assert_ne!(one.rows[0].cells[0].error("temperature"), Some(error));
    let page = fs::read_to_string(place.path("out").join("stability.md")).unwrap();
    assert!(page.contains("Means are over 2 seeds, with errors from their scatter."), "{page}");
    fails(&["stability", &scene, "--vary", "seed=1..4/2", "--seeds", "2"], 2, &["`seed` cannot be varied"]);
}
