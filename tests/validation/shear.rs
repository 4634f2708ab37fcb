//! Shear by boundaries that move: `make validate`. Each test prints its table in Markdown.

use mesoscope::run::Run;
use mesoscope::scene::Checked;

use crate::support::{Device, GROOT_WARREN, Implementation, SPLITTING, adapter, fluid};

/// The standard fluid at a shear rate, with the stress of every fifth step of .04 after 20 units of time.
fn sheared(rate: f64, steps: u64, integrator: &str) -> Checked {
    let space = format!(r#"space={{"box":[10,10,10],"shear":{{"rate":{rate},"gradient":"y"}}}}"#);
    let time = format!(r#"time={{"step":0.04,"steps":{steps},"equilibration":500}}"#);
    fluid(&[&space, &time, integrator, r#"output={"stress":{"every":5},"energies":{"every":50}}"#])
}

/// The viscosity of the standard fluid from the mean stress, .84 ± 5 % by what is known, and the temperature about the profile. Its error is
/// that of the mean: (3 η kT / V T)^½ / rate.
#[test]
#[ignore = "minutes"]
fn the_viscosity_of_the_standard_fluid() {
    println!("| rate | integrator | viscosity | temperature |\n|-|-|-|-|");
    for (rate, steps, integrator) in [(0.1, 30_500, SPLITTING), (0.2, 10_500, SPLITTING), (0.2, 10_500, GROOT_WARREN)] {
        let directory = tempfile::tempdir().unwrap();
        let simulation = Run::start(sheared(rate, steps, integrator), directory.path().join("run"));
        let outcome = simulation.execute(&adapter(), &mut |_| ()).unwrap();
        let found = &outcome.summary.results["stress"]["viscosity_in_shear"];
        let [viscosity, error] = ["value", "error"].map(|key| found[key].as_f64().unwrap());
        let temperature = outcome.summary.means["temperature"]["value"].as_f64().unwrap();
        println!("| {rate} | {integrator} | {viscosity:.4} ± {error:.4} | {temperature:.4} |");
        assert!((viscosity - 0.84).abs() < 0.05 * 0.84 + 3.0 * error, "{rate} {integrator}: {viscosity} ± {error}");
    }
}

/// Over a hundred thousand steps of a small box, hot and sheared fast, momentum with what boundaries have taken is one value.
#[test]
#[ignore = "minutes"]
fn momentum_over_a_hundred_thousand_steps() {
    let scene = fluid(&[
        r#"space={"box":[3,4,3],"shear":{"rate":1.5,"gradient":"y"}}"#,
        "time.step=0.02",
        "temperature=2",
        "output.energies.every=1000000",
    ]);
    let mut run = Device::new(&scene);
    let start = run.state();
    let mut crossed = 0_i64;
    for _ in 0..200 {
        run.step(500);
        let state = run.state();
        crossed = crossed.max(state.walls[0].momentum()[0].abs());
        assert_eq!(state.exchanged_momentum(), start.total_momentum(), "step {}", state.step);
    }
    println!("| most momentum that boundaries held | {crossed} units |");
    assert!(crossed > 1 << 20);
}
