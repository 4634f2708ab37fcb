//! `mesoscope tradeoff` as its user meets it: choices, costs, errors, what to choose, messages and exit codes.

use std::f64::consts::TAU;
use std::fs;
use std::time::Instant;

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::{files as run_files, read_table};
use mesoscope::run::Interrupt;
use mesoscope::study::{StudyError, StudyEvent};
use mesoscope::tradeoff::{ChoiceState, Length, Phase, Request, TradeoffRun, TradeoffSummary, Verdict, files};
use serde_json::{Value, json};

use crate::support::program::{Place, fails, listing, size, succeeds};

/// A fluid of 192 particles, and what of it a run takes to say something about its temperature.
pub fn fluid() -> Value {
    json!({
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
    })
}

fn place() -> Place {
    Place::of(fluid())
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
        // Differences of steps add up, and what they change does, too; chance trades neighbours no faster than some steps.
        let stretch = choice.float64_stretch.unwrap();
        assert!(stretch.steps == 16 && stretch.distance > 0.0 && stretch.distance < 1e-3, "{choice:?}");
        let exact = choice.conserved_exactly.iter().any(|what| what == "total momentum, to the last bit");
        assert!(exact, "{:?}", choice.conserved_exactly);
        let table = read_table(&out.join(&choice.name).join(run_files::ENERGIES)).unwrap();
        assert_eq!(table.column("time").unwrap()[1], 0.16, "{}", choice.label);
        // The error is that of the mean in the run's own summary against what was given.
        let run: Value =
            serde_json::from_slice(&fs::read(out.join(&choice.name).join(run_files::SUMMARY)).unwrap()).unwrap();
        let pressure = choice.error("pressure").unwrap();
        let mean = run["means"]["pressure"]["value"].as_f64().unwrap();
        let error = run["means"]["pressure"]["error"].as_f64().unwrap();
        // What is from few samples counts three times.
        let has_few = run["means"]["pressure"]["few"] == json!(true);
        let error = if has_few { 3.0 * error } else { error };
        assert_eq!(pressure.from_few_samples, has_few);
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
    let said = succeeds(&["tradeoff", "--resume", &place.argument("out")]);
    assert!(said.contains("small fluid: 0 runs") && !said.contains(", about"), "{said}");
    assert_eq!(fs::read(out.join("step=0.02").join(run_files::CHECKPOINT)).unwrap(), before);
}

/// A run refuses friction that relaxes a velocity more than 250 times in a step, though its temperature holds there: such a choice is
/// run like all others, with its errors and cost, and never chosen.
#[test]
fn a_step_that_a_run_refuses_is_a_choice_that_is_never_chosen() {
    let place = place().with("/integrator", json!({"type": "splitting", "relaxation": "two-stages"}));
    let strong = "interactions.0.friction=16000";
    fails(&["run", &place.scene(), "--set", strong], 2, &["time.step", "friction"]);
    let target = ["--vary", strong, "--measure", "temperature", "--target", "temperature=60%"];
    let new = place.argument("new.json");
    let written = [&target[..], &["--write", &new]].concat();
    let said = fails(&borrowed(&arguments(&place, &written)), 2, &["no choice is known to meet the targets, so"]);
    assert!(!place.path("new.json").exists(), "{said}");
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    let [choice] = &summary.choices[..] else { panic!("{:?}", summary.choices) };
    // Of 192 particles one row has 6 %, and the mean of 40 no more.
    assert_eq!((choice.state, choice.verdict), (ChoiceState::Finished, Some(Verdict::Meets)), "{choice:?}");
    assert!(choice.cost.is_some() && choice.refusal.as_ref().is_some_and(|refusal| refusal.contains("time.step")));
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains("No choice that `mesoscope run` takes meets the targets."), "{page}");
    assert!(
        page.contains("friction = 16000 is never chosen, for `mesoscope run` refuses its scene: time.step"),
        "{page}"
    );
    // Beside one that a run takes; and what was begun goes on with it.
    let both = ["--vary", "interactions.0.friction=4.5,16000", "--force"];
    let said = succeeds(&borrowed(&arguments(&place, &[&both[..], &target[2..]].concat())));
    assert!(said.contains("Choose friction = 4.5"), "{said}");
    let said = succeeds(&["tradeoff", "--resume", &place.argument("out")]);
    assert!(said.contains(": 0 runs"), "{said}");
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
    // The wave is in balance with the rotation, so that its exact solution is known too: that is a matter of the nodes.
    // Its speed is compared though the scene does not draw it.
    let measures = ["energy_drift", "depth_from_exact", "velocity_from_exact", "depth_distance", "velocity_distance"];
    assert_eq!(summary.measures, measures);
    for measure in ["energy_drift", "depth_distance", "velocity_distance"] {
        let errors: Vec<f64> = summary.choices.iter().map(|choice| choice.error(measure).unwrap().size()).collect();
        assert!(errors[0] < errors[1] && errors[1] < errors[2], "{measure}: {errors:?}");
    }
    // A percentage of a drift is one of the energy, which all of them keep that well: the largest step is the cheapest.
    assert_eq!(summary.choice().map(|choice| choice.time_step), Some(0.04));
    let names = listing(&place.path("out"));
    assert!(names.contains(&files::plot("depth_distance")), "{names:?}");
    // The finer run may be one of the choices, which is at no distance from itself.
    let further = ["--vary", "time.step=0.01,0.02", "--finer", "time.step=0.01", "--force", "--quiet"];
    succeeds(&borrowed(&arguments(&place, &further)));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    let distances: Vec<f64> =
        summary.choices.iter().map(|choice| choice.error("depth_distance").unwrap().size()).collect();
    assert!(distances[0] == 0.0 && distances[1] > 0.0, "{distances:?}");
}

