//! Charges against sums of Ewald, and the expected errors of their mesh.

use serde_json::json;

use crate::support::{Device, Implementation};

/// Two opposite charges in a periodic cube of 10: the force on one of them, over the Bjerrum length, by Ewald's sums.
#[test]
fn the_force_between_two_charges_is_that_of_ewald() {
    let gaussian = json!({"width": 0.5842});
    let slater = json!({"decay": 0.929});
    let of_gaussian = [(0.5, 0.209_405), (1.0, 0.305_322), (2.0, 0.210_959), (3.0, 0.094_572), (5.0, 0.0)];
    let of_slater = [(0.5, 0.268_757), (1.0, 0.280_642), (2.0, 0.169_930), (3.0, 0.085_726), (5.0, 0.0)];
    for (cloud, values, meshes) in [
        (gaussian, of_gaussian, &[(0.5, 6, 2e-3), (0.25, 6, 2e-4), (0.25, 4, 1e-3)][..]),
        (json!({"width": 0.5842, "method": "waves"}), of_gaussian, &[(0.5, 6, 1e-3)]),
        (slater, of_slater, &[(0.25, 6, 6e-3), (0.15, 6, 2e-3)]),
    ] {
        for (distance, expected) in values {
            // Off the nodes.
            let place = [2.37, 4.11, 7.78];
            let other = [2.37 + distance, 4.11, 7.78];
            let group = |species: &str, charge: f64, at: [f64; 3]| {
                json!({"species": species, "charge": charge, "placement": {"type": "listed", "positions": [at]},
                    "velocities": {"type": "rest"}})
            };
            for &(spacing, order, relative) in meshes {
                let mut electrostatics =
                    json!({"type": "electrostatics", "bjerrum_length": 2, "spacing": spacing, "order": order});
                electrostatics.as_object_mut().unwrap().extend(cloud.as_object().unwrap().clone());
                let scene = crate::support::scene(
                    &json!({
                        "title": "two", "space": {"box": [10, 10, 10]}, "time": {"step": 1e-3, "steps": 1}, "temperature": 1,
                        "integrator": {"type": "cotter-reich"},
                        "particles": [group("P", 1.0, place), group("M", -1.0, other)],
                        "interactions": [electrostatics],
                        "output": {"energies": {"every": 1}},
                    })
                    .to_string(),
                );
                let mut run = Device::new(&scene);
                run.step(1);
                let momenta = run.state().momenta;
                assert_eq!(momenta[0], momenta[1].map(|component| -component));
                // Half a step after the start.
                let force =
                    momenta[0].map(|component| f64::from(component) * scene.model().units.momentum / (0.5e-3 * 2.0));
                let off = [force[0] - expected, force[1], force[2]].map(f64::abs).into_iter().fold(0.0, f64::max);
                assert!(off < relative * 0.31, "{cloud} {distance} {spacing} {order}: {force:?}, expected {expected}");
            }
        }
    }
}

/// The force between two opposite charges that a bond excludes is that of their images: Ewald's sums less d/dr erf(r/2σ)/r.
#[test]
fn the_force_of_excluded_charges_is_that_of_images() {
    for (distance, ewald) in [(0.5, 0.209_405), (1.0, 0.305_322), (2.0, 0.210_959), (3.0, 0.094_572)] {
        let group = |species: &str, charge: f64, at: f64| {
            json!({"species": species, "charge": charge, "velocities": {"type": "rest"},
                "placement": {"type": "listed", "positions": [[at, 4.11, 7.78]]}})
        };
        let scene = crate::support::scene(
            &json!({
                "title": "two", "space": {"box": [10, 10, 10]}, "time": {"step": 1e-3, "steps": 1}, "temperature": 1,
                "integrator": {"type": "cotter-reich"},
                "particles": [group("P", 1.0, 2.37), group("M", -1.0, 2.37 + distance)],
                "interactions": [
                    {"type": "electrostatics", "bjerrum_length": 2, "width": 0.5842, "spacing": 0.25},
                    {"type": "bonds", "pairs": [[0, 1]], "exclude_charges": true},
                ],
                "output": {"energies": {"every": 1}},
            })
            .to_string(),
        );
        let mut run = Device::new(&scene);
        run.step(1);
        let momenta = run.state().momenta;
        assert_eq!(momenta[0], momenta[1].map(|component| -component));
        let force = f64::from(momenta[0][0]) * scene.model().units.momentum / (0.5e-3 * 2.0);
        let x: f64 = distance / (2.0 * 0.5842);
        let direct = (libm::erf(x) - std::f64::consts::FRAC_2_SQRT_PI * x * (-x * x).exp()) / (distance * distance);
        assert!((force - (ewald - direct)).abs() < 1e-4, "{distance}: {force} {}", ewald - direct);
    }
}
