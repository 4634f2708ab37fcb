//! `mesoscope stability` as its user meets it: verdicts, edges, laws, messages and exit codes.

use std::fs;

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::OutputError;
use mesoscope::run::Interrupt;
use mesoscope::stability::{Request, StabilityRun, StabilitySummary, Verdict, files};
use mesoscope::study::{StudyError, StudyEvent};
use serde_json::json;

use crate::support::program::{Place, fails, listing, size, succeeds};

/// Oscillators of frequency 4 with a bath, of which Cotter and Reich's schemes know every variance.
fn place() -> Place {
    Place::of(json!({
        "title": "oscillators",
        "space": {"box": [20, 20, 20]},
        "time": {"step": 0.05, "steps": 240, "equilibration": 40},
        "temperature": 1,
        "integrator": {"type": "cotter-reich"},
        "particles": [{"species": "oscillator", "count": 1000}],
        "interactions": [
            {"type": "tether", "stiffness": 16},
            {"type": "langevin", "friction": 1, "bath": {"type": "memory", "rate": 2, "scheme": "symmetric"}},
        ],
        "output": {"energies": {"every": 4}, "plot": {"width": 640, "height": 480}},
    }))
}

fn arguments<'a>(place: &'a Place, further: &[&'a str]) -> Vec<String> {
    let own = ["stability".to_owned(), place.scene(), "--out".to_owned(), place.argument("out")];
    own.into_iter().chain(further.iter().map(|argument| (*argument).to_owned())).collect()
}

fn borrowed(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

/// Water on a mesh is stable while no wave turns by more than its limit in a step, p = 1; well below the energy is kept, and beyond twice that
/// no run lasts.
#[test]
fn water_is_stable_up_to_its_stiffest_wave() {
    let place = Place::of(json!({
        "title": "waves",
        "space": {"box": [6.25, 6.25]},
        "time": {"step": 0.02, "steps": 200},
        "temperature": 0,
        "particles": [{"species": "water", "count": 1024, "placement": {"type": "lattice"},
            "velocities": {"type": "geostrophic"}}],
        "interactions": [{"type": "shallow-water", "mesh": [16, 16], "wave_speed": 6.25, "rotation": 6.25,
            "smoothing": {"length": 0.8}, "surface": [{"type": "wave", "periods": [1, 1], "amplitude": 0.05}]}],
        "output": {"energies": {"every": 4}, "plot": {"width": 640, "height": 480}},
    }));
    let further = ["--vary", "time.step=0.02..1.28/4", "--bisections", "1"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("p = 1, water spread evenly at"), "{said}");
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    assert_eq!(summary.measures, ["energy_drift"]);
    let row = &summary.rows[0];
    let limit = row.bounds.iter().chain(&row.outside).find(|bound| bound.law.starts_with("p = 1")).unwrap().at;
    for cell in &row.cells {
        let (right, lost) = (cell.value < 0.25 * limit, cell.value > 2.0 * limit);
        assert!(!right || cell.verdict == Verdict::Right, "{limit}: {cell:?}");
        assert!(!lost || cell.verdict >= Verdict::Unstable, "{limit}: {cell:?}");
    }
    assert!(row.cells.iter().any(|cell| cell.value < 0.25 * limit), "{row:?}");
    assert!(row.cells.iter().any(|cell| cell.value > 2.0 * limit), "{row:?}");
}

/// Cells whose friction is solved for keep their temperature at steps at which the explicit scheme is far too hot, or ends.
#[test]
fn cells_are_right_with_steps_that_are_too_long_for_the_explicit_scheme() {
    let place = Place::of(json!({
        "title": "cells",
        "space": {"box": [8, 8]},
        "time": {"step": 0.05, "steps": 1200, "equilibration": 200},
        "temperature": 1,
        "particles": [{"species": "fluid", "count": 64, "mass": 5, "placement": {"type": "lattice", "jitter": 0.3},
            "velocities": {"type": "thermal"}}],
        "interactions": [{"type": "voronoi", "form": "gradient", "viscosity": 1, "molecular_mass": 0.02}],
        "output": {"energies": {"every": 5}, "plot": {"width": 640, "height": 480}},
    }));
    let further = ["--vary", "integrator.type=splitting,euler", "--vary", "time.step=0.02,0.05", "--bisections", "0"];
    let further = [&further[..], &["--tolerance", "20%", "--measure", "temperature"]].concat();
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("dt η/M = 1/20"), "{said}");
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    let verdicts = |row: usize| -> Vec<Verdict> { summary.rows[row].cells.iter().map(|cell| cell.verdict).collect() };
    // Of 64 cells a row scatters by 1/8; of 50 units of time the mean by 3 %, judging from friction that forgets in ten.
    assert_eq!(verdicts(0), [Verdict::Right, Verdict::Right], "{:?}", summary.rows[0]);
    assert!(verdicts(1)[1] >= Verdict::Biased, "{:?}", summary.rows[1]);
}

