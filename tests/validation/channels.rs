//! Flow between walls: `make validate`. Each test prints its table in Markdown.

use mesoscope::output::read_table;
use mesoscope::run::Run;
use mesoscope::scene::{Checked, Scene};

use crate::support::{Device, INTEGRATORS, Implementation, adapter, edited, fluid};

const BINS: usize = 20;
const EDGE: f64 = 10.0;
const AREA: f64 = 64.0;

/// The standard fluid between walls across z, EDGE apart. Layers at the walls hold more than their part: 3.13 leaves a density of 3 in
/// the middle.
fn channel(velocity: f64, force: f64) -> Checked {
    let space = format!(
        r#"space={{"box":[8,8,{EDGE}],"walls":{{"z":{{"lower_velocity":[-{velocity},0,0],"upper_velocity":[{velocity},0,0]}}}}}}"#
    );
    let interactions = format!(
        r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{{"type":"body-force","force":[{force},0,0]}}]"#
    );
    let particles = r#"particles=[{"species":"A","number_density":3.13}]"#;
    fluid(&[&space, &interactions, particles, "time.step=0.04", "output.energies.every=10"])
}

/// The same at a density of 3 everywhere, with frozen particles of the same kind behind the walls.
fn layered_channel(velocity: f64, force: f64) -> Checked {
    let space = format!(
        r#"space={{"box":[8,8,{EDGE}],"walls":{{"z":{{"lower_velocity":[-{velocity},0,0],"upper_velocity":[{velocity},0,0]}}}}}}"#
    );
    let interactions = format!(
        r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},{{"type":"body-force","force":[{force},0,0]}}]"#
    );
    let particles = r#"particles=[{"species":"A","number_density":3},
        {"species":"W","number_density":3,"placement":{"type":"behind-walls","axis":"z","thickness":1}}]"#;
    fluid(&[&space, &interactions, particles, "time.step=0.04", "output.energies.every=10"])
}

/// What is measured of a steady flow along x.
struct Flow {
    /// Mean velocity by bin across the walls.
    velocity: [f64; BINS],
    /// Mean density by bin.
    density: [f64; BINS],
    /// Mean momentum along x that each wall absorbs from a unit of area in a unit of time.
    stress: [f64; 2],
}

/// Means over 800 units of time after 120, in which transients decay with a time of L²ρ/π²η = 36; of what moves.
fn steady(scene: &Checked) -> Flow {
    const SAMPLES: u32 = 2000;
    let mut run = Device::new(scene);
    let model = scene.model();
    run.step(3000);
    let first = run.observe();
    let (mut sums, mut counts) = ([0.0; BINS], [0_u32; BINS]);
    for _ in 0..SAMPLES {
        run.step(10);
        let state = run.reported();
        for id in (0..state.len()).filter(|id| !model.species[state.species[*id] as usize].frozen) {
            let bin = (model.units.position(state.positions[id])[2] / EDGE * BINS as f64) as usize;
            sums[bin] += f64::from(state.momenta[id][0]) * model.units.momentum;
            counts[bin] += 1;
        }
    }
    let last = run.observe();
    let time = (last.step - first.step) as f64 * model.time_step;
    let stress =
        [4, 5].map(|wall| (last.on_walls.momentum[wall][0] - first.on_walls.momentum[wall][0]) / (AREA * time));
    let volume = AREA * EDGE / BINS as f64;
    Flow {
        velocity: std::array::from_fn(|bin| sums[bin] / f64::from(counts[bin])),
        density: counts.map(|count| f64::from(count) / (f64::from(SAMPLES) * volume)),
        stress,
    }
}

/// Distance of the middle of a bin from the middle of the channel.
fn from_middle(bin: usize) -> f64 {
    ((bin as f64 + 0.5) / BINS as f64 - 0.5) * EDGE
}

/// The bins that are a cutoff and a half or more from both walls, which neither layers nor slip reach.
fn inner() -> std::ops::Range<usize> {
    3..BINS - 3
}

fn print(flow: &Flow, expected: impl Fn(f64) -> f64) {
    println!("| z - L/2 | density | velocity | fit |\n|-|-|-|-|");
    for bin in 0..BINS {
        let z = from_middle(bin);
        println!("| {z:.2} | {:.3} | {:.4} | {:.4} |", flow.density[bin], flow.velocity[bin], expected(z));
    }
}

/// What is measured of a Couette flow of walls at ∓1: slope of the line in the middle, slip length, viscosity.
fn couette(scene: &Checked, allowed: f64) -> [f64; 3] {
    let flow = steady(scene);
    let moment = |power: i32| inner().map(|bin| from_middle(bin).powi(power)).sum::<f64>();
    let slope = inner().map(|bin| from_middle(bin) * flow.velocity[bin]).sum::<f64>() / moment(2);
    print(&flow, |z| slope * z);
    let slip = 1.0 / slope - 0.5 * EDGE;
    let viscosity = 0.5 * (flow.stress[0] - flow.stress[1]) / slope;
    println!(
        "| slope {slope:.4} | slip length {slip:.3} | stress {:.4} {:.4} | viscosity {viscosity:.4} |",
        flow.stress[0], flow.stress[1]
    );
    for bin in inner() {
        let off = (flow.velocity[bin] - slope * from_middle(bin)).abs();
        assert!(off < allowed, "bin {bin}: {off} off the line");
    }
    assert!((viscosity / 0.84 - 1.0).abs() < 0.05 + 0.02, "{viscosity}");
    [slope, slip, viscosity]
}

