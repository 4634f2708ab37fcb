//! Profiles along an axis: against sums made on the host, by hand, and against equilibrium.

use std::path::Path;

use mesoscope::engine::Sample;
use mesoscope::families::Model;
use mesoscope::output::read_table;
use mesoscope::plan::Options;
use mesoscope::run::{Outcome, Run};
use mesoscope::scene::{Checked, ProfiledQuantity};
use mesoscope::shaders::Array;
use mesoscope::table::Table;
use serde_json::json;

use crate::support::{
    COTTER_REICH, MIXTURE, MIXTURE_FORCE, PREDICTED, SPLITTING, adapter, cells, engine, fluid, start,
};

fn run(scene: Checked, directory: &Path) -> (Outcome, Table) {
    let outcome = Run::replace(scene, directory).execute(&adapter(), &mut |_| {}).unwrap();
    (outcome, read_table(&directory.join("profiles.csv")).unwrap())
}

/// Two sheets of opposite charge half a period apart, held in the middle of bins: between them the field is 2π kT lB times their charge an
/// area, and at each the potential of clouds of width σ is lower by σ√(2/π) of that field than that of thin ones.
#[test]
fn two_sheets_of_charge_have_a_constant_field_between_them() {
    let sheet = |species: &str, charge: f64, z: f64| {
        let places: Vec<[f64; 3]> =
            (0..16).map(|index| [f64::from(index % 4) * 2.0 + 0.3, f64::from(index / 4) * 2.0 + 0.7, z]).collect();
        json!({"species": species, "charge": charge, "fixed": true, "velocities": {"type": "rest"},
            "placement": {"type": "listed", "positions": places}})
    };
    let scene = crate::support::scene(
        &json!({
            "title": "sheets", "space": {"box": [8, 8, 8]}, "time": {"step": 0.01, "steps": 2}, "temperature": 1.5,
            "integrator": {"type": "cotter-reich"},
            "particles": [sheet("P", 0.5, 2.05), sheet("M", -0.5, 6.05)],
            "interactions": [{"type": "electrostatics", "bjerrum_length": 1.2, "width": 0.4}],
            "output": {"profiles": {"axis": "z", "bins": 80, "every": 1, "quantities": ["charge"]}},
        })
        .to_string(),
    );
    let directory = tempfile::tempdir().unwrap();
    let (_, profile) = run(scene, directory.path());
    let [charge, potential] = ["charge_density", "electrostatic_potential"].map(|name| profile.column(name).unwrap());
    for (bin, found) in charge.iter().enumerate() {
        let expected = match bin {
            20 => 8.0 / 6.4,
            60 => -8.0 / 6.4,
            _ => 0.0,
        };
        assert!((found - expected).abs() < 1e-12, "{bin}: {found}");
    }
    let field = std::f64::consts::TAU * 1.5 * 1.2 * 8.0 / 64.0;
    let slope = (potential[42] - potential[38]) / 0.4;
    assert!((slope / field + 1.0).abs() < 1e-5, "{slope} {field}");
    let top = field * (2.0 - 0.4 * (2.0 / std::f64::consts::PI).sqrt());
    assert!(
        (potential[20] / top - 1.0).abs() < 1e-6 && (potential[60] / top + 1.0).abs() < 1e-6,
        "{top} {potential:?}"
    );
}