/// With λₑ = αγ the mean square of q is (kT/K)(4 - B)/(4 - B - W): an excess of W/(4 - B - W), and no scheme is stable beyond B + W = 4,
/// which is at dt = .4714 here.
#[test]
fn a_row_is_right_biased_and_unstable_where_theory_says() {
    let place = place();
    let further = ["--vary", "time.step=0.02..0.8/6", "--bisections", "3", "--tolerance", "10%"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    for part in ["RIGHT: time.step UP TO", "B + W = 4 at 0.47", "stability.png", "then the edges", ", at most "] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let out = place.path("out");
    let summary = StabilitySummary::load(&out).unwrap();
    let row = &summary.rows[0];
    let verdicts: Vec<Verdict> = row.cells.iter().map(|cell| cell.verdict).collect();
    assert!(verdicts.is_sorted(), "{verdicts:?}");
    // Neighbours are a factor of 40^(1/5) apart, an eighth of that after three bisections: 1.097.
    let factor = 1.1;
    let limit = (4.0_f64 / (16.0 + 2.0)).sqrt();
    let bound = &row.bounds[0];
    assert!((bound.at / limit - 1.0).abs() < 1e-3 && bound.is_of_stability, "{bound:?}");
    let edges = row.edges();
    let last = edges.last().unwrap();
    assert_eq!((last.below, last.above), (Verdict::Biased, Verdict::Unstable));
    // Beyond the limit a mode grows by a factor each step, at 1.05 of it by e^(2·√.1) = 1.9, which 256 steps show. Before it the mean square
    // of q grows as 1/(4 - B - W), and the impulses of the widest of 1 000 oscillators leave their range a little before all do.
    assert!(last.high / last.low < factor, "{last:?}");
    assert!(last.low < limit * factor && last.high > 0.8 * limit, "{last:?} {limit}");
    // 10 % are reached at W/(4 - B - W) = .1, and with an error of 5 % of the mean of 3 000 squares over 50 rows or more, taken as
    // independent every quarter of a period, it lies within a factor 1.3 of that.
    let biased = (0.1_f64 * 4.0 / (16.0 + 0.1 * 18.0)).sqrt();
    let (_, right, is_bounded) = row.right().unwrap();
    assert!(is_bounded && right > biased / 1.3 && right < biased * 1.3, "{right} {biased}");
    // The configurational temperature is that of q; it is what is off.
    for cell in row.cells.iter().filter(|cell| cell.verdict == Verdict::Biased) {
        let error = |measure: &str| cell.error(measure).map_or(f64::NAN, |error| error.error);
        assert!(error("configurational_temperature") > 0.0 && error("temperature").abs() < 0.1, "{cell:?}");
    }
    // The table has a row for every scene.
    let table = fs::read_to_string(out.join(files::TABLE)).unwrap();
    assert_eq!(table.lines().count(), row.cells.len() + 1);
    assert!(table.starts_with("time.step,verdict,certain,steps,time_step,temperature_error,"), "{table}");
    assert_eq!(size(&out.join(files::PLOT)), (640, 480));
    let page = fs::read_to_string(out.join(files::PAGE)).unwrap();
    assert!(page.contains("| the scene | 0.") && page.contains("B + W = 4 at 0.47"), "{page}");
    assert_eq!(listing(&out), [files::TABLE, files::SUMMARY, files::PAGE, files::PLOT]);
}

/// The scheme named `cotter-reich` has a λₑ that falls as the step grows, and a later edge.
#[test]
fn a_map_has_rows_of_any_key() {
    let place = place();
    let further = [
        "--vary",
        "interactions.1.bath.scheme=cotter-reich,symmetric",
        "--vary",
        "time.step=0.1..0.9/3:linear",
        "--measure",
        "temperature",
        "--bisections",
        "0",
        "--jobs",
        "2",
    ];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("scheme = cotter-reich") && !said.contains("locate"), "{said}");
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    assert_eq!(summary.measures, ["temperature"]);
    for row in &summary.rows {
        let found: Vec<(f64, Verdict)> = row.cells.iter().map(|cell| (cell.value, cell.verdict)).collect();
        let expected = [(0.1, Verdict::Right), (0.5, Verdict::Unstable), (0.9, Verdict::Unstable)];
        assert_eq!(found, expected, "{}", row.label);
        assert_eq!(row.bounds.len(), 1, "{:?}", row.bounds);
    }
    let [first, second] = [0, 1].map(|row: usize| summary.rows[row].bounds[0].at);
    assert!(first > second, "{first} {second}");
}