/// Plane Couette flow: linear in the middle, with the viscosity .84 ± 5 % of the standard fluid from the momentum that walls absorb, and no
/// slip but for a tenth of a cutoff. A bin holds 96 particles; the slowest wave, of amplitude (2kT/M)^½ = .03, is averaged over 800/2·36 of its
/// times, and leaves .01 that the line may miss by twice.
#[test]
#[ignore = "a minute"]
fn couette_flow_is_linear() {
    let [_, slip, _] = couette(&channel(1.0, 0.0), 0.02);
    assert!(slip.abs() < 0.1, "{slip}");
}

/// The same with frozen particles behind the walls. The fluid at the wall moves with it, but over the last half of a cutoff the rate of shear is a
/// fifth larger, as friction with what does not take part in the shear is weaker: seen from the middle the fluid slips by .2 ± .05 of a cutoff,
/// more than at bare walls, which hold a dense layer of it. Lines may miss by three errors, for the viscosity is a slope that is known to 2 %.
#[test]
#[ignore = "a minute"]
fn couette_flow_beside_layers_is_linear() {
    let [_, slip, _] = couette(&layered_channel(1.0, 0.0), 0.03);
    assert!((slip - 0.2).abs() < 0.15, "{slip}");
}

/// What is measured of a Poiseuille flow under a force: slip length and viscosity.
fn poiseuille(scene: &Checked, force: f64) -> [f64; 2] {
    let flow = steady(scene);
    // Least squares of v = a - c z².
    let number = inner().len() as f64;
    let mean = |value: &dyn Fn(usize) -> f64| inner().map(value).sum::<f64>() / number;
    let (square, velocity) = (mean(&|bin| from_middle(bin).powi(2)), mean(&|bin| flow.velocity[bin]));
    let covariance = mean(&|bin| (from_middle(bin).powi(2) - square) * (flow.velocity[bin] - velocity));
    let variance = mean(&|bin| (from_middle(bin).powi(2) - square).powi(2));
    let curvature = -covariance / variance;
    let middle = velocity + curvature * square;
    let density = mean(&|bin| flow.density[bin]);
    let viscosity = force * density / (2.0 * curvature);
    print(&flow, |z| middle - curvature * z * z);
    // Where the parabola ends behind the walls.
    let slip = (middle / curvature).sqrt() - 0.5 * EDGE;
    println!(
        "| middle {middle:.4} | slip {slip:.3} | density {density:.3} | viscosity {viscosity:.4} | stress {:?} |",
        flow.stress
    );
    for bin in inner() {
        let off = (flow.velocity[bin] - middle + curvature * from_middle(bin).powi(2)).abs();
        assert!(off < 0.03, "bin {bin}: {off} off the parabola");
    }
    assert!((viscosity / 0.84 - 1.0).abs() < 0.05 + 0.03, "{viscosity}");
    let count = scene.particles[0].resolved_count(&scene.space) as f64;
    let from_body_forces = force * count / AREA;
    assert!(
        ((flow.stress[0] + flow.stress[1]) / from_body_forces - 1.0).abs() < 0.02,
        "{:?} {from_body_forces}",
        flow.stress
    );
    [slip, viscosity]
}

/// Plane Poiseuille flow: a parabola in the middle, whose curvature fρ/η gives the viscosity with an error of 2 %, and no slip but for a tenth of a
/// cutoff; walls absorb what the force adds.
#[test]
#[ignore = "a minute"]
fn poiseuille_flow_is_a_parabola() {
    let [slip, _] = poiseuille(&channel(0.0, 0.03), 0.03);
    assert!(slip.abs() < 0.1, "{slip}");
}

/// The same with frozen particles behind the walls.
#[test]
#[ignore = "a minute"]
fn poiseuille_flow_beside_layers_is_a_parabola() {
    let [slip, _] = poiseuille(&layered_channel(0.0, 0.03), 0.03);
    assert!((slip - 0.2).abs() < 0.15, "{slip}");
}

