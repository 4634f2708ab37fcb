//! `mesoscope tradeoff` as its user meets it: choices, costs, errors, what to choose, messages and exit codes.

use std::f64::consts::TAU;
use std::fs;

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::{files as run_files, read_table};
use mesoscope::run::Interrupt;
use mesoscope::tradeoff::{
    ChoiceState, Request, TradeoffError, TradeoffEvent, TradeoffRun, TradeoffSummary, Verdict, files,
};
use serde_json::{Value, json};

use crate::support::program::{Place, fails, listing, size, succeeds};

/// A fluid of 192 particles, and what of it a run takes to say something about its temperature.
fn place() -> Place {
    Place::of(json!({
        "title": "small fluid",
        "space": {"box": [4, 4, 4]},
        "time": {"step": 0.04, "steps": 200, "equilibration": 40},
        "temperature": 1,
        "particles": [{"species": "fluid", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 4},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }))
}

fn arguments<'a>(place: &'a Place, further: &[&'a str]) -> Vec<String> {
    let own = ["tradeoff".to_owned(), place.scene(), "--out".to_owned(), place.argument("out")];
    own.into_iter().chain(further.iter().map(|argument| (*argument).to_owned())).collect()
}

fn borrowed(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

#[test]
fn choices_have_costs_and_errors_over_the_same_time() {
    let place = place();
    let new = place.argument("new.json");
    let further = [
        "--vary",
        "time.step=0.02,0.04,0.2",
        "--also",
        "integrator.type=groot-warren",
        "--measure",
        "temperature,pressure",
        "--reference",
        "pressure=23.6+-0.1",
        "--target",
        "temperature=30%",
        "--write",
        &new,
    ];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    for part in ["CHOICE", "PRESSURE", "unstable", "Choose ", "tradeoff-pressure.png", "wrote "] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let out = place.path("out");
    let summary = TradeoffSummary::load(&out).unwrap();
    let labels: Vec<&str> = summary.choices.iter().map(|choice| choice.label.as_str()).collect();
    assert_eq!(labels, ["step = 0.02", "step = 0.04", "step = 0.2", "type = groot-warren"]);
    assert_eq!(summary.measures, ["temperature", "pressure"]);
    for choice in &summary.choices {
        if choice.time_step == 0.2 {
            assert_eq!(
                (choice.state, choice.verdict, choice.cost),
                (ChoiceState::Unstable, Some(Verdict::Misses), None)
            );
            continue;
        }
        // All cover eight units of time, of which 1.6 are left out, with a row every 0.16.
        let cost = choice.cost.unwrap();
        assert_eq!(choice.steps as f64 * choice.time_step, 8.0, "{}", choice.label);
        assert!(cost.fastest <= cost.seconds_per_time && cost.seconds_per_time <= cost.slowest);
        assert!(cost.particle_steps_per_second > 0.0 && cost.bytes_per_particle > 64.0);
        // As the self-test of adapters demands.
        assert!(choice.float64_distance.is_some_and(|distance| distance > 0.0 && distance < 1e-4), "{choice:?}");
        let table = read_table(&out.join(&choice.name).join(run_files::ENERGIES)).unwrap();
        assert_eq!(table.column("time").unwrap()[1], 0.16, "{}", choice.label);
        // The error is that of the mean in the run's own summary against what was given.
        let run: Value =
            serde_json::from_slice(&fs::read(out.join(&choice.name).join(run_files::SUMMARY)).unwrap()).unwrap();
        let pressure = choice.error("pressure").unwrap();
        let mean = run["means"]["pressure"]["mean"].as_f64().unwrap();
        let error = run["means"]["pressure"]["standard_error"].as_f64().unwrap();
        assert_eq!(pressure.error, (mean - 23.6) / 23.6);
        assert_eq!(pressure.uncertainty, Some(error.hypot(0.1) / 23.6));
        // A row of the temperature of 192 particles scatters by √(2/573) = 6 %, so a mean is within 30 % of what it should be even if all
        // rows were the same one, to five standard deviations, and the steps err by 3 % at most. Pressures scatter by 1.7 % in such a
        // run, judging from the error of .36 % of a run with 3.4 times the particles over 6.3 times the time; 10 % is more than five.
        assert!(pressure.size() < 0.1 && choice.error("temperature").unwrap().size() < 0.3, "{pressure:?}");
    }
    // What was chosen is the cheapest that meets the target, and its scene is that of the user with one line changed.
    let chosen = summary.choice().unwrap();
    assert_eq!(chosen.verdict, Some(Verdict::Meets));
    let cheaper = |other: &&mesoscope::tradeoff::Choice| {
        let [own, other_cost] =
            [chosen, other].map(|choice| choice.cost.map_or(f64::INFINITY, |cost| cost.seconds_per_time));
        other.verdict == Some(Verdict::Meets) && other_cost < own
    };
    assert!(summary.choices.iter().all(|other| !cheaper(&other)));
    let [old, new] =
        [place.scene(), new].map(|path| serde_json::from_slice::<Value>(&fs::read(path).unwrap()).unwrap());
    let mut expected = old;
    for setting in &chosen.settings {
        let path = format!("/{}", setting.key.replace('.', "/"));
        match expected.pointer_mut(&path) {
            Some(place) => *place = setting.value.clone(),
            None => expected["integrator"] = json!({"type": setting.value}),
        }
    }
    assert_eq!(new, expected);
    // The files.
    let table = fs::read_to_string(out.join(files::TABLE)).unwrap();
    assert_eq!(table.lines().count(), 5, "{table}");
    assert!(table.starts_with("choice,time.step,integrator.type,state,steps,seconds_per_time,"), "{table}");
    assert_eq!(size(&out.join(files::plot("pressure"))), (640, 480));
    let page = fs::read_to_string(out.join(files::PAGE)).unwrap();
    for part in ["# What accuracy costs: small fluid", "Pareto front", "## Unstable", "which was given"] {
        assert!(page.contains(part), "`{part}` is not in: {page}");
    }
    // Nor does one replace the runs of a sweep, or anything else that has the name of a run.
    fs::create_dir_all(place.path("other/finer")).unwrap();
    let other = place.argument("other");
    fails(&["tradeoff", &place.scene(), "--out", &other, "--vary", "time.step=0.02,0.04"], 5, &["finer", "--force"]);
    assert_eq!(listing(&place.path("other")), ["finer"]);
    // A second one does not replace it unless that is asked for, and nothing is left to do for one that goes on.
    fails(&borrowed(&arguments(&place, &["--vary", "time.step=0.02,0.04"])), 5, &["tradeoff", "--resume"]);
    let before = fs::read(out.join("step=0.02").join(run_files::CHECKPOINT)).unwrap();
    succeeds(&["tradeoff", "--resume", &place.argument("out"), "--quiet"]);
    assert_eq!(fs::read(out.join("step=0.02").join(run_files::CHECKPOINT)).unwrap(), before);
}

/// The depth of a wave on 16² nodes after a short time: its distance from that of half the step shrinks with the step, and the
/// energy drifts less.
#[test]
fn flows_are_compared_with_a_finer_run() {
    let place = Place::of(json!({
        "title": "wave",
        "space": {"box": [TAU, TAU]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 0,
        "integrator": {"type": "gyro"},
        "particles": [{"species": "water", "count": 4096, "placement": {"type": "lattice"}, "velocities": {"type": "geostrophic"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": TAU,
            "rotation": TAU, "smoothing": {"length": 0.8},
            "surface": [{"type": "wave", "periods": [1, 2], "amplitude": 0.2}]}],
        "output": {"energies": {"every": 2}, "fields": {"quantities": ["depth"]},
            "plot": {"width": 640, "height": 480}},
    }));
    let vary = ["--vary", "time.step=0.01,0.02,0.04", "--target", "energy_drift=1%", "--quiet"];
    succeeds(&borrowed(&arguments(&place, &vary)));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    assert_eq!(summary.measures, ["energy_drift", "depth_distance"]);
    for measure in &summary.measures {
        let errors: Vec<f64> = summary.choices.iter().map(|choice| choice.error(measure).unwrap().size()).collect();
        assert!(errors[0] < errors[1] && errors[1] < errors[2], "{measure}: {errors:?}");
    }
    // A percentage of a drift is one of the energy, which all of them keep that well: the largest step is the cheapest.
    assert_eq!(summary.choice().map(|choice| choice.time_step), Some(0.04));
    let names = listing(&place.path("out"));
    assert!(names.contains(&files::plot("depth_distance")), "{names:?}");
}

/// One that is interrupted after its first run, and then goes on, measures what one measures that is not.
#[test]
fn an_interrupted_tradeoff_goes_on() {
    let place = place();
    let request = || {
        let vary = ["time.step=0.02,0.04".to_owned()];
        Request::load(&place.scene(), &[], &vary, &[]).unwrap().with_measures(&["pressure".to_owned()]).unwrap()
    };
    let whole = TradeoffRun::start(request(), place.path("whole"), false);
    let whole = whole.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    let interrupt = Interrupt::default();
    let stopped = TradeoffRun::start(request(), place.path("parts"), false).until(&interrupt);
    let stopped = stopped.execute(&AdapterChoice::Best, &mut |event| {
        if matches!(event, TradeoffEvent::Ended { .. }) {
            interrupt.ask();
        }
    });
    assert!(matches!(stopped, Err(TradeoffError::Interrupted { .. })), "{stopped:?}");
    assert!(!place.path("parts").join(files::TABLE).exists());
    let parts = TradeoffRun::resume(place.path("parts")).unwrap();
    let parts = parts.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    assert_eq!(parts.files, whole.files);
    for (one, other) in parts.summary.choices.iter().zip(&whole.summary.choices) {
        assert_eq!((one.steps, &one.measured), (other.steps, &other.measured), "{}", one.label);
    }
    assert_eq!(parts.summary.references, whole.summary.references);
}

#[test]
fn mistakes_are_named_before_anything_runs() {
    let place = place();
    for (further, code, parts) in [
        (&["--vary", "time.step=0.02,0.04", "--measure", "presure"][..], 2, &["did you mean `pressure`?"][..]),
        (
            &["--vary", "time.step=0.02,0.04", "--target", "pressure=-1%"],
            2,
            &["--target pressure=-1%", "more than zero"],
        ),
        (&["--vary", "time.step=0.02,0.04", "--reference", "pressure=x"], 2, &["pressure=23.635+-0.005"]),
        (&["--vary", "time.steps=100,200"], 2, &["`time.steps` cannot be varied"]),
        (&["--vary", "time.step=0.02,0.04", "--finer", "integrator.type=none"], 2, &["variant `finer`"]),
        (&["--vary", "time.step=0.02,0.04", "--finer", "time.steps=7"], 2, &["`time.steps` follows from the choices"]),
        (&["--vary", "time.step=0.02,0.04", "--measure", "depth_distance"], 2, &["no run of this scene measures that"]),
        (&["--vary", "time.step=0.02,0.04", "--write", "new.json"], 2, &["`--write` needs a `--target`"]),
        (&["--vary", "time.stepp=0.02,0.04"], 2, &["did you mean `step`?"]),
        (&["--vary", "time.step=0.02,0.04", "--error", "2"], 2, &["0.002"]),
        (&["--vary", "time.step=0.02,0.04", "--budget", "soon"], 2, &["30s, 10m, 2h"]),
    ] {
        let arguments = arguments(&place, further);
        fails(&borrowed(&arguments), code, parts);
        assert!(!place.path("out").exists());
    }
    fails(&["tradeoff", "--resume", &place.argument("nowhere")], 5, &["there is no tradeoff in"]);
}

/// A run of a day is announced and not begun.
#[test]
fn what_takes_a_day_has_to_be_said_twice() {
    let place = place();
    let vary = ["--vary", "time.step=0.02,0.04", "--set", "time.steps=4000000000"];
    fails(&borrowed(&arguments(&place, &vary)), 2, &["--yes", "--budget", " days"]);
    assert!(!place.path("out").exists());
}
