//! Salt water against integral equations and exact laws, and charges that conserve momentum: `make validate`.

use mesoscope::output::read_table;
use mesoscope::run::Run;
use mesoscope::scene::Checked;
use std::f64::consts::{PI, TAU};

use crate::support::{Device, Implementation, Measured, adapter, fluid};

/// Salt of .6 mol/l in a box of 10, ions of a width of .5842, and more.
fn salt(changes: &[&str]) -> Checked {
    let particles = r#"particles=[{"species":"water","count":2804},{"species":"cation","count":98,"charge":1},
        {"species":"anion","count":98,"charge":-1}]"#;
    let interactions = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"electrostatics","bjerrum_length":1.1039,"width":0.5842}]"#;
    let fixed = ["space.box=[10,10,10]", "time.step=0.04", "output.energies.every=10", particles, interactions];
    fluid(&[&fixed[..], changes].concat())
}

/// Energies and structure of the ions are those of the hypernetted chain, which is right to .3 % in the energy of such ions and to 1 to 2.5 %
/// in their structure (of 196 ions in a box of 10, computed apart from this).
#[test]
#[ignore = "minutes"]
fn salt_water_has_the_energy_and_structure_of_its_theory() {
    let mut run = Device::new(&salt(&[]));
    run.step(1000);
    let mut energies = Vec::new();
    let mut structure = vec![Vec::new(); 4];
    for _ in 0..600 {
        energies.push(run.series(10, 1)[0].electrostatic_energy / 196.0);
        let state = run.reported();
        for (number, found) in (1..).zip(&mut structure) {
            let along = [0, 1, 2].map(|axis| {
                let mut amplitude = [0.0; 2];
                for (position, species) in state.positions.iter().zip(&state.species) {
                    let charge = [0.0, 1.0, -1.0][*species as usize];
                    let angle = TAU * f64::from(position[axis].wrapping_mul(number)) / 2_f64.powi(32);
                    amplitude[0] += charge * angle.cos();
                    amplitude[1] += charge * angle.sin();
                }
                amplitude[0] * amplitude[0] + amplitude[1] * amplitude[1]
            });
            found.push(along.iter().sum::<f64>() / (3.0 * 196.0));
        }
    }
    Measured::of(&energies).assert("electrostatic energy of an ion", -0.35158, 0.004, 0.003);
    for ((number, expected), found) in (1..).zip([0.1431, 0.5037, 0.8278, 0.9713]).zip(&structure) {
        Measured::of(found).assert(&format!("S_ZZ(2π {number}/10)"), expected, 0.03 * expected, 0.08 * expected);
    }
}

/// Ions in a weak field drift at qED/kT: the relation of Nernst and Einstein, for few ions that hardly see each other.
#[test]
#[ignore = "minutes"]
fn ions_drift_in_a_field_as_they_diffuse() {
    let particles = r#"particles=[{"species":"water","count":2920},{"species":"cation","count":40,"charge":1},
        {"species":"anion","count":40,"charge":-1}]"#;
    let interactions = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"electrostatics","bjerrum_length":0.1},{"type":"electric-field","field":[1,0,0]}]"#;
    let scene = salt(&[particles, interactions]);
    let mut run = Device::new(&scene);
    run.step(500);
    let mut last = run.reported().positions;
    let (mut drifts, mut squares) = (Vec::new(), Vec::new());
    // Displacements over 8 units of time, much longer than velocities are correlated.
    for _ in 0..60 {
        let mut displacements = vec![[0.0; 3]; 80];
        for _ in 0..20 {
            run.step(10);
            let now = run.reported().positions;
            for (ion, sum) in displacements.iter_mut().enumerate() {
                for axis in 0..3 {
                    let way = now[2920 + ion][axis].wrapping_sub(last[2920 + ion][axis]).cast_signed();
                    sum[axis] += f64::from(way) * 10.0 / 2_f64.powi(32);
                }
            }
            last = now;
        }
        let signed = |(ion, way): (usize, &[f64; 3])| if ion < 40 { way[0] } else { -way[0] };
        drifts.push(displacements.iter().enumerate().map(signed).sum::<f64>() / (80.0 * 8.0));
        squares.push(displacements.iter().map(|way| way[1] * way[1] + way[2] * way[2]).sum::<f64>() / (160.0 * 16.0));
    }
    let [drift, diffusion] = [&drifts, &squares].map(|series| Measured::of_independent(series));
    println!("drift {drift:?}, diffusion {diffusion:?}");
    let error = drift.error.hypot(diffusion.error);
    assert!(error < 0.05 * diffusion.mean, "{error}");
    assert!((drift.mean - diffusion.mean).abs() < 4.0 * error, "{drift:?} {diffusion:?}");
}