/// Between walls at rest a fluid is as warm and as dense near them as anywhere if frozen particles are behind them, also in long steps, where one
/// at bare walls is 17 % too warm and half again as dense. Temperatures at the walls are known to .01.
#[test]
#[ignore = "a minute"]
fn layers_leave_the_fluid_as_it_is() {
    println!(
        "| step | layers | temperature at the wall | of all | density at the wall | next | middle |\n|-|-|-|-|-|-|-|"
    );
    for step in [0.04, 0.02] {
        let [bare, layered] = [channel(0.0, 0.0), layered_channel(0.0, 0.0)].map(|scene| {
            let asked =
                serde_json::json!({"axis": "z", "bins": BINS, "every": 5, "quantities": ["density", "temperature"]});
            let scene = edited(&scene, |Scene { time, output, .. }| {
                time.step = step;
                time.steps = (100.0 / step).round() as u64;
                time.equilibration = (20.0 / step).round() as u64;
                output.profiles = Some(serde_json::from_value(asked).unwrap());
            });
            let directory = tempfile::tempdir().unwrap();
            Run::replace(scene, directory.path()).execute(&adapter(), &mut |_| {}).unwrap();
            let table = read_table(&directory.path().join("profiles.csv")).unwrap();
            ["temperature", "number_density"].map(|column| table.values(column))
        });
        for (name, [temperature, density]) in [("no", &bare), ("yes", &layered)] {
            let pair = |values: &[f64], bin: usize| 0.5 * (values[bin] + values[BINS - 1 - bin]);
            let heat: f64 = (0..BINS).map(|bin| temperature[bin] * density[bin]).sum();
            let all = heat / density.iter().sum::<f64>();
            let dense = [0, 1, BINS / 2].map(|bin| pair(density, bin));
            let warm = pair(temperature, 0);
            println!(
                "| {step} | {name} | {warm:.3} | {all:.4} | {:.3} | {:.3} | {:.3} |",
                dense[0], dense[1], dense[2]
            );
            if name == "yes" {
                assert!((warm - 1.0).abs() < 0.03 && (all - 1.0).abs() < 0.015, "{warm} {all}");
                assert!(dense.iter().all(|density| (density / 3.0 - 1.0).abs() < 0.06), "{dense:?}");
            } else {
                assert!(warm > 1.03 && dense[0] > 4.0, "{warm} {dense:?}");
            }
        }
    }
}

/// A million steps in a small closed box, hot and in long steps: nobody is behind a wall whenever it is looked at, and momentum with what walls
/// have absorbed is what it was, to the last bit.
#[test]
#[ignore = "minutes"]
fn a_million_steps_between_walls() {
    nobody_is_behind_a_wall(r#"integrator={"type":"splitting"}"#, 500, 2000);
}

/// The same in every step of a hundred thousand, with each integrator.
#[test]
#[ignore = "minutes"]
fn a_hundred_thousand_steps_between_walls_one_by_one() {
    for integrator in INTEGRATORS {
        nobody_is_behind_a_wall(integrator, 1, 100_000);
    }
}

/// Looks so often, after so many steps each time.
fn nobody_is_behind_a_wall(integrator: &str, steps: u64, looks: u64) {
    let scene = fluid(&[
        r#"space={"box":[3,4,3],"walls":{"x":{"reflection":"specular"},"z":{"lower_velocity":[0,-1,0],"upper_velocity":[0,1,0]}}}"#,
        r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","force":[0.5,0.1,-0.3]}]"#,
        integrator,
        "time.step=0.02",
        "temperature=2",
        "output.energies.every=1000000",
    ]);
    let ends = scene.model().units.ends();
    let mut run = Device::new(&scene);
    let start = run.state();
    let mut largest = [0; 3];
    for _ in 0..looks {
        run.step(steps);
        let state = run.state();
        for axis in [0, 2] {
            largest[axis] = state.positions.iter().map(|position| position[axis]).max().unwrap().max(largest[axis]);
            assert!(largest[axis] < ends[axis], "{integrator}, step {}: behind a wall", state.step);
        }
        assert_eq!(state.exchanged_momentum(), start.total_momentum(), "{integrator}, step {}", state.step);
    }
    println!("| {integrator} | places | {ends:?} | highest | {largest:?} |");
    assert!([0, 2].iter().all(|axis| f64::from(largest[*axis]) > 0.999 * f64::from(ends[*axis])));
}

/// Over a hundred thousand steps of a small box, hot and driven apart by halves, momentum less what forces have added is one value; in a
/// box of which each half holds as many particles on average, what they put in goes to and fro.
#[test]
#[ignore = "minutes"]
fn momentum_under_opposed_forces_over_a_hundred_thousand_steps() {
    for integrator in INTEGRATORS {
        let scene = fluid(&[
            "space.box=[3,4,5]",
            r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
                {"type":"body-force","force":[1,0,0],"profile":"opposed","axis":"z"}]"#,
            integrator,
            "time.step=0.02",
            "temperature=2",
            "output.energies.every=1000000",
        ]);
        let model = scene.model();
        let mut run = Device::new(&scene);
        let start = run.state();
        let mut most = 0_i64;
        for _ in 0..200 {
            run.step(500);
            let state = run.state();
            let from_body_forces = state.total_momentum()[0] - start.total_momentum()[0];
            most = most.max(from_body_forces.abs());
            assert_eq!(state.exchanged_momentum(), start.total_momentum(), "{integrator}, step {}", state.step);
        }
        println!("| {integrator} | most momentum that forces had put in | {:.1} |", most as f64 * model.units.momentum);
        assert!(most > 1 << 20, "{most}");
    }
}