/// What a still finer run changes counts: of water with few particles a node, those that are missing, which the step does not know of.
#[test]
fn a_still_finer_run_says_how_far_the_finer_one_is_off() {
    let place = Place::of(json!({
        "title": "small sea",
        "space": {"box": [TAU, TAU]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 0,
        "integrator": {"type": "gyro"},
        "particles": [{"species": "water", "count": 1024, "velocities": {"type": "rest"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": TAU,
            "rotation": TAU, "smoothing": {"length": 0.8},
            "surface": [{"type": "wave", "periods": [1, 2], "amplitude": 0.2}]}],
        "output": {"energies": {"every": 2}, "plot": {"width": 640, "height": 480}},
    }));
    let finer = ["--vary", "particles.0.count=256,1024", "--finer", "particles.0.count=2304", "--quiet"];
    let uncertainties = |summary: &TradeoffSummary| {
        ["depth_distance", "velocity_distance"]
            .map(|measure| summary.choices[0].error(measure).unwrap().uncertainty.unwrap())
    };
    succeeds(&borrowed(&arguments(&place, &finer)));
    let by_step = uncertainties(&TradeoffSummary::load(&place.path("out")).unwrap());
    let still = ["--still-finer", "particles.0.count=9216", "--force"];
    succeeds(&borrowed(&arguments(&place, &[&finer[..], &still].concat())));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    let by_particles = uncertainties(&summary);
    // Random places of 9 particles a node: the noise of their number outweighs any error of the step by far.
    assert!((0..2).all(|field| by_particles[field] > 3.0 * by_step[field]), "{by_step:?} {by_particles:?}");
    let names: Vec<&str> = summary.finer.iter().map(|run| run.name.as_str()).collect();
    assert_eq!(names, ["finer", "finer-twice-the-step", "still-finer"]);
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    let said = "The finer run is one of step 0.01 with `particles.0.count=2304`, uncertain by what `particles.0.count=9216` and twice its \
                step change.";
    assert!(page.contains(said), "{page}");
    succeeds(&["tradeoff", "--resume", &place.argument("out"), "--quiet"]);
    let wrong = ["--vary", "time.step=0.01,0.02", "--still-finer", "time.equilibration=3", "--force"];
    let told = ["`--still-finer time.equilibration=3`", "follows from the choices"];
    fails(&borrowed(&arguments(&place, &wrong)), 2, &told);
}

/// What analyses find has errors and references like any mean: diffusion, viscosity, and the distance of a radial distribution.
#[test]
fn analyses_are_measures_too() {
    let place = place()
        .with("/time/steps", json!(2000))
        .with("/output/diffusion", json!({"every": 5, "window": 20}))
        .with("/output/viscosity", json!({"every": 2, "window": 40}))
        .with("/output/radial_distribution", json!({"every": 20, "range": 1.5, "bins": 30}));
    let asked = "radial_distribution_distance,diffusion.diffusion_einstein,viscosity.shear_viscosity";
    succeeds(&borrowed(&arguments(&place, &["--vary", "time.step=0.02,0.04", "--measure", asked, "--quiet"])));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    assert_eq!(summary.measures.join(","), asked);
    for choice in &summary.choices {
        for measure in &summary.measures {
            let found = choice.error(measure).unwrap();
            assert!(
                found.error.is_finite() && found.uncertainty.is_some_and(|error| error > 0.0),
                "{measure}: {found:?}"
            );
        }
        // Sixteen runs with other seeds gave .278 and .80 on average, with standard deviations of .008 and .044: five of these are allowed.
        for (measure, expected, error) in
            [("diffusion.diffusion_einstein", 0.278, 0.04), ("viscosity.shear_viscosity", 0.80, 0.22)]
        {
            let found = choice.value(measure).unwrap().value;
            assert!((found - expected).abs() < error, "{measure}: {found}");
        }
        // The same runs had .0095 to .016, .012 on average.
        let distance = choice.value("radial_distribution_distance").unwrap().value;
        assert!(distance > 0.0 && distance < 5.0 * 0.012, "{distance}");
    }
    let names = listing(&place.path("out"));
    for measure in &summary.measures {
        assert!(names.contains(&files::plot(measure)), "{measure}: {names:?}");
    }
}

/// One that is interrupted after its first run, and then goes on, measures what one measures that is not.
#[test]
fn an_interrupted_tradeoff_goes_on() {
    let place = place();
    let request = || {
        let vary = ["time.step=0.02,0.04".to_owned()];
        Request::load(&place.scene(), &[], None, &vary, &[]).unwrap().with_measures(&["pressure".to_owned()]).unwrap()
    };
    let whole = TradeoffRun::start(request(), place.path("whole"));
    let whole = whole.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    let interrupt = Interrupt::default();
    let stopped = TradeoffRun::start(request(), place.path("parts")).until(&interrupt);
    let stopped = stopped.execute(&AdapterChoice::Best, &mut |event| {
        if matches!(event, StudyEvent::Ended { .. }) {
            interrupt.ask();
        }
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted { .. })), "{stopped:?}");
    assert!(!place.path("parts").join(files::TABLE).exists());
    let parts = TradeoffRun::resume(place.path("parts")).unwrap();
    let parts = parts.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    assert_eq!(parts.files, whole.files);
    for (one, other) in parts.summary.choices.iter().zip(&whole.summary.choices) {
        assert_eq!((one.steps, &one.measured), (other.steps, &other.measured), "{}", one.label);
    }
    assert_eq!(parts.summary.references, whole.summary.references);
    // One that was changed is none of ours.
    let path = place.path("parts").join(files::SUMMARY);
    let kept = fs::read_to_string(&path).unwrap();
    let reference = r#""references": [{"measure": "pressure", "value": 2, "uncertainty": 0, "source": "given"}],"#;
    let target = r#""targets": [{"measure": "temperature", "amount": {"relative": 0.01}}],"#;
    for (old, new, part) in [
        ("\"references\": [],", reference, "asks for something else"),
        ("\"targets\": [],", target, "and it lacks measures"),
        ("\"error\": null", "\"error\": 0.5", "asks for something else"),
        ("\"also\": []", "\"also\": [\"seed=7\"]", "and it has other runs"),
    ] {
        assert!(kept.contains(old), "{old}");
        fs::write(&path, kept.replacen(old, new, 1)).unwrap();
        fails(&["tradeoff", "--resume", &place.argument("parts")], 5, &["was changed", part]);
    }
}

/// What the run of the small fluid has to become longer for: the mean of 40 rows, each of which scatters by 6 %, errs by .95 % at least, and
/// by more where rows depend on each other.
fn longer(place: &Place) -> Request {
    let vary = ["time.step=0.04,0.2".to_owned()];
    let request = Request::load(&place.scene(), &[], None, &vary, &[]).unwrap();
    let length = Length { error: Some(ERROR), budget: None };
    request.with_length(length).with_measures(&["temperature".to_owned()]).unwrap()
}

const ERROR: f64 = 0.004;

/// All runs are made longer until every mean is as certain as it is to be; one that is interrupted while they are comes to the same table.
#[test]
fn errors_are_reached_also_by_what_is_interrupted_within_an_extension() {
    let place = place();
    let (mut factors, mut announced, mut ended) = (Vec::new(), 0, 0);
    let whole = TradeoffRun::start(longer(&place), place.path("whole"));
    let whole = whole.execute(&AdapterChoice::Best, &mut |event| match event {
        StudyEvent::Started { runs, .. } => announced = runs,
        StudyEvent::Ended { .. } => ended += 1,
        StudyEvent::Phase { phase, runs } => {
            assert_eq!(ended, announced, "another phase follows");
            announced += runs;
            if let Phase::Extended { factor, seconds, rounds, total, .. } = phase {
                factors.push(*factor);
                assert!(*rounds > 0 && total >= seconds, "{phase:?}");
                assert_eq!(*rounds > 1, phase.to_string().contains(&format!("{rounds} such rounds are expected")));
            }
        }
        _ => {}
    });
    let whole = whole.unwrap().summary;
    // The step that is too long is run once; the finer run, of half the shortest, and the other every time.
    assert_eq!(whole.choices[1].state, ChoiceState::Unstable);
    assert_eq!((announced, ended), (3 + 2 * factors.len(), 3 + 2 * factors.len()));
    assert!(!factors.is_empty() && whole.extensions == factors.len(), "{factors:?}");
    let grown = 6.4 * factors.iter().product::<f64>();
    assert!((whole.averaged_time() / grown - 1.0).abs() < 1e-12);
    let worst = whole.choices[..1].iter().map(|choice| {
        // To the next row of the table, which is .16 long.
        let time = choice.steps as f64 * choice.time_step - 1.6;
        assert!(time > grown - 1e-9 && time < grown + 0.16 + 1e-9, "{}: {time} {grown}", choice.label);
        let measured = choice.value("temperature").unwrap();
        measured.uncertainty().unwrap() / measured.value
    });
    // Or the program says that it has not.
    let worst = worst.fold(0.0, f64::max);
    assert_eq!(whole.is_short, worst > ERROR, "{worst}");

    let interrupt = Interrupt::default();
    let mut extended = false;
    let stopped = TradeoffRun::start(longer(&place), place.path("parts")).with_jobs(Some(1)).until(&interrupt);
    let stopped = stopped.execute(&AdapterChoice::Best, &mut |event| match event {
        StudyEvent::Phase { phase: Phase::Extended { .. }, .. } => extended = true,
        StudyEvent::Advanced { .. } if extended => interrupt.ask(),
        _ => {}
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted { .. })), "{stopped:?}");
    let before = TradeoffSummary::load(&place.path("parts")).unwrap();
    assert_eq!(before.extensions, 1);
    assert!(before.choices[0].steps < whole.choices[0].steps, "nothing was left to do");
    let parts = TradeoffRun::resume(place.path("parts")).unwrap();
    let parts = parts.execute(&AdapterChoice::Best, &mut |_| {}).unwrap().summary;
    assert_eq!(
        (parts.extensions, parts.is_short, &parts.references),
        (whole.extensions, whole.is_short, &whole.references)
    );
    // The whole table but for what was timed, and what follows from that.
    let table = |name: &str| {
        let text = fs::read_to_string(place.path(name).join(files::TABLE)).unwrap();
        let rows: Vec<Vec<String>> = text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
        let timed = |column: &String| column.contains("second") || column.ends_with("_on_front");
        let kept: Vec<usize> = (0..rows[0].len()).filter(|place| !timed(&rows[0][*place])).collect();
        rows.into_iter().map(|row| kept.iter().map(|place| row[*place].clone()).collect()).collect::<Vec<Vec<_>>>()
    };
    assert_eq!(table("parts"), table("whole"));
}