/// The total momentum has one value over a hundred thousand steps.
#[test]
#[ignore = "minutes"]
fn charges_keep_the_total_momentum_to_the_last_bit() {
    let small = r#"particles=[{"species":"water","count":250},{"species":"cation","count":50,"charge":1.5},
        {"species":"anion","count":75,"charge":-1}]"#;
    let mut run = Device::new(&salt(&["space.box=[5,5,5]", "output.energies.every=1000", small]));
    let start = run.state().total_momentum();
    for _ in 0..100 {
        run.step(1000);
        assert_eq!(run.state().total_momentum(), start);
    }
}

/// Beads of a charge on a spring with its opposite, which bonds exclude: waves of a box do not oppose its whole dipole moment, so that its mean square
/// is that of independent beads in the mean field of all others, which is the attraction of their own clouds that is taken back. Each bead
/// is a particle in `Kd²/2 + kT lB q² erf(d/2σ)/d`: of a permittivity of 72, where the bare spring would have 42.
#[test]
#[ignore = "minutes"]
fn polarisable_beads_have_the_permittivity_of_a_mean_field() {
    let (bjerrum, width, charge, stiffness) = (86.4_f64, 0.5842_f64, 0.5, 20.0);
    let particles =
        r#"particles=[{"species":"core","charge":0.5,"mass":0.5},{"species":"shell","charge":-0.5,"mass":0.5}]"#;
    let molecules = r#"molecules=[{"beads":["core","shell"],"bonds":[[0,1]],"count":648,"spacing":0.3}]"#;
    let interactions = r#"interactions=[
        {"type":"dpd","repulsion":25,"friction":4.5,"pairs":[{"between":["core","shell"],"repulsion":0},
            {"between":["shell","shell"],"repulsion":0}]},
        {"type":"bonds","potential":{"type":"harmonic","stiffness":20},"exclude_charges":true},
        {"type":"electrostatics","bjerrum_length":86.4,"width":0.5842}]"#;
    let scene = fluid(&["space.box=[6,6,6]", "time.step=0.01", "output={}", particles, molecules, interactions]);
    let mut run = Device::new(&scene);
    run.step(3000);
    let mut squares = Vec::new();
    for _ in 0..2500 {
        run.step(10);
        let mut moment = [0.0; 3];
        for bead in run.state().positions.as_chunks::<2>().0 {
            for (axis, sum) in moment.iter_mut().enumerate() {
                let away = bead[0][axis].wrapping_sub(bead[1][axis]).cast_signed();
                *sum += charge * f64::from(away) * 6.0 / 2_f64.powi(32);
            }
        }
        squares.push(moment.iter().map(|component| component * component).sum::<f64>() / 648.0);
    }
    let [mut moments, mut weights] = [0.0; 2];
    for distance in (1..4000).map(|index| f64::from(index) * 1e-3) {
        let energy = 0.5 * stiffness * distance * distance
            + bjerrum * charge * charge * libm::erf(distance / (2.0 * width)) / distance;
        let weight = distance * distance * (bjerrum * charge * charge / (width * PI.sqrt()) - energy).exp();
        weights += weight;
        moments += weight * distance * distance;
    }
    let expected = charge * charge * moments / weights;
    println!("permittivity {}", 1.0 + 4.0 * PI * bjerrum * 3.0 * expected / 3.0);
    Measured::of(&squares).assert("mean square of the moment, a bead", expected, 0.05 * expected, 0.05 * expected);
}

