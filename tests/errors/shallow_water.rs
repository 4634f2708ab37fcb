//! Wrong scenes of shallow water: each mistake with its place, what was found and what is accepted; and what is allowed but
//! deserves a warning.

use mesoscope::scene;
use serde_json::{Value, json};

use crate::support::mistakes::{Correct, problems_of};

const WATER: Correct = Correct(base);

/// A small correct scene.
fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [6, 6]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 0,
        "particles": [
            {"species": "water", "count": 1024, "velocities": {"type": "geostrophic"}},
            {"species": "loop", "count": 32, "tracer": true,
             "placement": {"type": "circle", "center": [3, 3], "radius": 1}},
        ],
        "interactions": [{
            "type": "shallow-water", "mesh": [16, 16], "wave_speed": 6, "rotation": 6, "smoothing": {"length": 0.8},
            "surface": [{"type": "bump", "center": [3, 3], "radius": 1, "amplitude": 0.1}],
        }],
    })
}

const UNSMOOTHED: &str = "interactions.0.smoothing.length=0";
const CHEBYSHEV: &str = r#"interactions.0.smoothing.solver={"type":"chebyshev"}"#;

#[test]
fn the_base_is_right_and_draws_no_warning() {
    let scene = WATER.accepted(&[]);
    assert!(mesoscope::families::warnings(&scene).is_empty(), "{:?}", mesoscope::families::warnings(&scene));
    assert_eq!(scene.system.integrator_name(), "gyro", "the default of shallow water");
    let validator = jsonschema::draft202012::new(&scene::schema()).unwrap();
    assert!(validator.is_valid(&base()));
    assert!(validator.is_valid(&serde_json::to_value(&scene).unwrap()));
}

// ---- The mesh

#[test]
fn a_mesh_coarser_than_the_spline() {
    WATER.refused(
        &["interactions.0.mesh=[3,16]", CHEBYSHEV],
        "interactions[0].mesh[0]: found 3; accepted: at least 4 nodes, the width of a spline of order 3",
    );
    WATER.refused(
        &["interactions.0.mesh=[16,2]", "interactions.0.spline_order=2"],
        "interactions[0].mesh[1]: found 2; accepted: at least 3 nodes, the width of a spline of order 2",
    );
    WATER.refused(
        &["interactions.0.mesh=[1,2]", "interactions.0.spline_order=1"],
        "interactions[0].mesh[0]: found 1; accepted: at least 2 nodes, the width of a spline of order 1",
    );
    for (mesh, order) in [("[4,4]", 3), ("[4,4]", 2), ("[2,2]", 1)] {
        WATER.accepted(&[&format!("interactions.0.mesh={mesh}"), &format!("interactions.0.spline_order={order}")]);
    }
}

#[test]
fn values_out_of_range() {
    for (change, expected) in [
        ("interactions.0.mesh=[0,16]", "interactions[0].mesh[0]: found 0; accepted: a whole number from 1 to 4096"),
        (
            "interactions.0.mesh=[16,8192]",
            "interactions[0].mesh[1]: found 8192; accepted: a whole number from 1 to 4096",
        ),
        ("interactions.0.mesh=[16]", "interactions[0].mesh: found a list of 1 entry; accepted: a list of 2 entries"),
        (
            "interactions.0.mesh=[16,16,16]",
            "interactions[0].mesh: found a list of 3 entries; accepted: a list of 2 entries",
        ),
        (
            "interactions.0.spline_order=0",
            "interactions[0].spline_order: found 0; accepted: a whole number from 1 to 3",
        ),
        (
            "interactions.0.spline_order=4",
            "interactions[0].spline_order: found 4; accepted: a whole number from 1 to 3",
        ),
        (
            "interactions.0.smoothing.length=-1",
            "interactions[0].smoothing.length: found -1; accepted: a number, zero or positive",
        ),
        (
            "interactions.0.smoothing.power=3",
            "interactions[0].smoothing.power: found 3; accepted: a whole number from 1 to 2",
        ),
        (
            "interactions.0.smoothing.power=4000000000",
            "interactions[0].smoothing.power: found 4000000000; accepted: a whole number from 1 to 2",
        ),
        ("interactions.0.wave_speed=0", "interactions[0].wave_speed: found 0; accepted: a number greater than zero"),
        (
            "particles.1.placement.radius=0",
            "particles[1].placement.radius: found 0; accepted: a number greater than zero",
        ),
    ] {
        let found = WATER.problems(&[change]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with(expected), "{found:?}, not {expected}");
    }
    let tolerance = r#"interactions.0.smoothing.solver={"type":"chebyshev","tolerance":1}"#;
    assert!(
        WATER.problems(&[tolerance])[0].starts_with("interactions[0].smoothing.solver.tolerance: found 1; accepted: ")
    );
    let solver = r#"interactions.0.smoothing.solver={"type":"multigrid"}"#;
    assert!(WATER.problems(&[solver])[0].contains("`fft`") && WATER.problems(&[solver])[0].contains("`chebyshev`"));
    let scheme = r#"interactions.0.bath={"type":"memory","epsilon":1,"scheme":"simetric"}"#;
    assert!(WATER.problems(&[scheme])[0].contains("did you mean `symmetric`?"), "{:?}", WATER.problems(&[scheme]));
    let epsilon = r#"interactions.0.bath={"type":"memory","epsilon":-1}"#;
    assert!(WATER.problems(&[epsilon])[0].starts_with("interactions[0].bath.epsilon: found -1; accepted: "));
    let unknown = r#"interactions.0.bath={"type":"white","epsilon":1}"#;
    assert!(WATER.problems(&[unknown])[0].starts_with("interactions[0].bath.epsilon: unknown key"));
}