/// A budget shortens what would take an hour, and says that it has not come to an error that no budget reaches.
#[test]
fn budgets_limit_what_errors_ask_for() {
    let place = place();
    let further = [
        "--vary",
        "time.step=0.02,0.04",
        "--set",
        "time.steps=40000000",
        "--measure",
        "temperature",
        "--budget",
        "2s",
        "--error",
        "0.00001",
    ];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("budget"), "{said}");
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    assert!(summary.is_short && summary.spent > 0.0);
    // A scene of 1.6 million units of time, of which even a very fast machine comes to a hundredth at most.
    assert!(summary.averaged_time() < 16_000.0, "{}", summary.averaged_time());
    let times: Vec<f64> = summary.choices.iter().map(|choice| choice.steps as f64 * choice.time_step - 1.6).collect();
    assert!(times.iter().all(|time| (time - summary.averaged_time()).abs() < 0.17), "{times:?}");
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains("The runs ended before all errors were as small as asked for: a larger --budget"), "{page}");
}

/// Oscillators whose coordinates have baths with memory: errors against the exact motion are those that theory says of the scheme.
#[test]
fn schemes_err_as_theory_says() {
    let place = Place::of(json!({
        "title": "oscillators",
        "space": {"box": [100, 100, 100]},
        "time": {"step": 0.25, "steps": 480, "equilibration": 80},
        "temperature": 1,
        "particles": [{"species": "oscillator", "count": 2000}],
        "interactions": [
            {"type": "tether", "stiffness": 1},
            {"type": "langevin", "friction": 1, "bath": {"type": "memory", "rate": 1}},
        ],
        "output": {"energies": {"every": 4}, "plot": {"width": 640, "height": 480}, "snapshot": {"width": 100, "height": 80}},
    }));
    let products = "bath_times_displacement,bath_times_momentum,momentum_times_displacement";
    let measures = format!("potential_energy,bath_square,temperature,{products}");
    let further = ["--vary", "time.step=0.25,1", "--measure", &measures, "--quiet"];
    succeeds(&borrowed(&arguments(&place, &further)));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    // The exact motion: three coordinates of kT/2 each, and ⟨s²⟩ = kT λ.
    let references: Vec<f64> = summary.references.iter().map(|reference| reference.value).collect();
    assert_eq!(references, [3000.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    // Of dt = 1: λₑ = 2/3, B = 2/3, W = 1, worked out by hand.
    let coarse = summary.choices.iter().find(|choice| choice.time_step == 1.0).unwrap();
    for (measure, expected) in [
        ("potential_energy", 3.0 / 7.0),
        ("bath_square", -1.0 / 7.0),
        ("temperature", 0.0),
        ("bath_times_displacement", 2.0 / 7.0),
        ("bath_times_momentum", 0.0),
        ("momentum_times_displacement", 0.0),
    ] {
        let of_scheme = coarse.error(measure).unwrap().of_scheme.unwrap();
        assert!((of_scheme - expected).abs() < 1e-12, "{measure}: {of_scheme}");
    }
    for choice in &summary.choices {
        for error in &choice.errors {
            // Five standard errors, which are themselves known to a tenth or so.
            let (of_scheme, uncertainty) = (error.of_scheme.unwrap(), error.uncertainty.unwrap());
            assert!(uncertainty < 0.02, "{}: {error:?}", choice.label);
            assert!((error.error - of_scheme).abs() < 5.0 * uncertainty, "{}: {error:?}", choice.label);
        }
    }
    let header = fs::read_to_string(place.path("out").join(files::TABLE)).unwrap();
    assert!(header.lines().next().unwrap().contains("potential_energy_error_of_scheme"), "{header}");
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains("What theory says of the scheme"), "{page}");
    // A target at the error itself stays open, and asks for more samples also where nothing but what should be zero is measured.
    let fine = summary.choices.iter().find(|choice| choice.time_step == 0.25).unwrap();
    let size = fine.error("bath_times_displacement").unwrap().size();
    let (target, open) = (format!("bath_times_displacement={size}"), place.argument("open"));
    let further = ["tradeoff", &place.scene(), "--vary", "time.step=0.25", "--quiet", "--out", &open];
    succeeds(&[&further[..], &["--measure", "bath_times_displacement", "--target", &target]].concat());
    assert!(TradeoffSummary::load(&place.path("open")).unwrap().extensions > 0);
}

/// A wave that is in balance, with a loop of tracers: how far fields are from those of the start falls with the square of the spacing of nodes,
/// as what splines take from the wave does, and the loop keeps its circulation.
#[test]
fn flows_are_compared_with_what_is_exact() {
    let place = Place::of(json!({
        "title": "wave",
        "space": {"box": [TAU, TAU]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 0,
        "integrator": {"type": "gyro"},
        "particles": [
            {"species": "water", "count": 4096, "placement": {"type": "lattice"}, "velocities": {"type": "geostrophic"}},
            {"species": "loop", "count": 256, "tracer": true, "velocities": {"type": "geostrophic"},
                "placement": {"type": "circle", "center": [3, 3], "radius": 1}},
        ],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": TAU,
            "rotation": TAU, "smoothing": {"length": 0.8},
            "surface": [{"type": "wave", "periods": [0, 1], "amplitude": 0.1}]}],
        "output": {"energies": {"every": 2}, "fields": {"quantities": ["depth", "speed"]},
            "plot": {"width": 640, "height": 480}},
    }));
    let further = ["--vary", "time.step=0.02", "--also", "interactions.0.mesh=[32,32]", "--quiet"];
    succeeds(&borrowed(&arguments(&place, &further)));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    for measure in ["circulation_drift", "depth_from_exact", "velocity_from_exact"] {
        assert!(summary.measures.iter().any(|known| known == measure), "{measure}: {:?}", summary.measures);
    }
    let error = |place: usize, measure: &str| summary.choices[place].error(measure).unwrap().size();
    for measure in ["depth_from_exact", "velocity_from_exact"] {
        let [coarse, fine] = [0, 1].map(|place| error(place, measure));
        // Of second order; the adjustment to the balance that there is on the nodes leaves waves whose phase is any.
        assert!(coarse > 2.0 * fine && fine > 0.0, "{measure}: {coarse} {fine}");
        // Cubic splines take 1 - (sin x/x)⁴ of a wave with x = π/16, 2.6 %, and again where they are interpolated.
        assert!(coarse > 0.005 && coarse < 0.15, "{measure}: {coarse}");
    }
    // 256 points on a circle of radius 1 are .025 apart, so that circulation is known to much better than this.
    assert!((0..2).all(|place| error(place, "circulation_drift") < 1e-3));
}