/// Without friction there is no bath that keeps a temperature: a run that has none is not said to be certainly right.
#[test]
fn what_no_law_applies_to_is_not_certain() {
    let place = place();
    let further = ["--vary", "interactions.1.friction=0,1", "--measure", "temperature", "--tolerance", "30%"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("1 runs count as right though no law says"), "{said}");
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    let found: Vec<(Verdict, bool, usize)> =
        summary.rows[0].cells.iter().map(|cell| (cell.verdict, cell.is_certain, cell.errors.len())).collect();
    // 3 000 squares scatter by 2.6 % of their mean: 30 % are more than ten of that.
    assert_eq!(found, [(Verdict::Right, false, 0), (Verdict::Right, true, 1)]);
}

#[test]
fn an_interrupted_map_goes_on() {
    let place = place();
    let request =
        || Request::load(&place.scene(), &[], None, &["time.step=0.05..0.4/4".to_owned()]).unwrap().with_bisections(0);
    let whole = StabilityRun::start(request(), place.path("whole")).with_jobs(Some(1));
    let whole = whole.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    let interrupt = Interrupt::default();
    let out = place.path("out");
    let stopped = StabilityRun::start(request(), &out).with_jobs(Some(1)).until(&interrupt).execute(
        &AdapterChoice::Best,
        &mut |event| {
            if let StudyEvent::Ended { ended, .. } = event
                && ended.value > 0.1
            {
                interrupt.ask();
            }
        },
    );
    assert!(matches!(stopped, Err(StudyError::Interrupted { .. })));
    let before = StabilitySummary::load(&out).unwrap();
    assert!((1..4).contains(&before.rows[0].cells.len()));
    // A map that is not finished is in the way of another.
    let again = StabilityRun::start(request(), &out).execute(&AdapterChoice::Best, &mut |_| {});
    assert!(matches!(again, Err(StudyError::Output(OutputError::ResultExists { .. }))));
    let said = succeeds(&["stability", "--resume", &place.argument("out")]);
    assert!(said.contains("RIGHT: time.step UP TO"), "{said}");
    let after = StabilitySummary::load(&out).unwrap();
    assert_eq!(after.rows, whole.summary.rows);
    let tables = ["whole", "out"].map(|name| fs::read(place.path(name).join(files::TABLE)).unwrap());
    assert!(tables[0] == tables[1]);
    // One that was changed is none of ours.
    let path = out.join(files::SUMMARY);
    let kept = fs::read_to_string(&path).unwrap();
    let reference = r#""references": [{"measure": "temperature", "value": 2, "uncertainty": 0, "source": "given"}],"#;
    let version = concat!("\"mesoscope_version\": \"", env!("CARGO_PKG_VERSION"), "\"");
    for (old, new, part) in [
        ("\"time.step=0.05..0.4/4\"", "\"time.step=0.05..0.4/5\"", "asks for something else"),
        ("\"tolerance\": 0.05", "\"tolerance\": 0.5", "asks for something else"),
        ("\"references\": [],", reference, "and it compares other measures"),
        ("\"mesoscope_version\": \"", "\"mesoscope_version\": \"9", "later than this one"),
        (version, "\"mesoscope_version\": \"99.0.0-rc.1\"", "later than this one"),
        (version, "\"mesoscope_version\": \"latest\"", "has a `mesoscope_version` that is no version"),
    ] {
        assert!(kept.contains(old), "{old}");
        fs::write(&path, kept.replacen(old, new, 1)).unwrap();
        let changed = if part.starts_with("later") { "was written by version" } else { "was changed" };
        fails(&["stability", "--resume", &place.argument("out")], 5, &[changed, part]);
    }
}