/// Every particle is in the layer of its position, with its species, mass, momentum and kinetic energy.
#[test]
fn sums_are_those_of_the_reported_particles() {
    let listed = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":3}}]"#;
    let scenes = [
        fluid(&[SPLITTING, MIXTURE, MIXTURE_FORCE, r#"output.profiles={"axis":"z","bins":7,"every":3}"#]),
        fluid(&[PREDICTED, "space.box=[20,20]", r#"output.profiles={"axis":"y","bins":1024,"every":3}"#]),
        fluid(&[COTTER_REICH, MIXTURE, listed, r#"output.profiles={"axis":"x","bins":40,"every":3}"#]),
        cells(200, &[r#"output.profiles={"axis":"x","bins":9,"every":3}"#]),
        fluid(&[
            SPLITTING,
            MIXTURE,
            MIXTURE_FORCE,
            r#"output.profiles={"axis":"y","bins":7,"every":3,"quantities":["stress"]}"#,
        ]),
        fluid(&[
            PREDICTED,
            "space.box=[20,20]",
            r#"output.profiles={"axis":"x","bins":30,"every":3,"quantities":["stress"]}"#,
        ]),
    ];
    for scene in scenes {
        let asked = scene.output.profiles.clone().unwrap();
        let (model, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(6, 3).unwrap();
        let reported = engine.reported().unwrap();
        let samples = engine.finish().unwrap();
        let [.., sample] = samples.iter().filter(|sample| sample.sampler == 1).collect::<Vec<&Sample>>()[..] else {
            panic!("no sample")
        };
        assert_eq!((sample.step, reported.step), (6, 6));
        // Right after the relaxation of a split step.
        let momenta: Vec<[i32; 3]> = if engine.plan().has_buffer(Array::ReportedMomenta) {
            let words = engine.words(Array::ReportedMomenta).unwrap();
            words.chunks_exact(4).map(|words| [words[0] as i32, words[1] as i32, words[2] as i32]).collect()
        } else {
            reported.momenta.clone()
        };
        let (species, dimension) = (model.species.len(), model.units.dimension);
        // The virials of each particle, in the units of the sums; tests of the stress compare them with the reference.
        let virials: Vec<f64> = if engine.plan().has_buffer(Array::ReportedStresses) {
            engine.words(Array::ReportedStresses).unwrap().iter().map(|word| f64::from(*word as i32)).collect()
        } else {
            Vec::new()
        };
        let stress = species + dimension + 2;
        let width = stress + if virials.is_empty() { 0 } else { 12 };
        assert_eq!(virials.is_empty(), !asked.quantities.contains(&ProfiledQuantity::Stress));
        let mut expected = vec![0.0; asked.bins as usize * width];
        let masses = masses(&model, &reported.species, &reported.masses);
        for (id, (position, mass)) in reported.positions.iter().zip(masses).enumerate() {
            let layer = (u64::from(position[asked.axis as usize]) * u64::from(asked.bins)) >> 32;
            let sums = &mut expected[layer as usize * width..][..width];
            sums[reported.species[id] as usize] += 1.0;
            sums[species] += mass;
            for axis in 0..dimension {
                let momentum = f64::from(momenta[id][axis]);
                sums[species + 1 + axis] += momentum;
                sums[species + 1 + dimension] += momentum * momentum / mass;
            }
            for (component, (a, b)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
                if let Some(own) = virials.get(12 * id..12 * id + 12) {
                    sums[stress + component] += f64::from(momenta[id][a]) * f64::from(momenta[id][b]) / mass;
                    sums[stress + 6 + component] += own[component] + own[6 + component];
                }
            }
        }
        assert_eq!(sample.sums.len(), expected.len());
        // Counts are exact; a layer of a few particles may have a momentum near zero. Everything else is rounded to single precision
        // particle by particle.
        let total: f64 = (0..asked.bins as usize).map(|layer| expected[layer * width + species]).sum();
        let unit_of_mass = total.log2().ceil().exp2() * 2_f64.powi(-61);
        let units = model.units.momentum.powi(2) / engine.plan().quanta.energy;
        let typical = momenta.iter().flatten().map(|momentum| f64::from(momentum.abs())).fold(0.0, f64::max);
        for (index, (found, expected)) in sample.sums.iter().zip(&expected).enumerate() {
            let found = *found as f64;
            let what = format!("layer {}, sum {} of {width}", index / width, index % width);
            match index % width {
                place if place < species => assert_eq!(found, *expected, "{what}"),
                place if place == species => {
                    assert!((found * unit_of_mass - expected).abs() <= 1e-6 * expected, "{what}: {found}");
                }
                place if place <= species + dimension => {
                    assert!((found - expected).abs() <= 1e-5 * typical, "{what}: {found} {expected}");
                }
                place if place < stress => {
                    assert!((found / units - expected).abs() <= 1e-6 * expected + 1.0 / units, "{what}: {found}");
                }
                // Of the momentum across, parts of both signs cancel; each is rounded to single precision and to a unit.
                place if place < stress + 6 => {
                    let rounding = 1e-6 * typical * typical + f64::from(reported.len() as u32) / units;
                    assert!((found / units - expected).abs() <= rounding, "{what}: {found} {expected}");
                }
                _ => assert_eq!(found, *expected, "{what}"),
            }
        }
    }
}

fn masses(model: &Model, species: &[u32], own: &[u32]) -> Vec<f64> {
    if own.is_empty() {
        return species.iter().map(|species| model.species[*species as usize].mass).collect();
    }
    // The units of masses of their own are those that make up the whole.
    let total: f64 = model.species.iter().map(|species| species.mass * species.count as f64).sum();
    let units: f64 = own.iter().map(|mass| f64::from(*mass)).sum();
    own.iter().map(|mass| f64::from(*mass) * total / units).collect()
}

/// Five particles in two bins, without any force.
#[test]
fn means_worked_out_by_hand() {
    let text = r#"{"title": "five", "space": {"box": [8, 2]}, "time": {"step": 0.01, "steps": 2}, "temperature": 0,
        "particles": [
            {"species": "A", "placement": {"type": "listed", "positions": [[1, 0.5], [2, 0.5], [7, 1]]},
                "velocities": {"type": "listed", "velocities": [[1, 2], [-1, 0.5], [0, 0.25]]}},
            {"species": "B", "mass": 2, "placement": {"type": "listed", "positions": [[2.5, 1], [3, 1]]},
                "velocities": {"type": "listed", "velocities": [[0.5, -1], [0.5, 0.25]]}}],
        "output": {"profiles": {"axis": "x", "bins": 2, "every": 1}}}"#;
    let directory = tempfile::tempdir().unwrap();
    let (outcome, table) = run(crate::support::scene(text), directory.path());
    let near = |column: &str, expected: [f64; 2]| {
        let found = table.column(column).unwrap();
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5 || (found.is_nan() && expected.is_nan()), "{column}: {found}");
        }
    };
    near("position", [2.0, 6.0]);
    // A bin has a volume of 8.
    near("number_density", [0.5, 0.125]);
    near("number_density_0", [0.25, 0.125]);
    near("number_density_1", [0.25, 0.0]);
    // Momentum (2, 1) of a mass of 6 in the first bin.
    near("velocity_x", [1.0 / 3.0, 0.0]);
    near("velocity_y", [1.0 / 6.0, 0.25]);
    // Σ m v² = 5 + 1.25 + 2 · 1.25 + 2 · 0.3125 = 9.375, of the centre 5/6, for 2 · 3 degrees of freedom; one particle has none.
    near("temperature", [(9.375 - 5.0 / 6.0) / 6.0, f64::NAN]);
    near("number_density_error", [0.0, 0.0]);
    let result = &outcome.summary.results["profiles"];
    assert_eq!((&result["axis"], &result["samples"], &result["species"][1]), (&"x".into(), &3.into(), &"B".into()));
    assert!((result["temperature"]["value"].as_f64().unwrap() - (9.375 - 5.0 / 6.0) / 6.0).abs() < 1e-5);
}

/// A fluid at rest is the same everywhere, within the errors that the profiles state, and these are as large as fluctuations make them.
#[test]
fn a_fluid_at_rest_is_uniform() {
    let directory = tempfile::tempdir().unwrap();
    let scene = fluid(&[
        "space.box=[5,5,8]",
        "time.steps=2400",
        "time.equilibration=400",
        r#"output.profiles={"axis":"z","bins":8,"every":10}"#,
        "output.plot.width=640",
        "output.plot.height=480",
    ]);
    let (outcome, table) = run(scene, directory.path());
    let temperature = &outcome.summary.results["profiles"]["temperature"];
    let [value, error] = ["value", "error"].map(|key| temperature[key].as_f64().unwrap());
    // 201 samples of 600 particles, of which at least half are independent: √(2/(3 · 592 · 100)) = .0034. The integrator is right
    // to .004 at this step.
    assert!(error < 0.0068 && (value - 1.0).abs() < 4.0 * 0.0034 + 0.004, "{value} ± {error}");
    for (column, expected) in [("number_density", 3.0), ("temperature", value)] {
        let values = table.column(column).unwrap();
        let errors = table.column(&format!("{column}_error")).unwrap();
        // Σ z² over 8 bins has a mean of 8 and a standard deviation of 4. 201 samples in blocks of up to eight give the errors to
        // √(1/48), 14 %, and may miss a third of the variance.
        let chi_squared: f64 =
            values.iter().zip(&errors).map(|(value, error)| ((value - expected) / error).powi(2)).sum();
        println!("{column}: χ² = {chi_squared:.1} of 8");
        assert!(chi_squared < 1.5 * (8.0 + 4.0 * 4.0) && chi_squared > 0.3, "{column}: χ² = {chi_squared}");
    }
    let mean = table.column("number_density").unwrap().iter().sum::<f64>() / 8.0;
    assert!((mean - 3.0).abs() < 1e-12, "{mean}");
    // A velocity of 75 particles scatters by √(1/75) and decays no more slowly than the longest shear wave, at the rate ηk²/ρ =
    // .84 (2π/8)²/3 = .173: the mean over a time of 80 scatters by √(1/75 · 2/(.173 · 80)).
    let scatter = (1.0_f64 / 75.0 * 2.0 / (0.173 * 80.0)).sqrt();
    for column in ["velocity_x", "velocity_y", "velocity_z"] {
        let [velocities, errors] = [column, &format!("{column}_error")].map(|column| table.column(column).unwrap());
        assert!(velocities.iter().all(|velocity| velocity.abs() < 4.0 * scatter), "{column}: {velocities:?}");
        assert!(errors.iter().all(|error| *error < 2.0 * scatter && *error > 0.05 * scatter), "{column}: {errors:?}");
    }
    assert_eq!(image::image_dimensions(directory.path().join("profiles.png")).unwrap(), (640, 480));
}

/// All bins together have the pressure tensor of the box, once the mean flows that profiles leave out are added: ρ uᵢ uⱼ of each bin. One bin
/// is the whole box, which does not flow.
#[test]
fn profiles_of_the_stress_add_up() {
    for bins in [1, 5] {
        let scene = fluid(&[
            "time.steps=60",
            r#"output.stress={"every":10}"#,
            &format!(
                r#"output.profiles={{"axis":"x","bins":{bins},"every":10,"quantities":["density","velocity","stress"]}}"#
            ),
        ]);
        let directory = tempfile::tempdir().unwrap();
        let (outcome, table) = run(scene, directory.path());
        let column = |name: &str| table.column(name).unwrap();
        for [one, other] in [["x", "x"], ["y", "y"], ["z", "z"], ["x", "y"], ["x", "z"], ["y", "z"]] {
            let component = format!("{one}{other}");
            let pressures = column(&format!("pressure_{component}"));
            let velocities = [one, other].map(|axis| column(&format!("velocity_{axis}")));
            let density = column("number_density");
            let whole = |bin: usize| pressures[bin] + density[bin] * velocities[0][bin] * velocities[1][bin];
            let mean = (0..bins).map(whole).sum::<f64>() / bins as f64;
            let expected = outcome.summary.results["stress"]["pressure"][&component]["value"].as_f64().unwrap();
            // Sums of some 375 particles, each to single precision.
            assert!((mean - expected).abs() < 1e-4, "{bins} bins, {component}: {mean}, {expected}");
            let differ = pressures.iter().any(|value| (value - mean).abs() > 1e-3);
            assert!(bins == 1 || differ, "{component}: {pressures:?}");
        }
    }
}