/// A scene with a longer step has fewer of them, so that it covers the time that the scene of the user does.
#[test]
fn a_scene_that_is_written_covers_the_same_time() {
    let place = place();
    let path = place.argument("new.json");
    let further =
        ["--set", "time.step=0.01", "--vary", "time.step=0.04", "--target", "temperature=50%", "--write", &path];
    let said = succeeds(&borrowed(&arguments(&place, &[&further[..], &["--measure", "temperature"]].concat())));
    let written: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let time = &written["time"];
    assert_eq!((&time["step"], &time["steps"], &time["equilibration"]), (&json!(0.04), &json!(50), &json!(10)));
    for line in ["time.step: 0.04", "time.steps: 50", "time.equilibration: 10"] {
        assert!(said.contains(line), "`{line}` is not in: {said}");
    }
}

/// Of Voronoi cells with energies the limit on what crosses a face acts more often in longer steps.
#[test]
fn limited_exchanges_are_counted() {
    let place = Place::of(json!({
        "title": "cells",
        "space": {"box": [14, 14]},
        "time": {"step": 0.02, "steps": 64},
        "temperature": 1,
        "particles": [{"species": "A", "count": 196, "mass": 5, "placement": {"type": "lattice", "jitter": 0.25}}],
        "interactions": [{"type": "voronoi", "form": "consistent", "exchange_limit": 0.02}],
        "output": {"energies": {"every": 4}, "plot": {"width": 640, "height": 480}, "snapshot": {"width": 100, "height": 80}},
    }));
    let further = ["--vary", "time.step=0.02,0.08", "--measure", "limited_exchange_share", "--quiet"];
    succeeds(&borrowed(&arguments(&place, &further)));
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    let shares: Vec<f64> =
        summary.choices.iter().map(|choice| choice.error("limited_exchange_share").unwrap().error).collect();
    assert!(shares[0] < shares[1] && shares[1] > 0.0, "{shares:?}");
    for (choice, share) in summary.choices.iter().zip(&shares) {
        let table = read_table(&place.path("out").join(&choice.name).join(run_files::ENERGIES)).unwrap();
        let cut = table.column("limited_exchanges").unwrap();
        let faces = 3.0 * 196.0 * choice.steps as f64;
        assert!((share * faces - cut.last().unwrap()).abs() < 1e-6 * faces, "{share} {cut:?}");
    }
}