#[test]
fn mistakes_are_named_before_anything_runs() {
    let place = place();
    let wrong: [(&[&str], &[&str]); 8] = [
        (&["--vary", "time.setp=0.1..1/3"], &["did you mean `step`?"]),
        (&["--vary", "time.step=1..0.1/3"], &["1 is not below 0.1"]),
        (&["--vary", "time.step=0.1..1"], &["key=low..high/points"]),
        (&["--vary", "time.step=0.1..1/10000000"], &["accepted: 2 to 200"]),
        (&["--vary", "time.steps=10..1000/3"], &["all runs cover the same simulated time"]),
        (&["--vary", "time.step=0.1..1/3", "--vary", "seed=1,2", "--vary", "temperature=1,2"], &["3 keys are varied"]),
        (
            &["--measure", "temprature"],
            &["`--measure temprature`: no run of this scene measures that", "did you mean `temperature`?"],
        ),
        (&["--measure", "momentum_x"], &["--reference momentum_x=VALUE"]),
    ];
    for (further, parts) in wrong {
        fails(&borrowed(&arguments(&place, further)), 2, parts);
    }
    fails(&borrowed(&arguments(&place, &["--vary", "time.step=0.1..1/1"])), 2, &["1 point; accepted: 2 to 200"]);
    fails(&borrowed(&arguments(&place, &["--set", "time.steps=900000000000"])), 2, &["--yes", "at most "]);
    fails(&["stability", "--resume", &place.argument("nothing")], 5, &["nothing` is no directory"]);
    std::fs::create_dir(place.path("empty")).unwrap();
    fails(&["stability", "--resume", &place.argument("empty")], 5, &["there is no map of stability"]);
    assert!(!place.path("out").exists());
}

/// Nobody says what the chain should measure: what ran to its end is not called right, and the picture shows where that was.
#[test]
fn what_is_compared_with_nothing_is_not_right() {
    let place = place();
    let vary =
        ["--vary", "time.step=0.1,2", "--bisections", "0", "--set", "time.steps=40", "--set", "time.equilibration=0"];
    let own = ["stability", "harmonic-chain", "--out"].map(str::to_owned).into_iter().chain([place.argument("out")]);
    let printed = succeeds(&borrowed(&own.chain(vary.map(str::to_owned)).collect::<Vec<_>>()));
    assert!(printed.contains("RAN TO ITS END: time.step UP TO") && !printed.contains("RIGHT"), "{printed}");
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains("nothing is compared") && page.contains("ran to its end: step up to"), "{page}");
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    let verdicts: Vec<Verdict> = summary.rows[0].cells.iter().map(|cell| cell.verdict).collect();
    assert_eq!(verdicts, [Verdict::Right, Verdict::Unstable]);
}

/// Oscillators at rest that a weak bath warms within ten units of time: the means of the first thirty say nothing of the step.
#[test]
fn runs_on_their_way_to_equilibrium_are_not_certain() {
    let place = place();
    let further = [
        "--vary",
        "time.step=0.05,0.06",
        "--bisections",
        "0",
        "--set",
        r#"particles.0.velocities={"type":"rest"}"#,
        "--set",
        "interactions.1.friction=0.1",
        "--set",
        "time.steps=600",
        "--set",
        "time.equilibration=0",
    ];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("2 of 2 runs are still on their way to equilibrium"), "{said}");
    let summary = StabilitySummary::load(&place.path("out")).unwrap();
    for cell in &summary.rows[0].cells {
        assert!(!cell.is_certain && cell.unequilibrated.contains(&"temperature".to_owned()), "{cell:?}");
    }
    assert!(!said.contains("verdicts are within two standard errors"), "{said}");
}