/// Ions without any other force are screened as by Debye and Hückel where they are many and weak, κσ = .29:
/// `S_ZZ = k²/(k² + κ² e^(-k²σ²))`, which tends to k²/κ².
#[test]
#[ignore = "minutes"]
fn weak_ions_are_screened_as_by_debye_and_hueckel() {
    let particles =
        r#"particles=[{"species":"cation","count":408,"charge":1},{"species":"anion","count":408,"charge":-1}]"#;
    let interactions = r#"interactions=[{"type":"langevin","friction":1},
        {"type":"electrostatics","bjerrum_length":0.1,"width":0.5842}]"#;
    let output = r#"output={"structure_factor":{"every":40,"range":2.1,"bins":42,"charges":true}}"#;
    let scene = fluid(&[
        "space.box=[16,16,16]",
        "time.step=0.1",
        "time.steps=41000",
        "time.equilibration=1000",
        particles,
        interactions,
        output,
    ]);
    let directory = tempfile::tempdir().unwrap();
    Run::replace(scene, directory.path()).execute(&adapter(), &mut |_| {}).unwrap();
    let found = read_table(&directory.path().join("structure_factor.csv")).unwrap();
    let screening = 4.0 * PI * 0.1 * 816.0 / 16_f64.powi(3);
    for row in &found.rows {
        let [k, vectors, value, error] = row[..] else { panic!("{row:?}") };
        let expected = k * k / (k * k + screening * (-(k * 0.5842).powi(2)).exp());
        println!("{k}: {value} ± {error} of {vectors} vectors, expected {expected}");
        assert!((value - expected).abs() < 0.01 * expected + 4.0 * error, "{k}: {value} ± {error}, {expected}");
        assert!(error < 0.04 * expected, "{k}: {error}");
    }
    let [k, _, value, _] = found.rows[0][..] else { panic!() };
    // The longest wave is nearly where screening is perfect.
    assert!((k * k / screening / value - 1.0 - k * k / screening).abs() < 0.15, "{value}");
}

/// Counter-ions of a line of charges .7 apart, 1.58 to a Bjerrum length, of which Manning's theory binds 37 %: the parts of them within some
/// distances are those of the mean field of the line and the other nineteen in the same box, solved apart from this on a grid of two dimensions.
/// Ions that avoid each other gather a little more.
#[test]
#[ignore = "minutes"]
fn counter_ions_gather_at_a_line_of_charges() {
    let places: Vec<[f64; 3]> = (0..20).map(|index| [10.0, 10.0, 0.35 + 0.7 * f64::from(index)]).collect();
    let particles = format!(
        r#"particles=[{{"species":"line","charge":-1,"fixed":true,"velocities":{{"type":"rest"}},
            "placement":{{"type":"listed","positions":{places:?}}}}},{{"species":"ion","count":20,"charge":1}}]"#
    );
    let interactions = r#"interactions=[{"type":"langevin","friction":0.2},
        {"type":"electrostatics","bjerrum_length":1.1039,"width":0.5842}]"#;
    let scene = fluid(&["space.box=[20,20,14]", "time.step=0.1", "output={}", &particles, interactions]);
    let mut run = Device::new(&scene);
    run.step(2000);
    let expected = [(1.0, 0.1707), (2.0, 0.3486), (3.0, 0.4536), (5.0, 0.5985)];
    let mut parts = vec![Vec::new(); expected.len()];
    for _ in 0..4000 {
        run.step(10);
        let state = run.state();
        let distance = |position: &[u32; 3]| {
            let away =
                |axis: usize| f64::from(position[axis].wrapping_sub(1 << 31).cast_signed()) * 20.0 / 2_f64.powi(32);
            away(0).hypot(away(1))
        };
        let distances: Vec<f64> = state.positions[20..].iter().map(distance).collect();
        for ((within, _), found) in expected.iter().zip(&mut parts) {
            found.push(distances.iter().filter(|distance| *distance < within).count() as f64 / 20.0);
        }
    }
    for ((within, expected), found) in expected.iter().zip(&parts) {
        let found = Measured::of(found);
        println!("within {within}: {found:?}, expected {expected}");
        found.assert(&format!("ions within {within}"), *expected, 0.012, 0.012);
    }
}