/// Ten rows are too few to know an error: a target that they seem to meet is open, and the table marks them.
#[test]
fn errors_from_few_samples_decide_nothing() {
    let place = place();
    let few =
        ["--vary", "time.step=0.02,0.04", "--set", "time.steps=80", "--measure", "temperature", "--budget", "1000s"];
    let request = |target: &str| {
        let (set, vary) = (["time.steps=80".to_owned()], ["time.step=0.02,0.04".to_owned()]);
        let request = Request::load(&place.scene(), &set, None, &vary, &[]).unwrap();
        let request = request.with_measures(&["temperature".to_owned()]).unwrap();
        request.with_targets(vec![mesoscope::tradeoff::Target::parse(target).unwrap()]).unwrap()
    };
    // What the samples of ten rows say of themselves.
    let mut factors = 0;
    let run = TradeoffRun::start(request("temperature=1000%"), place.path("met"));
    let met = run.execute(&AdapterChoice::Best, &mut |_| {}).unwrap().summary;
    let choice = &met.choices[1];
    let (measured, error) = (choice.value("temperature").unwrap(), choice.error("temperature").unwrap());
    assert!(measured.from_few_samples && error.from_few_samples, "{measured:?}");
    let own = measured.standard_error.unwrap();
    assert!((error.uncertainty.unwrap() / (3.0 * own) - 1.0).abs() < 1e-12, "{error:?}");
    // Between two and six standard errors from the error that was found, a target is open, and asks for more samples.
    let target = error.size() + 4.0 * own;
    let run = TradeoffRun::start(request(&format!("temperature={target}")), place.path("open"));
    let open = run.execute(&AdapterChoice::Best, &mut |event| {
        factors += usize::from(matches!(event, StudyEvent::Phase { phase: Phase::Extended { .. }, .. }));
    });
    assert!(factors > 0, "{:?}", open.unwrap().summary.choices);
    let said = succeeds(&borrowed(&arguments(&place, &few[..few.len() - 2])));
    assert!(said.contains("‡ from few samples") && said.contains(" % ‡"), "{said}");
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains(" % ‡ ") && page.contains("‡ from few samples"), "{page}");
}