/// Temperatures are within a tolerance of 10 % beyond the step at which repulsion is expected to heat by 1 %.
#[test]
fn laws_of_accuracy_are_compared_with_where_bias_begins() {
    let place = place();
    let small =
        ["space.box=[4,4,4]", "interactions.0.friction=24", "output.radial_distribution=null", "time.steps=400"];
    let own = ["stability", "dpd-fluid", "--out"].map(str::to_owned).into_iter().chain([place.argument("out")]);
    let set = small.into_iter().flat_map(|set| ["--set", set]).map(str::to_owned);
    let vary =
        ["--set", "time.equilibration=100", "--tolerance", "10%", "--bisections", "0", "--vary"].map(str::to_owned);
    let arguments: Vec<String> = own.chain(set).chain(vary).chain(["time.step=0.01,0.04,0.14".to_owned()]).collect();
    let said = succeeds(&borrowed(&arguments));
    assert!(
        said.contains("runs become biased at 1.") && said.contains("what the law 1 % of the temperature"),
        "{said}"
    );
}

/// A law does not vanish where the range ends before it.
#[test]
fn laws_beyond_a_range_are_in_words() {
    let place = place();
    let further = ["--vary", "time.step=0.02,0.04", "--bisections", "0", "--tolerance", "30%"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("B + W = 4 at 0.471, beyond the range"), "{said}");
    assert!(said.contains("‡ from few samples"), "{said}");
    let page = fs::read_to_string(place.path("out").join(files::PAGE)).unwrap();
    assert!(page.contains("B + W = 4 at 0.471, beyond the range"), "{page}");
}

/// A particle that keeps its momentum has no temperature: nothing is compared, and it is known where runs end.
#[test]
fn so_few_particles_are_mapped_to_where_runs_end() {
    let place = place();
    let few = |count: u32| {
        let particles = format!(r#"particles=[{{"species":"A","count":{count}}}]"#);
        let set = ["output.radial_distribution=null", "time.steps=300", "time.equilibration=0", &particles];
        let own = ["stability", "dpd-fluid", "--bisections", "0", "--vary", "time.step=0.04,100", "--out"];
        let out = format!("few{count}");
        let own = own.map(str::to_owned).into_iter().chain([place.argument(&out)]);
        let all = own.chain(set.iter().flat_map(|set| ["--set".to_owned(), (*set).to_owned()]));
        let said = succeeds(&borrowed(&all.collect::<Vec<_>>()));
        (said, StabilitySummary::load(&place.path(&out)).unwrap())
    };
    for count in [0, 1] {
        let (said, summary) = few(count);
        for part in [
            "RAN TO ITS END: time.step UP TO",
            "have so few particles that they have no `configurational_temperature`, `temperature`, which cannot be compared",
        ] {
            assert!(said.contains(part), "{count}: `{part}` is not in: {said}");
        }
        assert!(!said.contains("biased") && !said.contains("RIGHT"), "{count}: {said}");
        let table = fs::read_to_string(place.path(&format!("few{count}")).join(files::TABLE)).unwrap();
        assert!(table.lines().nth(1).unwrap().contains("so few particles have no `temperature`"), "{table}");
        let first = &summary.rows[0].cells[0];
        assert!(
            first.verdict == Verdict::Right && !first.is_certain && first.undefined.len() == 2,
            "{count}: {first:?}"
        );
    }
    // Many particles that have no number are another matter: they are not said to be few.
    let (said, _) = few(3);
    assert!(!said.contains("so few particles"), "{said}");
}

/// Rows that a setting does not tell apart are the same runs.
#[test]
fn rows_that_are_the_same_runs_are_said_to_be() {
    let place = place();
    let further = ["--vary", "output.plot.width=640,700", "--vary", "time.step=0.02,0.04", "--bisections", "0"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(said.contains("width = 640 and width = 700 are the same runs, digit by digit"), "{said}");
    let further = ["--vary", "seed=1,2", "--vary", "time.step=0.02,0.04", "--bisections", "0", "--force"];
    let said = succeeds(&borrowed(&arguments(&place, &further)));
    assert!(!said.contains("are the same runs"), "{said}");
}
