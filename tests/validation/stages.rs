//! Stages against runs without them: `make validate`.

use mesoscope::output::Summary;
use mesoscope::run::Run;

use crate::support::{adapter, fluid};

/// The mean of a column and its standard error.
fn mean(summary: &Summary, column: &str) -> [f64; 2] {
    let found = &summary.means[column];
    ["value", "error"].map(|part| found[part].as_f64().unwrap_or_else(|| panic!("{column}: {found}")))
}

/// A fluid whose repulsion rises along a line ends with the pressure, energy and temperatures of a fluid that has had its last value from the start.
#[test]
#[ignore = "minutes"]
fn a_ramp_of_repulsion_ends_with_the_pressure_of_its_last_value() {
    let measured = |changes: &[&str]| {
        let place = tempfile::tempdir().unwrap();
        let fixed = ["space.box=[7,7,7]", "time.step=0.02", r#"output={"energies":{"every":10}}"#];
        let scene = fluid(&[&fixed[..], changes].concat());
        Run::replace(scene, place.path()).execute(&adapter(), &mut |_| {}).unwrap().summary
    };
    let ramped = measured(&[
        "time.equilibration=0",
        r#"stages=[{"steps":1000},{"steps":2000,"ramp":{"interactions.0.repulsion":[25,50]}},{"steps":1000},{"steps":15000}]"#,
        "time.steps=19000",
    ]);
    let stiff = measured(&["interactions.0.repulsion=50", "time.steps=16000", "time.equilibration=1000"]);
    let soft = measured(&["time.steps=4000", "time.equilibration=1000"]);
    for (column, largest) in
        [("pressure", 0.1), ("potential_energy", 4.0), ("temperature", 0.004), ("configurational_temperature", 0.008)]
    {
        let [[a, a_error], [b, b_error]] = [&ramped, &stiff].map(|summary| mean(summary, column));
        let error = a_error.hypot(b_error);
        println!("{column}: {a} ± {a_error} after the ramp, {b} ± {b_error}");
        assert!((a - b).abs() < 4.0 * error && error < largest, "{column}: {a} {b} ± {error}");
    }
    // The fluid before the ramp is another one.
    let [before, after] = [&soft, &stiff].map(|summary| mean(summary, "pressure")[0]);
    assert!(after - before > 10.0, "{before} {after}");
}