/// An error that takes longer runs than are allowed is announced after the first ones, whose tables are there, and begun when that is said to be
/// wanted. What is allowed is thirty times what the first runs take here, of which longer ones would take a thousand times as much.
#[test]
fn an_error_that_takes_too_long_wants_to_be_said_twice() {
    let place = place();
    let request = |error: Option<f64>| {
        let request = Request::load(&place.scene(), &[], None, &["time.step=0.02,0.04".to_owned()], &[]).unwrap();
        request.with_length(Length { error, budget: None }).with_measures(&["temperature".to_owned()]).unwrap()
    };
    let begun = Instant::now();
    TradeoffRun::start(request(None), place.path("plain")).execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    let allowed = 30 * begun.elapsed();
    let asked = || TradeoffRun::start(request(Some(1e-6)), place.path("out")).up_to(Some(allowed));
    let continued = || TradeoffRun::resume(place.path("out")).unwrap().up_to(Some(allowed));
    // It goes on where it was, and does not without being allowed to.
    for run in [&asked as &dyn Fn() -> TradeoffRun, &continued] {
        let summary = run().execute(&AdapterChoice::Best, &mut |_| {}).unwrap().summary;
        let wanted = summary.wanted.unwrap();
        assert!(wanted.rounds == 5 && wanted.seconds > allowed.as_secs_f64(), "{wanted:?}");
        assert!(wanted.to_string().contains("5 more rounds of longer runs"), "{wanted}");
        assert!(summary.is_short && summary.extensions == 0 && summary.choices[0].cost.is_some());
        let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
        assert!(page.contains("what is asked for takes 5 more rounds") && page.contains("wants --yes"), "{page}");
    }
    let interrupt = Interrupt::default();
    let mut phases = Vec::new();
    let run = TradeoffRun::resume(place.path("out")).unwrap().until(&interrupt);
    let ended = run.execute(&AdapterChoice::Best, &mut |event| {
        if let StudyEvent::Phase { phase, .. } = event {
            phases.push(*phase);
            interrupt.ask();
        }
    });
    assert!(matches!(ended, Err(StudyError::Interrupted { .. })), "{ended:?}");
    assert!(matches!(phases[..], [Phase::Extended { rounds: 5, .. }]), "{phases:?}");
}