#[test]
fn edges_that_are_no_powers_of_two_with_fft() {
    WATER.refused(
        &["interactions.0.mesh=[16,12]"],
        "interactions[0].mesh[1]: found 12; accepted: a power of two for the solver `fft`, or the solver `chebyshev`, which \
         takes any mesh",
    );
    WATER.accepted(&["interactions.0.mesh=[15,12]", CHEBYSHEV]);
    // No smoothing, no solver.
    WATER.accepted(&["interactions.0.mesh=[15,12]", UNSMOOTHED]);
}

#[test]
fn a_smoothing_that_no_iteration_reaches() {
    for length in ["1e5", "1e6"] {
        let found = WATER.problems(&[
            CHEBYSHEV,
            &format!("interactions.0.smoothing.length={length}"),
            "interactions.0.surface=[]",
        ]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("interactions[0].smoothing.length: found 1"), "{found:?}");
        assert!(
            found[0].ends_with(
                "a length and a tolerance that take at most 10000, or the solver `fft`, which takes any length"
            ),
            "{found:?}"
        );
        WATER.accepted(&[&format!("interactions.0.smoothing.length={length}"), "interactions.0.surface=[]"]);
    }
    WATER.accepted(&[CHEBYSHEV, "interactions.0.smoothing.length=100", "interactions.0.surface=[]"]);
    WATER.refused(
        &[CHEBYSHEV, "interactions.0.smoothing.solver.tolerance=0"],
        "interactions[0].smoothing.solver.tolerance: found 0; accepted: a number above 0 and below 1",
    );
}

#[test]
fn a_smoothing_beyond_all_measure() {
    for length in ["1e99", "1e8"] {
        let found =
            WATER.problems(&[&format!("interactions.0.smoothing.length={length}"), "interactions.0.surface=[]"]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("interactions[0].smoothing.length: found 1.00e"), "{found:?}");
        assert!(found[0].contains("accepted: at most 1e6 edges of the box"), "{found:?}");
    }
}

#[test]
fn snapshots_of_particles() {
    WATER.refused(
        &["output.snapshot.every=10"],
        "output.snapshot: found in a scene of shallow water; accepted: no `output.snapshot` in shallow water: \
         `output.fields` draws the water, `output.plot` says how",
    );
}

#[test]
fn a_bath_without_a_smoothing_length() {
    for bath in [r#"{"type":"white"}"#, r#"{"type":"memory","epsilon":1}"#] {
        let bath = format!("interactions.0.bath={bath}");
        WATER.refused(
            &[&bath, UNSMOOTHED],
            "interactions[0].bath: found a bath, and a smoothing of length 0; accepted: a `smoothing.length` above 0, from \
             which the bath takes its scales; or no bath",
        );
        WATER.accepted(&[&bath]);
    }
    WATER.accepted(&[UNSMOOTHED]);
}

// ---- The water

