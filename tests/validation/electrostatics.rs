//! Salt water against integral equations and exact laws, and charges that conserve momentum: `make validate`.

use mesoscope::scene::Checked;
use std::f64::consts::TAU;

use crate::support::{Device, Implementation, Measured, fluid};

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
        Measured::of(found).assert(&format!("S_ZZ(2π {number}/10)"), expected, 0.03 * expected, 0.05 * expected);
    }
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