/// Of a reference that is zero only after the runs it is said then that there are no parts of it.
#[test]
fn parts_of_nothing_are_named() {
    let place = place();
    let further =
        ["--vary", "time.step=0.02,0.04", "--target", "center_of_mass_velocity_x=1%", "--measure", "temperature"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    let reason = "The reference of `center_of_mass_velocity_x` is 0, so that a percentage of it means nothing";
    assert!(said.contains(reason) && said.contains("--target center_of_mass_velocity_x=VALUE"), "{said}");
    let summary = TradeoffSummary::load(&place.path("out")).unwrap();
    assert_eq!((summary.choice(), summary.extensions), (None, 0));
}

/// Choices that a setting does not tell apart are the same run, and those of another seed are not.
#[test]
fn choices_that_are_the_same_run_are_said_to_be() {
    let place = place();
    let further = [
        "--set",
        r#"integrator={"type":"splitting","relaxation":"two-stages"}"#,
        "--vary",
        "noise.distribution=uniform,gaussian",
        "--also",
        "seed=7",
        "--measure",
        "temperature",
    ];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    let note = "`distribution = uniform` and `distribution = gaussian` are the same run";
    assert!(said.contains(note) && said.matches("are the same run").count() == 1, "{said}");
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains(note), "{page}");
}