#[test]
fn a_depth_that_is_none() {
    let found = WATER.problems(&["interactions.0.surface.0.amplitude=-1.5"]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("interactions[0].surface: found features that make a depth of -"), "{found:?}");
    assert!(
        found[0].ends_with(
            "on average; accepted: a depth above 0 and up to 4 times the mean everywhere: lower or wider features, or a \
             shorter `smoothing.length`"
        ),
        "{found:?}"
    );
    // What is meant is the water itself, which is rougher than its smoothed surface.
    let narrow = "interactions.0.surface.0.radius=0.3";
    assert!(WATER.problems(&[narrow, "interactions.0.smoothing.length=2"])[0].starts_with("interactions[0].surface: "));
    WATER.accepted(&[narrow, "interactions.0.smoothing.length=0.1"]);
    // Relative to the mean: everything is scaled to that.
    let deep = r#"interactions.0.surface=[{"type":"bump","center":[3,3],"radius":0.8,"amplitude":2},{"type":"bump","center":[3,3],"radius":4,"amplitude":-0.9}]"#;
    let rest = r#"particles.0.velocities={"type":"rest"}"#;
    let found = WATER.problems(&[deep, rest, UNSMOOTHED, "interactions.0.surface.0.radius=0.4"]);
    assert!(found[0].contains("times the mean everywhere"), "{found:?}");
    let empty = r#"interactions.0.surface=[{"type":"wave","periods":[1,0],"amplitude":1}]"#;
    assert!(WATER.problems(&[empty, rest, UNSMOOTHED])[0].contains("a depth of 0.000 at (3.000, 0.000)"));
    WATER.accepted(&[&empty.replace(":1}", ":0.99}"), rest, UNSMOOTHED]);
}