/// What a scene says beforehand that its analyses find is what a run of it finds.
#[test]
fn analyses_find_what_they_say_beforehand() {
    let counts = ["samples", "windows", "values", "range", "bins", "wave_number"];
    let small = ["time.steps=120", "time.equilibration=20"];
    let all = r#"output={"energies":{"every":4},"radial_distribution":{"every":4,"range":2},"diffusion":{"every":2,"window":10},
        "viscosity":{"every":2,"window":20},"stress":{"every":1,"window":20,"normal":"z"},"profiles":{"every":2,"axis":"z","bins":4},
        "histograms":[{"quantity":"velocity","every":2},{"quantity":"speed","every":2}],
        "autocorrelations":[{"quantity":"velocity","every":1,"window":20}]}"#;
    let cells = r#"output={"energies":{"every":4},"neighbours":{"every":4},"shear_wave":{"every":4}}"#;
    for (scene, set) in [
        ("dpd-fluid", &["space.box=[5,5,5]", all][..]),
        ("voronoi-shear", &[cells]),
        ("harmonic-chain", &[]),
        ("shear", &["space.box=[6,6,6]"]),
    ] {
        let set: Vec<String> = small.iter().chain(set).map(|set| (*set).to_owned()).collect();
        let scene = mesoscope::scene::load(scene, &set).unwrap();
        let asked = mesoscope::run::asked_analyses(&scene);
        let place = place();
        let run = mesoscope::run::Run::start(scene.clone(), place.path("run"));
        let results = run.execute(&AdapterChoice::Best, &mut |_| {}).unwrap().summary.results;
        for asked in asked {
            let Some(Value::Object(result)) = results.get(asked.id.name()) else { continue };
            let is_number = |value: &Value| value.is_number() || value["value"].is_number() || value.is_null();
            let there = result.iter().filter(|(_, value)| is_number(value)).map(|(name, _)| name.as_str());
            let mut there: Vec<&str> = there.filter(|name| !counts.contains(name)).collect();
            let mut said = asked.found.clone();
            there.sort_unstable();
            said.sort_unstable();
            assert_eq!(there, said, "{} of {}", asked.id.name(), scene.title);
        }
    }
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
        (
            &[
                "--vary",
                "time.step=0.02,0.04",
                "--set",
                r#"output.radial_distribution={"every":4,"range":2}"#,
                "--target",
                "radial_distribution.peak_hight=1%",
            ],
            2,
            &["did you mean `radial_distribution.peak_height`?"],
        ),
        (
            &["--vary", "time.step=0.02,0.04", "--target", "momentum_x=1%"],
            2,
            &["the reference of `momentum_x` is 0", "`--target momentum_x=VALUE`"],
        ),
        (
            &["--vary", "time.step=0.02,0.04", "--reference", "pressure=0", "--target", "pressure=1%"],
            2,
            &["the reference of `pressure` is 0"],
        ),
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
    fails(&["tradeoff", "--resume", &place.argument("nowhere")], 5, &["is no directory"]);
}

/// A run of a day is announced and not begun.
#[test]
fn what_takes_a_day_has_to_be_said_twice() {
    let place = place();
    let vary = ["--vary", "time.step=0.02,0.04", "--set", "time.steps=4000000000"];
    fails(&borrowed(&arguments(&place, &vary)), 2, &["--yes", "--budget", "about ", " days"]);
    assert!(!place.path("out").exists());
}