#[test]
fn a_flow_in_balance_that_is_faster_than_waves() {
    WATER.refused(
        &["interactions.0.rotation=0.1"],
        "particles[0].velocities: found a balance with velocities of up to 3.398 times the speed of waves; accepted: at most 2 \
         times: lower or wider features, or a faster rotation",
    );
    WATER.accepted(&["interactions.0.rotation=0.2"]);
    WATER.accepted(&["interactions.0.rotation=-0.2"]);
    WATER.accepted(&["interactions.0.rotation=0.1", r#"particles.0.velocities={"type":"rest"}"#]);
    WATER.accepted(&["interactions.0.rotation=1e-9", "interactions.0.surface=[]"]);
}

#[test]
fn balance_without_rotation() {
    WATER.refused(
        &["interactions.0.rotation=0"],
        "particles[0].velocities: found a rotation of 0; accepted: a rotation other than 0 for `geostrophic`, which is a \
         balance with it; or `rest`",
    );
    WATER.accepted(&["interactions.0.rotation=0", r#"particles.0.velocities={"type":"thermal"}"#]);
}

#[test]
fn masses_and_the_order_of_groups() {
    WATER.refused(
        &["particles.0.mass=2"],
        "particles[0].mass: found 2; accepted: no `mass` in shallow water: it follows from the depth",
    );
    WATER.refused(
        &[r#"particles=[{"species":"dye","count":3,"tracer":true},{"species":"water","count":99}]"#],
        "particles[1]: found water after the tracers of particles[0]; accepted: tracers after all other groups",
    );
    WATER.accepted(&[
        r#"particles=[{"species":"water","count":9},{"species":"water","count":99},{"species":"dye","count":3,"tracer":true}]"#,
    ]);
}

#[test]
fn loops_of_the_same_name() {
    let circle = r#""count":8,"tracer":true,"placement":{"type":"circle","center":[1,1],"radius":0.5}"#;
    let particles = |second: &str| {
        format!(
            r#"particles=[{{"species":"water","count":99}},{{"species":"a",{circle}}},{{"species":"{second}",{circle}}}]"#
        )
    };
    WATER.refused(
        &[&particles("a")],
        "particles[2].species: found \"a\", the name of the loop of particles[1]; accepted: a name of its own for every loop of \
         tracers",
    );
    WATER.accepted(&[&particles("b")]);
    WATER.refused(
        &[&particles("time")],
        "particles[2].species: found \"time\"; accepted: another name: `time` heads the first column of the table of circulations",
    );
    // Water may be called as it likes.
    let loop_called_water = particles("b").replace("\"a\"", "\"water\"");
    WATER.accepted(&[&loop_called_water]);
}

// ---- What does not go together

#[test]
fn three_dimensions() {
    let found = WATER.problems(&["space.box=[6,6,6]"]);
    assert_eq!(found, ["space.box: found 3 edges; accepted: two edges: shallow water is two-dimensional"]);
}

#[test]
fn integrators_of_the_other_kind() {
    for name in ["splitting", "groot-warren", "cotter-reich"] {
        WATER.refused(
            &[&format!(r#"integrator={{"type":"{name}"}}"#)],
            &format!("integrator.type: found \"{name}\" in a scene of shallow water; accepted: `gyro`, `rotate`"),
        );
    }
    for name in ["gyro", "rotate"] {
        let integrator = format!(r#"integrator={{"type":"{name}"}}"#);
        WATER.accepted(&[&integrator]);
        let found = fluid(&[&integrator]);
        let accepted = "`splitting`, `groot-warren`, `cotter-reich`";
        assert_eq!(found, [format!("integrator.type: found \"{name}\" in a scene of particles; accepted: {accepted}")]);
    }
}

#[test]
fn another_interaction_beside_it() {
    let mut document = base();
    document["interactions"].as_array_mut().unwrap().push(json!({"type": "dpd"}));
    let error = scene::parse("test.json", &document.to_string(), &[]).unwrap_err().to_string();
    assert!(
        error.contains(
            "interactions[0]: found together with another interaction; accepted: `shallow-water` as the only interaction"
        ),
        "{error}"
    );
    document["interactions"] = json!([base()["interactions"][0], base()["interactions"][0]]);
    let error = scene::parse("test.json", &document.to_string(), &[]).unwrap_err().to_string();
    assert!(
        error.contains("has 1 mistake:") && error.contains("interactions[0]: found together with another"),
        "{error}"
    );
}

#[test]
fn the_same_field_twice() {
    WATER.refused(
        &[r#"output.fields.quantities=["depth","potential-vorticity","potential-vorticity"]"#],
        "output.fields.quantities[2]: found the potential vorticity again; accepted: every quantity at most once",
    );
}

#[test]
fn measurements_of_particles() {
    for (name, value, scenes) in [
        ("radial_distribution", r#"{"every":5,"range":2}"#, "particles"),
        ("structure_factor", r#"{"every":5,"range":2}"#, "particles or a scene of Voronoi DPD"),
        ("diffusion", r#"{"every":2,"window":8}"#, "particles or a scene of Voronoi DPD"),
        ("viscosity", r#"{"every":2,"window":8}"#, "particles or a scene of Voronoi DPD"),
        ("histograms", r#"[{"quantity":"speed","every":2}]"#, "particles or a scene of Voronoi DPD"),
        ("stress", r#"{"every":2}"#, "particles"),
    ] {
        WATER.refused(
            &[&format!("output.{name}={value}")],
            &format!("output.{name}: found in a scene of shallow water; accepted: a scene of {scenes} only"),
        );
    }
    // A key that says what leaving it out says is none.
    WATER.accepted(&["output.diffusion=null", "output.histograms=[]", "particles.0.fixed=false"]);
}

/// The problems of a fluid with some of what only shallow water has.
fn fluid(overrides: &[&str]) -> Vec<String> {
    let text = r#"{"title": "test", "space": {"box": [6, 6, 6]}, "time": {"step": 0.01, "steps": 100}, "temperature": 1,
        "particles": [{"species": "A", "count": 10}], "interactions": [{"type": "dpd"}]}"#;
    problems_of(text, overrides)
}

#[test]
fn what_only_shallow_water_has() {
    let refusal = "found in a scene of particles; accepted: a scene of shallow water only";
    assert_eq!(fluid(&["particles.0.tracer=true"]), [format!("particles[0].tracer: {refusal}")]);
    let found = fluid(&[r#"particles.0.velocities={"type":"geostrophic"}"#]);
    let accepted = "`thermal`, `rest`, `listed`";
    assert_eq!(
        found,
        [format!("particles[0].velocities.type: found \"geostrophic\" in a scene of particles; accepted: {accepted}")]
    );
    assert_eq!(fluid(&[r#"output.fields={"every":5}"#]), [format!("output.fields: {refusal}")]);
    // Mistakes in what has no place are mistakes too.
    let found = fluid(&[r#"output.fields={"every":-5}"#]);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with(&format!("output.fields: {refusal}")), "{found:?}");
    assert!(found[1].starts_with("output.fields.every: found -5"), "{found:?}");
    let found = fluid(&[r#"particles.0.placement={"type":"circle","center":[1,1],"radius":1}"#]);
    assert_eq!(found, ["particles[0].placement.type: found `circle`; accepted: a two-dimensional box for a circle"]);
}

#[test]
fn all_mistakes_at_once() {
    let found = WATER.problems(&[
        "interactions.0.mesh=[3,12]",
        "interactions.0.rotation=0",
        "particles.0.mass=3",
        r#"integrator={"type":"splitting"}"#,
        r#"output.diffusion={"every":2,"window":8}"#,
    ]);
    let paths: Vec<&str> = found.iter().map(|line| line.split(": ").next().unwrap()).collect();
    assert_eq!(
        paths,
        [
            "integrator.type",
            "output.diffusion",
            "interactions[0].mesh[0]",
            "interactions[0].mesh[1]",
            "particles[0].mass",
            "particles[0].velocities"
        ]
    );
}

// ---- Warnings

/// The one warning of the small scene with these changes.
#[track_caller]
fn warned(overrides: &[&str]) -> String {
    let mut warnings = WATER.warnings(overrides);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    warnings.remove(0)
}

#[test]
fn no_water_at_all() {
    let warning = warned(&["particles.0.count=0"]);
    assert!(warning.starts_with("particles: there is no water: nothing moves"), "{warning}");
}

#[test]
fn a_loop_of_too_few_points() {
    let of = |count: u32| {
        format!(
            r#"particles=[{{"species":"water","count":99}},{{"species":"a","count":{count},"tracer":true,
                "placement":{{"type":"circle","center":[1,1],"radius":0.5}}}}]"#
        )
    };
    assert!(WATER.warnings(&[&of(100)]).is_empty());
    for count in [1, 2, 3] {
        let warning = warned(&[&of(count)]);
        assert!(
            warning.starts_with(&format!("particles[1].count: the {count} points of the loop `a` are ")),
            "{warning}"
        );
        let advised: u32 = warning.rsplit(' ').next().unwrap().parse().unwrap();
        assert!(advised >= 3 && WATER.warnings(&[&of(advised)]).is_empty(), "{warning}");
    }
}

#[test]
fn a_time_step_beyond_the_limit() {
    // Without the turn of `gyro` p grows with dt².
    let rotate = r#"integrator={"type":"rotate"}"#;
    let model = WATER.accepted(&[rotate, "time.step=1"]).model().clone();
    let share = model.shallow_water().unwrap().stability([6.0, 6.0], 1.0);
    let step = |p: f64| format!("time.step={}", (p / share).sqrt());
    assert!(WATER.warnings(&[rotate, &step(0.51)]).is_empty());
    let near = warned(&[rotate, &step(0.8)]);
    assert!(
        near.starts_with("time.step: the stiffest wave on the mesh takes p = 0.800 of the limit of stability "),
        "{near}"
    );
    assert!(
        near.contains(
            "with 4.000 particles a cell at random places up to 0.52 is stable: the run may become unstable; a step of "
        ),
        "{near}"
    );
    let turned = warned(&["time.step=0.6"]);
    assert!(
        turned.contains("the rotation turns a particle by 3.600 in one step, half a turn or more: the run may"),
        "{turned}"
    );
    let beyond = warned(&[rotate, &step(1.234)]);
    assert!(
        beyond.contains("takes p = 1.234 ") && beyond.contains("the run will become unstable; a step of "),
        "{beyond}"
    );
    // With what it advises there is nothing left to warn of, whatever the bath.
    for bath in [
        "interactions.0.bath=null",
        r#"interactions.0.bath={"type":"white"}"#,
        r#"interactions.0.bath={"type":"memory","epsilon":0.1}"#,
        r#"interactions.0.bath={"type":"memory","epsilon":1000,"scheme":"symmetric"}"#,
        r#"interactions.0.bath={"type":"memory","epsilon":1e9,"scheme":"exponential"}"#,
    ] {
        for step in ["0.8", "1e4"] {
            let warning = warned(&[bath, &format!("time.step={step}")]);
            let advised =
                warning.rsplit("a step of ").next().unwrap().split(' ').next().unwrap().parse::<f64>().unwrap();
            assert!(advised > 0.0 && advised < 0.8, "{warning}");
            // Three digits of it.
            let below = format!("time.step={}", 0.99 * advised);
            assert!(WATER.warnings(&[bath, &below]).is_empty(), "{bath}: {below} after {step}");
        }
    }
}
