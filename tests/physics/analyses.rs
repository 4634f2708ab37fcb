//! Autocorrelations and histograms against statistics, against the observables, and against counts made on the host.

use std::path::Path;

use mesoscope::engine::{Engine, Sample};
use mesoscope::families::Model;
use mesoscope::families::reference::Reference;
use mesoscope::measure::histogram::{gaussian_mean, maxwell_mean};
use mesoscope::measure::wave_vectors::wave_vectors;
use mesoscope::output::read_table;
use mesoscope::plan::Options;
use mesoscope::run::{Outcome, Run};
use mesoscope::scene::{
    self, AnalysisId, ChainSizes, Checked, CorrelatedQuantity, CountedQuantity, Integrator, SceneError,
};
use mesoscope::shaders::{Array, Constant};
use mesoscope::table::Table;
use serde_json::{Value, json};

use crate::support::{
    COTTER_REICH, GROOT_WARREN, INTEGRATORS, PREDICTED, SPLITTING, adapter, changed, edited, engine, fluid, start,
};

fn run(scene: Checked, directory: &Path) -> Outcome {
    Run::replace(scene, directory).execute(&adapter(), &mut |_| {}).unwrap()
}

fn number(outcome: &Outcome, path: &[&str]) -> f64 {
    let found = path.iter().skip(1).fold(&outcome.summary.results[path[0]], |value, key| &value[*key]);
    found.as_f64().or(found["value"].as_f64()).unwrap_or_else(|| panic!("{path:?} is {found}"))
}

fn table(directory: &Path, name: &str) -> Table {
    read_table(&directory.join(name)).unwrap()
}

/// Thermal velocities and no force.
fn gas(changes: &[&str]) -> Checked {
    fluid(&[&["interactions=[]", "particles.0.count=400", "particles.0.number_density=null"], changes].concat())
}

/// Free flights: the squared displacement is the squared velocity times t², to a thousandth of the rounding of single precision, though particles
/// cross the box up to ten times between two samples.
#[test]
fn displacements_count_every_crossing_between_samples() {
    let directory = tempfile::tempdir().unwrap();
    let scene = gas(&[
        "time.step=0.05",
        "time.steps=800",
        "time.equilibration=0",
        r#"output.diffusion={"every":200,"window":4}"#,
    ]);
    let edge = scene.space.lengths[0];
    run(scene, directory.path());
    let table = table(directory.path(), "diffusion.csv");
    let square = table.rows[0][3];
    assert!(square > 2.5 && table.rows[3][1] > 25.0 * edge * edge, "{table:?}");
    for row in &table.rows {
        let expected = square * row[0] * row[0];
        assert!((row[1] - expected).abs() <= 1e-5 * expected, "{} at {}: {expected}", row[1], row[0]);
    }
}

/// Velocities relative to the flow of an ideal gas with `langevin` in shear: ⟨u²⟩ = kT (1 + rate²/2γ²) along the flow,
/// kT across it, and ⟨u(t) u(0)⟩ decays at the rate γ but for what the velocity across carries through the flow,
/// ⟨u·u⟩(t) = exp(-γt) (2 kT + ⟨u²⟩ + rate² kT t/2γ).
#[test]
fn velocities_in_shear_are_relative_to_the_flow() {
    let (rate, friction) = (1.5_f64, 2.0_f64);
    let along = 1.0 + (rate / friction).powi(2) / 2.0;
    for integrator in [SPLITTING, COTTER_REICH] {
        let directory = tempfile::tempdir().unwrap();
        let scene = gas(&[
            integrator,
            &format!(r#"space.shear={{"rate":{rate},"gradient":"y"}}"#),
            &format!(r#"interactions=[{{"type":"langevin","friction":{friction}}}]"#),
            "particles.0.count=2000",
            "time.step=0.02",
            "time.steps=2400",
            "time.equilibration=300",
            r#"output.histograms=[{"quantity":"velocity","every":20,"bins":60,"range":6}]"#,
            r#"output.autocorrelations=[{"quantity":"velocity","every":5,"window":10}]"#,
            "output.plot.width=640",
            "output.plot.height=480",
        ]);
        let outcome = run(scene, directory.path());
        let near = |what: &str, found: f64, expected: f64, error: f64| {
            println!("{integrator} {what}: {found} expected {expected} ± {error}");
            assert!(
                (found - expected).abs() < 4.0 * error,
                "{integrator} {what}: {found}, expected {expected} ± {error}"
            );
        };
        // Of 120 samples, decorrelated by exp(-0.8) from each other, 50 independent ones of 2 000 squares, whose
        // variance is 6 or more.
        let error = (7.0 / (50.0 * 2000.0_f64)).sqrt();
        near("mean square", number(&outcome, &["velocity_histogram", "mean_square"]), 2.0 + along, error);
        let autocorrelation = table(directory.path(), "velocity_autocorrelation.csv");
        let values = autocorrelation.column("autocorrelation").unwrap();
        let times = autocorrelation.column("time").unwrap();
        for (time, value) in times.iter().zip(&values).skip(1) {
            let expected =
                (-friction * time).exp() * (2.0 + along + rate * rate * time / (2.0 * friction)) / (2.0 + along);
            near(&format!("at {time}"), *value, expected, 0.005);
        }
    }
}

/// Particles that are held have no part in means over particles: of free flights beside fixed particles, and beside
/// layers behind walls, the squared velocity is that of the start.
#[test]
fn held_particles_have_no_part_in_means() {
    let fixed = r#"particles=[{"species":"A","count":150},{"species":"W","count":250,"fixed":true}]"#;
    let layer = r#"{"species":"W","count":250,"placement":{"type":"behind-walls","axis":"y","thickness":1}}"#;
    let frozen = format!(r#"particles=[{{"species":"A","count":150}},{layer}]"#);
    let moving = r#"space.walls={"y":{"upper_velocity":[1,0,0]}}"#;
    for (held, space) in [(fixed, "space.box=[5,5,5]"), (&frozen, moving)] {
        for integrator in [SPLITTING, COTTER_REICH] {
            let directory = tempfile::tempdir().unwrap();
            let scene = fluid(&[
                integrator,
                held,
                space,
                "interactions=[]",
                "time.step=0.01",
                "time.steps=12",
                "time.equilibration=0",
                r#"output.diffusion={"every":2,"window":3}"#,
                r#"output.autocorrelations=[{"quantity":"velocity","every":2,"window":3,"frame":"box"}]"#,
                r#"output.histograms=[{"quantity":"velocity","every":4,"frame":"box"}]"#,
            ]);
            let (model, state) = start(&scene);
            let squares = state.momenta.iter().zip(&state.species).filter(|(_, species)| **species == 0);
            let square = 2.0 * squares.map(|(momentum, _)| kinetic_energy(&model, *momentum)).sum::<f64>() / 150.0;
            let outcome = run(scene, directory.path());
            assert_eq!(number(&outcome, &["velocity_histogram", "values"]), 4.0 * 3.0 * 150.0);
            let of_histogram = number(&outcome, &["velocity_histogram", "mean_square"]);
            let diffusion = table(directory.path(), "diffusion.csv");
            let of_correlation = table(directory.path(), "velocity_autocorrelation.csv").rows[0][3];
            for found in [diffusion.rows[0][3], of_correlation, of_histogram] {
                // Walls that move change what they reflect; all else is free.
                let error = if space == moving { 0.1 } else { 1e-5 };
                assert!((found / square - 1.0).abs() < error, "{integrator}, {space}: {found}, expected {square}");
            }
            let expected = square * diffusion.rows[1][0].powi(2);
            let error = if space == moving { 0.2 } else { 1e-5 };
            assert!((diffusion.rows[1][1] / expected - 1.0).abs() < error, "{integrator}: {:?}", diffusion.rows);
        }
    }
}

/// The radial distribution of particles that know nothing of each other is one, whichever axes have walls.
#[test]
fn particles_spread_evenly_have_a_radial_distribution_of_one() {
    let boxes = ["space.box=[4,5,6]", "space.box=[11,9]", "space.box=[60]"];
    let walls = |axes: &str| {
        let pairs: Vec<String> = axes.chars().map(|axis| format!(r#""{axis}":{{"reflection":"specular"}}"#)).collect();
        format!("space.walls={{{}}}", pairs.join(","))
    };
    for (space, axes) in [(0, ""), (0, "z"), (0, "xy"), (0, "xyz"), (1, ""), (1, "x"), (1, "xy"), (2, ""), (2, "x")] {
        let directory = tempfile::tempdir().unwrap();
        let scene = gas(&[
            boxes[space],
            &walls(axes),
            "particles.0.count=1000",
            "time.step=0.01",
            "time.steps=2000",
            r#"output.radial_distribution={"every":100,"range":2,"bins":20}"#,
        ]);
        run(scene, directory.path());
        let table = table(directory.path(), "radial_distribution.csv");
        let volume = [120.0, 99.0, 60.0][space];
        for row in &table.rows {
            let shell = match space {
                0 => 4.0 * std::f64::consts::PI * row[0] * row[0],
                1 => 2.0 * std::f64::consts::PI * row[0],
                _ => 2.0,
            };
            // Of 20 samples the pairs of a bin, of which half may lie behind walls, and the places of 1 000 particles,
            // as those near a wall have fewer neighbours.
            let pairs = 20.0 * 499_500.0 * shell * 0.1 / volume;
            let error = (2.0 / pairs + if axes.is_empty() { 0.0 } else { 0.5_f64.powi(2) / 20_000.0 }).sqrt();
            assert!((row[1] - 1.0).abs() < 5.0 * error, "{space} {axes}: {row:?} ± {error}");
        }
    }
}

/// The last sample of the first analysis on the device after some steps, and a reference with the particles as the
/// analysis sees them.
fn last_sample_and_reference(scene: &Checked, steps: u64) -> (Vec<i64>, Reference) {
    let (model, state) = start(scene);
    let mut measured = engine(scene, &state, Options::default());
    measured.advance(steps, 4).unwrap();
    let samples = measured.finish().unwrap();
    let found = samples.iter().rfind(|sample| sample.sampler == 1).unwrap();
    assert_eq!(found.step, steps);
    // A state is read before the step is reported.
    let silent = edited(scene, |scene| scene.output = fluid(&["output.energies.every=1000"]).into_scene().output);
    let mut silent = engine(&silent, &state, Options::default());
    silent.advance(steps, 4).unwrap();
    let mut reference = Reference::new(model.clone(), silent.state().unwrap());
    if matches!(scene.system.particle_integrator(), Some(Integrator::Splitting { .. })) {
        reference = Reference::new(model, reference.state_between_forces().unwrap());
    }
    (found.sums.clone(), reference)
}

/// Where the particles of a reference are.
fn places(reference: &Reference) -> Vec<[f64; 3]> {
    let units = reference.model().units;
    reference.state().positions.iter().map(|position| units.position(*position)).collect()
}

/// Between walls pairs are counted by the straight way, and without particles of layers.
#[test]
fn pairs_between_walls_are_counted_without_layers() {
    let fluid_group = r#"{"species":"A","count":300}"#;
    let layer = r#"{"species":"W","number_density":3,"placement":{"type":"behind-walls","axis":"y","thickness":1}}"#;
    for (integrator, groups) in
        [(SPLITTING, [fluid_group, layer]), (PREDICTED, [layer, fluid_group]), (COTTER_REICH, [fluid_group, layer])]
    {
        let scene = fluid(&[
            integrator,
            &format!("particles=[{}]", groups.join(",")),
            r#"space.walls={"y":{},"z":{}}"#,
            "time.step=0.01",
            "time.steps=100",
            "output.energies.every=4",
            r#"output.radial_distribution={"every":4,"range":2.5,"bins":25}"#,
        ]);
        let (found, reference) = last_sample_and_reference(&scene, 8);
        let counted: Vec<i64> = reference.radial_distribution(2.5, 25).iter().map(|count| *count as i64).collect();
        let frozen = |id: usize| reference.model().species[reference.state().species[id] as usize].frozen;
        let places = places(&reference).into_iter().enumerate().filter(|(id, _)| !frozen(*id));
        let places: Vec<[f64; 3]> = places.map(|(_, place)| place).collect();
        let mut counts = vec![0; 25];
        let mut close = 0;
        for (index, first) in places.iter().enumerate() {
            for second in &places[..index] {
                let mut way: [f64; 3] = std::array::from_fn(|axis| first[axis] - second[axis]);
                way[0] -= 5.0 * (way[0] / 5.0).round();
                let bins = way.iter().map(|part| part * part).sum::<f64>().sqrt() * 10.0;
                if let Some(count) = counts.get_mut(bins as usize) {
                    *count += 1;
                }
                close += i64::from((bins - bins.round()).abs() < 1e-4);
            }
        }
        for counted in [found, counted] {
            let differences: i64 = counted.iter().zip(&counts).map(|(a, b)| (a - b).abs()).sum();
            assert!(differences <= 2 * close && close < 30, "{integrator}: {differences} {close}");
        }
        assert!(counts[24] > 300, "{counts:?}");
    }
}

/// Pairs of species on the device and in float64; what every two have adds up to all.
#[test]
fn pairs_of_species_are_counted_by_themselves() {
    let particles = r#"particles=[{"species":"A","count":120},{"species":"B","count":90},{"species":"C","count":60}]"#;
    for integrator in [SPLITTING, COTTER_REICH] {
        let counted = |species: &str| {
            let output = format!(r#"output.radial_distribution={{"every":4,"range":2.5,"bins":20{species}}}"#);
            let changes =
                [integrator, particles, "time.step=0.01", "time.steps=100", "output.energies.every=4", &output];
            last_sample_and_reference(&fluid(&changes), 8)
        };
        let (all, reference) = counted("");
        let expected = |pair: [usize; 2]| -> Vec<i64> {
            let counts = reference.partial_radial_distribution(2.5, 20, pair);
            counts.into_iter().map(|count| count as i64).collect()
        };
        let differ = |found: &[i64], expected: &[i64]| -> i64 {
            assert_eq!(found.len(), expected.len());
            found.iter().zip(expected).map(|(a, b)| (a - b).abs()).sum()
        };
        let pairs = [[0, 0], [0, 1], [1, 1], [0, 2], [1, 2], [2, 2]];
        let (partial, _) = counted(r#","species":"all-pairs""#);
        let twin: Vec<i64> = pairs.into_iter().flat_map(expected).collect();
        // A distance may be rounded across the edge of a bin.
        assert!(differ(&partial, &twin) <= 4, "{partial:?} {twin:?}");
        let sums: Vec<i64> = (0..20).map(|bin| partial.iter().skip(bin).step_by(20).sum()).collect();
        assert_eq!(sums, all);
        for (species, place) in [(r#"["C","A"]"#, 3), (r#""B""#, 2), (r#"["B","B"]"#, 2)] {
            let (found, _) = counted(&format!(r#","species":{species}"#));
            assert_eq!(found, partial[20 * place..20 * (place + 1)], "{species}");
            assert!(found.iter().sum::<i64>() > 300);
        }
    }
}

/// Amplitudes of density waves on the device and in float64, of all particles and of species.
#[test]
fn density_waves_are_those_of_the_reference() {
    let particles = r#"particles=[{"species":"A","count":120},{"species":"B","count":90},{"species":"C","count":60}]"#;
    let edges = [Some(5.0); 3];
    let waves = wave_vectors(edges, 12.0, 30, 6).concat();
    assert!(waves.len() > 120 && waves.iter().flatten().any(|count| *count < -5));
    for (integrator, species) in
        [(SPLITTING, ""), (COTTER_REICH, r#","species":"all-pairs""#), (SPLITTING, r#","species":["C","A"]"#)]
    {
        let output = format!(r#"output.structure_factor={{"every":4,"range":12,"bins":30,"vectors":6{species}}}"#);
        let changes = [integrator, particles, "time.step=0.01", "time.steps=100", "output.energies.every=4", &output];
        let (found, reference) = last_sample_and_reference(&fluid(&changes), 8);
        let of: &[Option<usize>] = match species {
            "" => &[None],
            species if species.contains("all") => &[Some(0), Some(1), Some(2)],
            _ => &[Some(0), Some(2)],
        };
        let expected = waves.iter().flat_map(|waves| of.iter().flat_map(|of| reference.density_wave(*waves, *of)));
        let found: Vec<f64> = found.iter().map(|sum| *sum as f64 / 2_f64.powi(24)).collect();
        assert_eq!(found.len(), 2 * waves.len() * of.len());
        for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert!((found - expected).abs() < 1e-4, "{species} {place}: {found} {expected}");
        }
    }
}

/// The structure factor of charge is the sum of those of all pairs of species, each weighed by the two charges and the numbers of particles.
#[test]
fn charges_scatter_as_pairs_of_species_do() {
    let species = [(40.0, 1.5), (60.0, -1.0), (100.0, 0.0)];
    let measured = |more: &str| {
        let directory = tempfile::tempdir().unwrap();
        let output = format!(r#"output.structure_factor={{"every":10,"range":8,"bins":12,"vectors":9{more}}}"#);
        let outcome = run(
            fluid(&[
                r#"particles=[{"species":"A","count":40,"charge":1.5},{"species":"B","count":60,"charge":-1},{"species":"C","count":100}]"#,
                r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"electrostatics","bjerrum_length":5}]"#,
                "space.box=[4,4,4]",
                "time.step=0.02",
                "time.steps=100",
                "time.equilibration=0",
                &output,
            ]),
            directory.path(),
        );
        (outcome, table(directory.path(), "structure_factor.csv"))
    };
    let (_, pairs) = measured(r#","species":"all-pairs""#);
    let (outcome, charges) = measured(r#","charges":true"#);
    assert_eq!(charges.columns[2..], ["charge_structure_factor", "charge_structure_factor_error"]);
    assert_eq!(outcome.summary.results["structure_factor"]["charges"], true);
    let all: f64 = species.iter().map(|(count, charge)| count * charge * charge).sum();
    for (row, charged) in pairs.rows.iter().zip(&charges.rows) {
        let mut expected = 0.0;
        let mut column = 2;
        for (b, (of_b, q_b)) in species.iter().enumerate() {
            for (a, (of_a, q_a)) in species[..=b].iter().enumerate() {
                let times = if a == b { 1.0 } else { 2.0 };
                expected += times * q_a * q_b * (of_a * of_b).sqrt() * row[column] / all;
                column += 2;
            }
        }
        assert!((charged[2] - expected).abs() < 1e-9, "{row:?} {charged:?} {expected}");
    }
    // Charges screen each other: long waves of charge are weaker than those of charges at random places.
    assert!(charges.rows[0][2] < 0.5, "{:?}", charges.rows[0]);
}

/// Particles on a cubic lattice scatter with all their number where the wave vector is one of the reciprocal lattice, and not at all elsewhere.
#[test]
fn a_lattice_scatters_where_its_planes_do() {
    let directory = tempfile::tempdir().unwrap();
    run(
        fluid(&[
            "interactions=[]",
            "temperature=0",
            "space.box=[6,6,6]",
            r#"particles=[{"species":"A","count":216,"placement":{"type":"lattice"}}]"#,
            "time.steps=2",
            "time.equilibration=0",
            r#"output.structure_factor={"every":1,"range":11.2,"bins":560,"vectors":100}"#,
        ]),
        directory.path(),
    );
    let curve = table(directory.path(), "structure_factor.csv");
    // Planes of the lattice are 1 apart, and 1/√2, 1/√3 along its diagonals.
    let turn = std::f64::consts::TAU;
    for peak in [turn, turn * 2_f64.sqrt(), turn * 3_f64.sqrt()] {
        let row = curve.rows.iter().find(|row| (row[0] - peak).abs() < 0.01).unwrap();
        // Other wave vectors are as long.
        let share = row[2] * row[1] / 216.0;
        assert!((share - share.round()).abs() < 1e-5 && share > 0.9, "{row:?}");
    }
    let first = curve.rows.iter().position(|row| row[0] > turn - 0.01).unwrap();
    assert!(curve.rows[..first].iter().all(|row| row[2].abs() < 1e-9), "{:?}", &curve.rows[..first]);
}

/// Of an ideal gas of two species every g(r) is one, and the speeds of each are those of its mass.
#[test]
fn species_have_results_of_their_own() {
    let directory = tempfile::tempdir().unwrap();
    let outcome = run(
        fluid(&[
            "interactions=[]",
            r#"particles=[{"species":"light","count":600},{"species":"heavy","count":300,"mass":4}]"#,
            "time.step=0.05",
            "time.steps=1200",
            "time.equilibration=0",
            r#"output={"radial_distribution":{"every":60,"range":2.5,"bins":10,"species":"all-pairs"},
                "structure_factor":{"every":60,"range":6,"bins":6,"vectors":20,"species":"all-pairs"},
                "diffusion":{"every":10,"window":20,"species":"heavy"},
                "autocorrelations":[{"quantity":"velocity","every":10,"window":20,"species":"light"}],
                "histograms":[{"quantity":"velocity","every":10,"species":"heavy"}]}"#,
        ]),
        directory.path(),
    );
    let results = &outcome.summary.results;
    let pairs = results["radial_distribution"]["pairs"].as_array().unwrap();
    let names: Vec<&Value> = pairs.iter().map(|pair| &pair["species"]).collect();
    assert_eq!(names, [&json!(["light", "light"]), &json!(["light", "heavy"]), &json!(["heavy", "heavy"])]);
    let curves = table(directory.path(), "radial_distribution.csv");
    let columns = ["0_0", "0_1", "1_1"].map(|pair| {
        [format!("radial_distribution_{pair}"), format!("radial_distribution_{pair}_error"), format!("pairs_{pair}")]
    });
    assert_eq!(curves.columns[1..], *columns.as_flattened());
    let described = &outcome.summary.columns["radial_distribution.csv"];
    assert_eq!(
        (&described[5].name[..], &described[5].species[..]),
        ("radial_distribution_0_1_error", &["light".to_owned(), "heavy".to_owned()][..])
    );
    assert_eq!(described[6].meaning, "pairs counted in all samples");
    for (column, pairs) in [(1, 179_700.0), (4, 180_000.0), (7, 44_850.0)] {
        let mut errors = Vec::new();
        for row in &curves.rows[2..] {
            let shell = 4.0 / 3.0 * std::f64::consts::PI * ((row[0] + 0.125).powi(3) - (row[0] - 0.125).powi(3));
            // Of 21 samples, between which particles fly on by a box or so.
            let error = (21.0 * pairs * shell / 125.0_f64).sqrt().recip();
            assert!((row[column] - 1.0).abs() < 5.0 * error, "{column}: {row:?} ± {error}");
            assert!((row[column + 2] * error * error / row[column] - 1.0).abs() < 1e-12, "{row:?}");
            errors.push(row[column + 1] / error);
        }
        // Each of eight is known to a sixth. Heavy particles fly on by a third of the box, and remember a little.
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(mean > 0.7 && mean < 1.6, "{column}: {errors:?}");
    }
    // Waves of one species are independent of each other and of those of the other: each is 1 ± 1, and their products 0 ± 1/√2.
    let curves = table(directory.path(), "structure_factor.csv");
    assert_eq!(curves.columns[4], "structure_factor_0_1");
    for row in &curves.rows {
        for (column, expected, scatter) in [(2, 1.0, 1.0), (4, 0.0, 0.5_f64.sqrt()), (6, 1.0, 1.0)] {
            let error = scatter / (21.0 * row[1]).sqrt();
            assert!((row[column] - expected).abs() < 5.0 * error, "{column}: {row:?} ± {error}");
            assert!(row[column + 1] > 0.4 * error && row[column + 1] < 4.0 * error, "{column}: {row:?} ± {error}");
        }
    }
    // Momenta are constant: the mean square over a species is that of its start, 3 kT/m to a few parts in a hundred.
    let square = |analysis: &str| number(&outcome, &[analysis, "mean_square"]);
    let light = results["velocity_autocorrelation"]["mean_square"]["value"].as_f64().unwrap();
    let heavy = square("velocity_histogram");
    assert!((light / 3.0 - 1.0).abs() < 0.15 && (heavy / 0.75 - 1.0).abs() < 0.2, "{light} {heavy}");
    assert_eq!(number(&outcome, &["velocity_histogram", "values"]), 3.0 * 300.0 * 121.0);
    assert_eq!([&results["diffusion"]["species"], &results["velocity_autocorrelation"]["species"]], ["heavy", "light"]);
    let displacements = table(directory.path(), "diffusion.csv");
    for row in &displacements.rows[1..] {
        let expected = heavy * row[0] * row[0];
        assert!((row[1] / expected - 1.0).abs() < 1e-4, "{row:?}: {expected}");
    }
}

/// A pair of species without particles has no curve; without any pair there is no result, and the run goes to its end.
#[test]
fn pairs_without_particles_have_no_curve() {
    let run_with = |groups: &str| {
        let directory = tempfile::tempdir().unwrap();
        let radial = r#"output.radial_distribution={"every":5,"range":2,"bins":4,"species":"all-pairs"}"#;
        let particles = format!("particles=[{groups}]");
        let outcome = run(fluid(&["time.step=0.01", "time.steps=10", &particles, radial]), directory.path());
        (outcome, table(directory.path(), "radial_distribution.csv").columns)
    };
    let (outcome, columns) =
        run_with(r#"{"species":"none","count":0},{"species":"A","count":200},{"species":"B","count":1}"#);
    let pairs = outcome.summary.results["radial_distribution"]["pairs"].as_array().unwrap();
    let species: Vec<&Value> = pairs.iter().map(|pair| &pair["species"]).collect();
    assert_eq!(species, [&json!(["A", "A"]), &json!(["A", "B"])]);
    let names =
        |pair: &str| ["radial_distribution", "radial_distribution", "pairs"].map(|name| format!("{name}_{pair}"));
    let [first, second] = [names("1_1"), names("1_2")];
    assert_eq!([&columns[1], &columns[3], &columns[4], &columns[6]], [&first[0], &first[2], &second[0], &second[2]]);
    let (outcome, _) = run_with(r#"{"species":"A","count":1}"#);
    assert!(!outcome.summary.results.contains_key("radial_distribution"));
    assert!(outcome.summary.warnings.iter().any(|warning| warning.contains("there are no pairs of particles")));
}

/// The surface tension across walls belongs to their distance, not to the period of positions, which is longer.
#[test]
fn surface_tension_belongs_to_the_distance_of_walls() {
    let directory = tempfile::tempdir().unwrap();
    let scene = fluid(&[
        r#"space={"box":[5,5,6],"walls":{"z":{}}}"#,
        "time.steps=40",
        r#"output.stress={"every":2,"normal":"z"}"#,
    ]);
    let outcome = run(scene, directory.path());
    let pressure = |component: &str| number(&outcome, &["stress", "pressure", component]);
    let expected = 0.5 * 6.0 * (pressure("zz") - 0.5 * (pressure("xx") + pressure("yy")));
    let found = number(&outcome, &["stress", "surface_tension"]);
    assert!((found / expected - 1.0).abs() < 1e-9, "{found}, expected {expected}");
}

/// Without particles of its species an analysis says so, and the run goes to its end.
#[test]
fn species_without_particles_have_no_structure() {
    for (analysis, settings) in [
        ("structure_factor", r#"{"every":5,"range":6,"species":"none"}"#),
        ("structure_factor", r#"{"every":5,"range":6,"species":["A","none"]}"#),
        ("clusters", r#"{"every":5,"distance":0.5,"species":"none"}"#),
    ] {
        let directory = tempfile::tempdir().unwrap();
        let particles = r#"particles=[{"species":"A","count":200},{"species":"none","count":0}]"#;
        let output = format!("output.{analysis}={settings}");
        let outcome = run(fluid(&["time.step=0.01", "time.steps=10", particles, &output]), directory.path());
        assert!(!outcome.summary.results.contains_key(analysis));
        let missing = format!("no result for `output.{analysis}`: there are no particles");
        assert!(outcome.summary.warnings.contains(&missing), "{:?}", outcome.summary.warnings);
    }
    // Nor has a gas clusters of hundred; none of them are no clusters, and have no size.
    let directory = tempfile::tempdir().unwrap();
    let clusters = r#"output.clusters={"every":5,"distance":0.1,"least":100}"#;
    let outcome = run(fluid(&["time.step=0.01", "time.steps=10", clusters]), directory.path());
    assert_eq!(number(&outcome, &["clusters", "clusters"]), 0.0);
    assert!(outcome.summary.results["clusters"]["mean_size"].is_null());
    let text = std::fs::read_to_string(directory.path().join("clusters.csv")).unwrap();
    assert!(text.lines().skip(1).all(|line| line.ends_with(",0,,,")), "{text}");
}

/// The tension of four interfaces is half of that of two.
#[test]
fn interfaces_share_the_surface_tension() {
    let tension = |interfaces: &str| {
        let directory = tempfile::tempdir().unwrap();
        let stress = format!(r#"output.stress={{"every":2,"normal":"z"{interfaces}}}"#);
        let outcome = run(fluid(&["space.box=[4,4,6]", "time.steps=10", &stress]), directory.path());
        let printed = mesoscope::run::printed_results(&outcome.summary.results);
        let label = printed.into_iter().map(|(label, _)| label).find(|label| label.starts_with("surface tension, of"));
        (number(&outcome, &["stress", "surface_tension"]), label.unwrap())
    };
    let [(two, label), (four, label_of_four)] = [tension(""), tension(r#","interfaces":4"#)];
    assert!((two / four - 2.0).abs() < 1e-12, "{two} {four}");
    assert_eq!(
        [&label[..], &label_of_four],
        ["surface tension, of each of 2 interfaces", "surface tension, of each of 4 interfaces"]
    );
}

/// Particles that touch, directly, one by one or across the boundary, are of one cluster, and so are those that a bond joins; walls stand between
/// those on their two sides.
#[test]
fn particles_that_touch_are_of_one_cluster() {
    let scene = |space: &str, clusters: &str| {
        let positions =
            "[[0.1,4,4],[7.8,4,4],[2,2,0.1],[2,2,7.9],[2.4,2,7.9],[5,5,5],[5.2,5,5],[5.4,5,5],[5.6,5,5],[5.8,5,5]]";
        let particles = format!(
            r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":{positions}}}}},
                {{"species":"B","count":3,"chain":{{"beads":3,"spacing":1}},"placement":{{"type":"lattice"}}}},
                {{"species":"C","placement":{{"type":"listed","positions":[[5.8,5.2,5]]}}}}]"#
        );
        let bonds = r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":0.001}}]"#;
        let clusters = format!("output.clusters={clusters}");
        let time = ["time.step=0.0001", "time.steps=4", "time.equilibration=0", "temperature=0"];
        fluid(&[&[space, &particles, bonds, &clusters][..], &time].concat())
    };
    let found = |scene: Checked| {
        let directory = tempfile::tempdir().unwrap();
        let outcome = run(scene, directory.path());
        let sizes = table(directory.path(), "cluster_sizes.csv");
        let sizes: Vec<[f64; 2]> = sizes.rows.iter().map(|row| [row[0], row[1]]).collect();
        let of = |name: &str| number(&outcome, &["clusters", name]);
        let over_time = table(directory.path(), "clusters.csv");
        assert_eq!(over_time.rows.len(), 3);
        (sizes, [of("clusters"), of("mean_size"), of("weighted_size"), of("largest_size")])
    };
    let open = "space.box=[8,8,8]";
    let (sizes, numbers) = found(scene(open, r#"{"every":2,"distance":0.5}"#));
    // A pair across x, three across z, six of two species, and three that are bonded.
    assert_eq!(sizes, [[2.0, 1.0], [3.0, 2.0], [6.0, 1.0]]);
    assert_eq!(numbers, [4.0, 14.0 / 4.0, (4.0 + 9.0 + 9.0 + 36.0) / 14.0, 6.0]);
    let (sizes, numbers) = found(scene(open, r#"{"every":2,"distance":0.5,"species":"A","least":3}"#));
    assert_eq!(sizes, [[2.0, 1.0], [3.0, 1.0], [5.0, 1.0]]);
    assert_eq!(numbers, [2.0, 4.0, 34.0 / 8.0, 5.0]);
    // Further than the space behind walls, through which nothing is joined.
    for (space, expected) in [
        (open, &[[3.0, 1.0], [7.0, 1.0]][..]),
        (r#"space={"box":[8,8,8],"walls":{"z":{}}}"#, &[[1.0, 1.0], [2.0, 1.0], [7.0, 1.0]]),
    ] {
        let (sizes, _) = found(scene(space, r#"{"every":2,"distance":3,"species":"A"}"#));
        assert_eq!(sizes, expected, "{space}");
    }
    let (sizes, numbers) = found(scene(open, r#"{"every":2,"distance":0.1,"species":"C"}"#));
    assert_eq!((sizes, numbers), (vec![[1.0, 1.0]], [1.0; 4]));
}

/// A profile of one species has what the species has of that of all, and the temperature of its own velocities.
#[test]
fn profiles_of_a_species_are_those_of_its_particles() {
    let profile = |species: &str| {
        let directory = tempfile::tempdir().unwrap();
        let profiles = format!(r#"output.profiles={{"axis":"x","bins":4,"every":5{species}}}"#);
        let particles = r#"particles=[{"species":"light","count":600},{"species":"heavy","count":300,"mass":4}]"#;
        let time = ["time.step=0.05", "time.steps=200", "time.equilibration=0", "interactions=[]"];
        let outcome = run(fluid(&[&[particles, &profiles][..], &time].concat()), directory.path());
        (outcome, table(directory.path(), "profiles.csv"))
    };
    let ((_, all), (outcome, heavy)) = (profile(""), profile(r#","species":"heavy""#));
    assert_eq!(heavy.values("number_density"), all.values("number_density_1"));
    assert_eq!(heavy.values("number_density_error"), all.values("number_density_1_error"));
    assert!(heavy.column("number_density_0").is_none() && heavy.values("velocity_x") != all.values("velocity_x"));
    assert_eq!(outcome.summary.results["profiles"]["species"], "heavy");
    // 300 particles keep the momenta that they have: their temperature is that of the start, 1 ± √(2/900).
    let temperature = number(&outcome, &["profiles", "temperature"]);
    assert!((temperature - 1.0).abs() < 5.0 * (2.0_f64 / 900.0).sqrt(), "{temperature}");
}

/// Molecules, of which some branch, are measured along their bonds, however their beads are numbered.
#[test]
fn sizes_of_molecules() {
    // The bead before each, which is bonded to it.
    let star = [None, Some(0), Some(0), Some(2), Some(0)];
    let chain = [None, Some(0), Some(1), Some(2)];
    let scene = json!({
        "title": "molecules", "space": {"box": [6, 6, 6]}, "time": {"step": 0.01, "steps": 100}, "temperature": 1,
        "particles": [{"species": "A"}, {"species": "B"}],
        "molecules": [
            {"beads": ["A", "B", "B", "B", "B"], "bonds": [[0, 1], [0, 2], [2, 3], [0, 4]], "count": 20, "spacing": 0.6},
            {"beads": ["B"], "count": 50},
            {"beads": ["B", "B", "B", "B"], "bonds": [[0, 1], [1, 2], [2, 3]], "count": 30, "spacing": 0.6}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 30}}],
        "integrator": {"type": "cotter-reich"},
        "output": {"energies": {"every": 7}, "chain_sizes": {"every": 7}},
    });
    let scene = scene::parse("molecules", &scene.to_string(), &[]).unwrap();
    let (found, reference) = last_sample_and_reference(&scene, 35);
    let places = places(&reference);
    let mut expected = Vec::new();
    for (first, count, before, linear) in [(0, 20, &star[..], false), (150, 30, &chain[..], true)] {
        let (mut ends, mut gyration) = (0.0, 0.0);
        for molecule in places[first..first + count * before.len()].chunks_exact(before.len()) {
            let mut beads = vec![[0.0; 3]; before.len()];
            for (bead, before) in before.iter().enumerate().filter_map(|(bead, before)| Some((bead, (*before)?))) {
                beads[bead] = std::array::from_fn(|axis| {
                    let way = molecule[bead][axis] - molecule[before][axis];
                    beads[before][axis] + way - 6.0 * (way / 6.0).round()
                });
            }
            ends += (0..3).map(|axis| beads[before.len() - 1][axis].powi(2)).sum::<f64>();
            for axis in 0..3 {
                let mean = beads.iter().map(|bead| bead[axis]).sum::<f64>() / beads.len() as f64;
                gyration += beads.iter().map(|bead| (bead[axis] - mean).powi(2)).sum::<f64>() / beads.len() as f64;
            }
        }
        expected.extend([linear.then_some(ends), Some(gyration)]);
    }
    let quantum = engine(&scene, reference.state(), Options::default()).plan().quanta.length_squared;
    assert_eq!(found.len(), expected.len());
    for (sum, expected) in found.iter().zip(expected) {
        let measured = *sum as f64 * quantum;
        assert!(expected.is_none_or(|expected| (measured / expected - 1.0).abs() < 1e-4), "{measured}, {expected:?}");
    }
    let groups = scene.model().particles().chain_groups.clone();
    let kinds: Vec<_> = groups.iter().map(|group| (group.name.as_str(), group.chains, group.linear)).collect();
    assert_eq!(kinds, [("A + 4 B", 20, false), ("4 B", 30, true)]);
    // Those with particles of A are the stars, of B both.
    for (species, those) in [("A", 0..1), ("B", 0..2)] {
        let asked = ChainSizes { every: 7, species: Some(species.to_owned()) };
        let chosen = edited(&scene, |scene| scene.output.chain_sizes = Some(asked));
        assert_eq!(chosen.model().particles().chain_groups, groups[those.clone()], "{species}");
        assert_eq!(last_sample_and_reference(&chosen, 35).0, found[2 * those.start..2 * those.end], "{species}");
    }
}

/// Chains in a box whose boundaries shear are measured from copy to copy, where the boundaries have displaced them.
#[test]
fn sizes_of_chains_in_shear() {
    let (rate, step) = (2.0, 0.02);
    for integrator in [SPLITTING, COTTER_REICH, PREDICTED] {
        let scene = fluid(&[
            integrator,
            &format!("time.step={step}"),
            "time.steps=100",
            r#"particles=[{"species":"A","count":300,"chain":{"beads":5,"spacing":0.9}}]"#,
            r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
                {"type":"bonds","species":["A"],"potential":{"type":"harmonic","stiffness":10,"length":0.9}}]"#,
            &format!(r#"space.shear={{"rate":{rate},"gradient":"z","displacement":1.3}}"#),
            "output.energies.every=7",
            r#"output.chain_sizes={"every":7}"#,
        ]);
        let (found, reference) = last_sample_and_reference(&scene, 35);
        // Particles of a split step are half a drift later.
        let time = step * if integrator == SPLITTING { 35.5 } else { 35.0 };
        let shift = 1.3 + rate * 5.0 * time;
        let places = places(&reference);
        let (mut ends, mut gyration) = (0.0, 0.0);
        for chain in places.chunks_exact(5) {
            let mut beads = vec![[0.0; 3]];
            for pair in chain.windows(2) {
                let mut way: [f64; 3] = std::array::from_fn(|axis| pair[1][axis] - pair[0][axis]);
                let up = (way[2] / 5.0).round();
                way[2] -= 5.0 * up;
                way[0] -= up * shift;
                way[0] -= 5.0 * (way[0] / 5.0).round();
                way[1] -= 5.0 * (way[1] / 5.0).round();
                let last = *beads.last().unwrap();
                beads.push(std::array::from_fn(|axis| last[axis] + way[axis]));
            }
            ends += (0..3).map(|axis| beads[4][axis].powi(2)).sum::<f64>();
            for axis in 0..3 {
                let mean = beads.iter().map(|bead| bead[axis]).sum::<f64>() / 5.0;
                gyration += beads.iter().map(|bead| (bead[axis] - mean).powi(2)).sum::<f64>() / 5.0;
            }
        }
        let quantum = engine(&scene, reference.state(), Options::default()).plan().quanta.length_squared;
        for (sum, expected) in found.iter().zip([ends, gyration]) {
            let measured = *sum as f64 * quantum;
            assert!((measured / expected - 1.0).abs() < 1e-4, "{integrator}: {measured}, expected {expected}");
        }
    }
}

/// Two hundred samples of a fluid at kT = 1, some time apart: velocities, speeds, and their autocorrelation.
#[test]
fn velocities_of_a_thermal_fluid_are_those_of_maxwell() {
    let directory = tempfile::tempdir().unwrap();
    let scene = fluid(&[
        "time.steps=2400",
        "time.equilibration=400",
        r#"output.histograms=[{"quantity":"velocity","every":10,"bins":60,"range":5},
            {"quantity":"speed","every":10,"bins":60,"range":5}]"#,
        r#"output.autocorrelations=[{"quantity":"velocity","every":4,"window":20,"fit":"exponential"}]"#,
        "output.plot.width=640",
        "output.plot.height=480",
    ]);
    let outcome = run(scene, directory.path());
    assert!(outcome.summary.warnings.is_empty(), "{:?}", outcome.summary.warnings);
    let particles = 375.0;
    let kinetic = outcome.summary.means["temperature"]["value"].as_f64().unwrap();
    // The centre of mass is at rest.
    let variance = kinetic * (1.0 - 1.0 / particles);

    for (name, values) in [("velocity_histogram", 3.0), ("speed_histogram", 1.0)] {
        let rows = table(directory.path(), &format!("{name}.csv")).rows;
        let total = 201.0 * particles * values;
        assert_eq!(number(&outcome, &[name, "values"]), total);
        let outside =
            number(&outcome, &[name, "above"]) + if values == 3.0 { number(&outcome, &[name, "below"]) } else { 0.0 };
        assert_eq!(rows.iter().map(|row| row[2]).sum::<f64>() + outside, total);
        let width = rows[1][0] - rows[0][0];
        let integral = rows.iter().map(|row| row[1] * width).sum::<f64>();
        assert!((integral - (1.0 - outside / total)).abs() < 1e-12);
        // χ² of the bins with ten values or more. Velocities ten steps (0.4) apart are correlated by 0.2, so that counts
        // scatter at most 1 + 2 · 0.2 times as much as independent ones. That the
        // temperature is known to 0.4 % adds 2 to χ² in all.
        let density = |x: f64| {
            let bin = [x - 0.5 * width, x + 0.5 * width];
            if values == 3.0 { gaussian_mean(bin, 0.0, variance.sqrt()) } else { maxwell_mean(bin, 3.0 * variance, 3) }
        };
        let pairs = rows.iter().map(|row| (row[2], density(row[0]) * width * total));
        let terms: Vec<f64> =
            pairs.filter(|(_, expected)| *expected >= 10.0).map(|(n, e)| (n - e).powi(2) / e).collect();
        let (chi_squared, degrees) = (terms.iter().sum::<f64>(), terms.len() as f64);
        println!("{name}: χ² = {chi_squared:.1} of {degrees}");
        assert!(
            chi_squared < 1.4 * (degrees + 4.0 * (2.0 * degrees).sqrt()) + 4.0,
            "{name}: {chi_squared} of {degrees}"
        );
        assert!(degrees > 35.0);
    }
    // Of 201 samples, correlated by 0.2, at least half are independent: 100 · 375 · 3 values of x, 100 · 375 of r.
    let values = 100.0 * particles * 3.0;
    let near = |path: &[&str], expected: f64, error: f64| {
        let found = number(&outcome, path);
        println!("{path:?}: {found} expected {expected} ± {error}");
        assert!((found - expected).abs() < 4.0 * error, "{path:?}: {found}, expected {expected} ± {error}");
    };
    let h = "velocity_histogram";
    // The total momentum is zero but for rounding of its initial value, one unit of 2⁻²⁴.
    near(&[h, "mean"], 0.0, 1e-7);
    near(&[h, "standard_deviation"], variance.sqrt(), (0.5 / values).sqrt());
    near(&[h, "kurtosis"], 3.0, (24.0 / values).sqrt());
    near(&[h, "mean_square"], 3.0 * variance, (6.0 / (values / 3.0)).sqrt());
    // r² follows χ² with three degrees of freedom: variance 6, fourth moment 252, so (252 - 36)/36 for that of the variance.
    near(&[h, "variance_of_square"], 6.0 * variance * variance, 6.0 * (6.0 / (values / 3.0)).sqrt());
    near(&["speed_histogram", "mean"], (8.0 * variance / std::f64::consts::PI).sqrt(), (0.46 / (values / 3.0)).sqrt());

    let a = "velocity_autocorrelation";
    assert_eq!(number(&outcome, &[a, "windows"]), 25.0);
    // At the same temperature; 25 origins of 375 particles each.
    near(&[a, "mean_square", "value"], 3.0 * variance, number(&outcome, &[a, "mean_square", "error"]));
    assert!(number(&outcome, &[a, "mean_square", "error"]) < 2.0 * 6.0_f64.sqrt() / (25.0 * particles).sqrt());
    let found = table(directory.path(), AnalysisId::Autocorrelation(CorrelatedQuantity::Velocity).table());
    let [normalised, errors, fit] =
        ["autocorrelation", "autocorrelation_error", "fit"].map(|name| found.column(name).unwrap());
    assert_eq!((normalised[0], errors[0], found.rows.len()), (1.0, 0.0, 20));
    assert!(normalised.iter().skip(1).all(|value| *value < 1.0) && errors[1] > 0.0);
    let a_value = number(&outcome, &[a, "fit", "a", "value"]);
    assert!((fit[0] - a_value).abs() < 1e-12 && (a_value - 1.0).abs() < 0.3, "{a_value}");
    assert!(number(&outcome, &[a, "fit", "b", "error"]) > 0.0);

    for name in ["velocity_histogram", "speed_histogram", "velocity_autocorrelation"] {
        let path = directory.path().join(format!("{name}.png"));
        let size = image::image_dimensions(&path).unwrap();
        assert_eq!(size, (640, 480), "{name}");
        assert!(outcome.files.iter().any(|file| *file == format!("{name}.png")), "{:?}", outcome.files);
    }
}

#[test]
fn a_gas_without_forces_keeps_its_velocities() {
    for dimension in [2, 3] {
        let space = format!("space.box={:?}", vec![5.0; dimension]);
        let scene = gas(&[
            &space,
            "time.steps=40",
            r#"output.autocorrelations=[{"quantity":"velocity","every":2,"window":5,"fit":"exponential"},
                {"quantity":"force","every":2,"window":5}]"#,
            r#"output.histograms=[{"quantity":"acceleration","every":10,"bins":3}]"#,
        ]);
        let directory = tempfile::tempdir().unwrap();
        let outcome = run(scene, directory.path());
        let found = table(directory.path(), AnalysisId::Autocorrelation(CorrelatedQuantity::Velocity).table());
        assert!(found.column("autocorrelation").unwrap().iter().all(|value| *value == 1.0), "{found:?}");
        assert!(found.column("autocorrelation_error").unwrap().iter().all(|value| *value == 0.0));
        assert_eq!(found.rows.len(), 5);
        // d kT/m, at the temperature of these 400 particles themselves.
        let kinetic = outcome.summary.means["temperature"]["value"].as_f64().unwrap();
        let expected = dimension as f64 * kinetic * 399.0 / 400.0;
        let mean_square = number(&outcome, &["velocity_autocorrelation", "mean_square", "value"]);
        assert!((mean_square / expected - 1.0).abs() < 1e-6, "{mean_square} {expected}");
        assert_eq!(outcome.summary.results["velocity_autocorrelation"]["fit"], Value::Null);
        assert!(outcome.summary.warnings.iter().any(|warning| warning.contains("does not decay")));
        // There are no forces: all in the middle bin, and nothing to correlate.
        let counts = table(directory.path(), AnalysisId::Histogram(CountedQuantity::Acceleration).table())
            .column("count")
            .unwrap();
        assert_eq!(counts, [0.0, 5.0 * 400.0 * dimension as f64, 0.0]);
        assert!(outcome.summary.results.get("force_autocorrelation").is_none());
        let warned = |text: &str| outcome.summary.warnings.iter().any(|warning| warning.contains(text));
        assert!(warned("`output.autocorrelations (force)`: it is zero"), "{:?}", outcome.summary.warnings);
    }
}

/// Without friction, the forces are those whose squares the observables sum.
#[test]
fn forces_of_a_conservative_fluid_have_the_squares_of_the_observables() {
    for integrator in [SPLITTING, GROOT_WARREN, COTTER_REICH] {
        let scene = fluid(&[
            integrator,
            "time.steps=200",
            "time.step=0.02",
            "interactions.0.friction=0",
            "output.energies.every=5",
            r#"output.autocorrelations=[{"quantity":"force","every":5,"window":2}]"#,
            r#"output.histograms=[{"quantity":"acceleration","every":5}]"#,
        ]);
        let model = scene.model();
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(200, 50).unwrap();
        let samples = engine.finish().unwrap();
        let of = |index: usize| samples.iter().filter(move |sample| sample.sampler == index);
        let squares: Vec<f64> = of(0)
            .map(|sample| mesoscope::measure::observables_of(sample, engine.plan(), model).gradient_squared)
            .collect();
        let plan = engine.plan();
        let quantum = plan.force_unit.powi(2) * 8.0; // 2^(⌈log₂ 375⌉ - 6)
        let products: Vec<i64> = of(1).map(|sample| sample.sums[0]).collect();
        assert_eq!((squares.len(), products.len()), (41, 41));
        for (product, square) in products.iter().zip(&squares).step_by(2) {
            // At the origin of a window the product is the square. Both round pair forces to units, which are 2⁻²⁴ of
            // the thermal momentum in half a step, and add in single precision.
            assert!((*product as f64 * quantum / square - 1.0).abs() < 1e-5, "{integrator}: {product} {square}");
        }
        // The moments of the histogram hold them too: Σ|a|² in units of the range squared, all masses being one.
        let range = plan.kernels.iter().find(|kernel| kernel.name == "acceleration_histogram").map(|kernel| {
            let constant = |name| kernel.constants.iter().find(|(known, _)| *known == name).unwrap().1;
            plan.force_unit / constant(Constant::Fraction)
        });
        let unit = range.unwrap().powi(2) / constant_of(&engine, "acceleration_histogram", Constant::Moment);
        for (sample, square) in of(2).zip(&squares) {
            let moments = &sample.sums[103..];
            assert_eq!(sample.sums[102], 0, "no particle is far beyond the range");
            for moment in [moments[1], moments[3]] {
                assert!((moment as f64 * unit / square - 1.0).abs() < 1e-5, "{integrator}: {moment} {square}");
            }
        }
        assert!(squares.iter().all(|square| *square > 100.0));
    }
}

fn constant_of(engine: &Engine<'_>, kernel: &str, name: Constant) -> f64 {
    let kernel = engine.plan().kernels.iter().find(|known| known.name == kernel).unwrap();
    kernel.constants.iter().find(|(known, _)| *known == name).unwrap().1
}

/// The forces by id are what the momenta change by, to the last bit: by half a step's impulse from the stored momenta to
/// those of the report, or, where steps are split, by a whole step's.
#[test]
fn reported_forces_are_changes_of_momenta() {
    let species = r#"particles=[{"species":"A","count":200},{"species":"B","count":175,"mass":2.5}]"#;
    let chains = [
        r#"particles=[{"species":"A","count":200,"chain":{"beads":4,"spacing":0.8}},{"species":"B","count":175,"mass":2.5}]"#,
        r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"angles","stiffness":3},
            {"type":"bonds","potential":{"type":"harmonic","stiffness":40,"length":0.8},"exclude_repulsion":true}]"#,
    ];
    // Every integrator in either space and with either list of species, and with bonds.
    for (row, space) in ["space.box=[5,5,5]", "space.box=[11,12]"].into_iter().enumerate() {
        for (column, integrator) in INTEGRATORS.iter().enumerate() {
            let particles = ["title=test", species][(row + column) % 2];
            let asked = ["time.steps=100", r#"output.histograms=[{"quantity":"acceleration","every":1000}]"#];
            for more in [&[particles][..], &chains] {
                let scene = fluid(&[&[*integrator, space], more, &asked].concat());
                let (model, state) = start(&scene);
                let mut engine = engine(&scene, &state, Options::default());
                engine.advance(30, 30).unwrap();
                let before = engine.state().unwrap();
                let reported = engine.reported().unwrap();
                let forces: Vec<i32> =
                    engine.words(Array::ReportedForces).unwrap().into_iter().map(|word| word as i32).collect();
                let mut strongest = 0;
                for id in 0..before.len() {
                    for axis in 0..3 {
                        let change = reported.momenta[id][axis] - before.momenta[id][axis];
                        let force = forces[4 * id + axis];
                        // Another kernel adds up the impulses of a split step: its rounding may differ in a unit.
                        let tolerance = if integrator.contains("splitting") { 2 } else { 0 };
                        assert!((change - force).abs() <= tolerance, "{integrator} {space}: {change} and {force}");
                        strongest = strongest.max(force.abs());
                    }
                }
                assert!(strongest > 1 << 20, "{strongest}");
                let time = model.time_step * if integrator.contains("splitting") { 1.0 } else { 0.5 };
                assert_eq!(engine.plan().force_unit, model.units.momentum / time);
            }
        }
    }
}

/// Who does not ask for forces has no buffer of them and no kernel that knows of them.
#[test]
fn forces_cost_nothing_unless_they_are_asked_for() {
    for integrator in INTEGRATORS {
        let plan = |changes: &[&str]| {
            let scene = fluid(&[&[*integrator, "time.steps=100"], changes].concat());
            let (_, state) = start(&scene);
            engine(&scene, &state, Options::default()).plan().clone()
        };
        let without = plan(&[r#"output.histograms=[{"quantity":"velocity","every":1}]"#]);
        assert!(!without.has_buffer(Array::ReportedForces));
        let nothing = plan(&[]);
        assert!(nothing.buffers.iter().all(|buffer| !buffer.array.name().starts_with("reported")));
        assert!(without.kernels.iter().all(|kernel| !kernel.files().unwrap().contains("pairs/reported_force/kept")));
        let with = plan(&[r#"output.autocorrelations=[{"quantity":"force","every":1,"window":2}]"#]);
        assert!(with.has_buffer(Array::ReportedForces));
        // Only a report writes them: kernels of a step without one are the same.
        assert_eq!(
            with.advance.iter().map(|kernel| &with.kernels[*kernel]).collect::<Vec<_>>(),
            without.advance.iter().map(|kernel| &without.kernels[*kernel]).collect::<Vec<_>>()
        );
    }
}

/// The kinetic energy of a particle of unit mass.
fn kinetic_energy(model: &Model, momentum: [i32; 3]) -> f64 {
    model.units.momentum(momentum).iter().map(|component| 0.5 * component * component).sum()
}

/// The bin of a value in units of half bins, in single precision as on the device.
fn bin_of(value: f32, per_half_bin: f32, half_below: i64, bins: usize) -> usize {
    let half = half_below + (value * per_half_bin).floor() as i64;
    match half {
        half if half < 0 => bins,
        half if half >= 2 * bins as i64 => bins + 1,
        half => half as usize / 2,
    }
}

#[test]
fn counts_are_those_of_the_reported_particles() {
    // Bins even and odd in number, ranges that leave some values out. All masses are one, so that what the device
    // multiplies before it takes the whole part is what is multiplied here.
    for (integrator, space) in [(SPLITTING, "space.box=[5,5,5]"), (PREDICTED, "space.box=[20,20]")] {
        let scene = fluid(&[
            integrator,
            space,
            "time.steps=100",
            "output.energies.every=4",
            r#"output.histograms=[{"quantity":"velocity","every":4,"bins":37,"range":1.7},
                {"quantity":"acceleration","every":4,"bins":50,"range":9,"axis":"y"},
                {"quantity":"speed","every":4,"bins":21,"range":2.0}]"#,
        ]);
        let (model, state) = start(&scene);
        let dimension = model.units.dimension;
        let mut engine = engine(&scene, &state, Options::default());
        for _ in 0..5 {
            let reported = engine.reported().unwrap();
            let forces = engine.words(Array::ReportedForces).unwrap();
            let samples = engine.finish().unwrap();
            let sums = |sampler: usize| {
                let found: Vec<&Sample> = samples.iter().filter(|sample| sample.sampler == sampler).collect();
                assert_eq!((found.len(), found[0].step), (1, reported.step));
                found[0].sums.clone()
            };
            // In a split step, velocities are those right after the relaxation, where the temperature is measured.
            let momenta: Vec<[i32; 3]> = if integrator == SPLITTING {
                let words = engine.words(Array::ReportedMomenta).unwrap();
                let vector = |words: &[u32]| [words[0] as i32, words[1] as i32, words[2] as i32];
                words.chunks_exact(4).map(vector).collect()
            } else {
                reported.momenta.clone()
            };
            let kinetic: f64 = momenta.iter().map(|momentum| kinetic_energy(&model, *momentum)).sum();
            let measured = samples.iter().filter(|sample| sample.sampler == 0);
            for sample in measured {
                let measured = mesoscope::measure::observables_of(sample, engine.plan(), &model).kinetic_energy;
                assert!((kinetic / measured - 1.0).abs() < 1e-6, "{integrator}: {kinetic} {measured}");
            }
            let mut counts = [vec![0; 39], vec![0; 52], vec![0; 23]];
            let factor = |name: &str| constant_of(&engine, name, Constant::HalfBins) as f32;
            for (id, momentum) in momenta.iter().enumerate() {
                for axis in 0..dimension {
                    counts[0][bin_of(momentum[axis] as f32, factor("velocity_histogram"), 37, 37)] += 1;
                }
                let force = forces[4 * id + 1] as i32;
                counts[1][bin_of(force as f32, factor("acceleration_histogram"), 50, 50)] += 1;
            }
            for sampler in [1, 2] {
                let sums = sums(sampler);
                assert_eq!(sums[..counts[sampler - 1].len()], counts[sampler - 1], "{integrator} sampler {sampler}");
            }
            // A magnitude is a root, which single precision gives to a few units in the last place: on an edge by so
            // little a value may be counted on either side.
            let exact = |momentum: &[i32; 3]| momentum.iter().map(|c| f64::from(*c).powi(2)).sum::<f64>().sqrt();
            let per_half_bin = constant_of(&engine, "speed_histogram", Constant::HalfBins);
            let mut close = 0;
            for momentum in &momenta {
                let half_bins = exact(momentum) * per_half_bin;
                close += i64::from((half_bins / 2.0 - (half_bins / 2.0).round()).abs() < 1e-5);
                counts[2][bin_of(half_bins as f32, 1.0, 0, 21)] += 1;
            }
            let differences: i64 = sums(3).iter().zip(&counts[2]).map(|(a, b)| (a - b).abs()).sum();
            assert!(differences <= 2 * close && close < 5, "{differences} {close}");
            assert!(counts[0][37] > 0 && counts[0][38] > 0 && counts[1][50] > 0 && counts[2][22] > 0, "{counts:?}");
            // The powers, in double precision: those of the device are in single, with errors of either sign.
            let velocity = sums(1);
            let quantum = 1.0 / constant_of(&engine, "velocity_histogram", Constant::Moment);
            let fraction = constant_of(&engine, "velocity_histogram", Constant::Fraction);
            let values = || momenta.iter().flatten().map(|component| f64::from(*component) * fraction);
            for (moment, power) in [(0, 1), (1, 2), (2, 4)] {
                let expected: f64 = values().map(|value| value.powi(power)).sum();
                let magnitude: f64 = values().map(|value| value.abs().powi(power)).sum();
                let found = velocity[40 + moment] as f64 * quantum;
                assert!((found - expected).abs() < 1e-6 * magnitude, "moment {power}: {found} and {expected}");
            }
            for (moment, power) in [(3, 2), (4, 4)] {
                let expected: f64 = momenta.iter().map(|momentum| (exact(momentum) * fraction).powi(power)).sum();
                let found = velocity[40 + moment] as f64 * quantum;
                assert!((found / expected - 1.0).abs() < 1e-6, "magnitude {power}: {found} and {expected}");
            }
            engine.advance(4, 4).unwrap();
        }
    }
}

#[test]
fn particles_far_beyond_the_range_are_counted_apart() {
    let directory = tempfile::tempdir().unwrap();
    let text = r#"{"title": "four", "space": {"box": [9, 9]}, "time": {"step": 0.01, "steps": 0}, "temperature": 0,
        "particles": [{"species": "A", "placement": {"type": "listed", "positions": [[1, 1], [3, 3], [5, 5], [7, 7]]},
            "velocities": {"type": "listed", "velocities": [[0.5, -0.5], [1.0, -1.0], [-20, 0], [18.5, 1.5]]}}],
        "output": {"histograms": [{"quantity": "velocity", "every": 1, "bins": 2, "range": 1}]}}"#;
    let outcome = run(crate::support::scene(text), directory.path());
    let counts =
        table(directory.path(), AnalysisId::Histogram(CountedQuantity::Velocity).table()).column("count").unwrap();
    // 0.5 and 0 in the upper bin, -0.5 and -1 in the lower; 1, 18.5, 1.5 above, -20 below.
    assert_eq!(counts, [2.0, 2.0]);
    assert_eq!(number(&outcome, &["velocity_histogram", "below"]), 1.0);
    assert_eq!(number(&outcome, &["velocity_histogram", "above"]), 3.0);
    // Of the two particles that are not far: ⟨x²⟩ = (1/4 + 1/4 + 1 + 1)/4, ⟨r²⟩ twice that, ⟨r⁴⟩ = (1/4 + 4)/2.
    assert_eq!(number(&outcome, &["velocity_histogram", "mean"]), 0.0);
    assert_eq!(number(&outcome, &["velocity_histogram", "standard_deviation"]), 0.625_f64.sqrt());
    assert_eq!(number(&outcome, &["velocity_histogram", "variance_of_square"]), 2.125 - 1.25 * 1.25);
    let warned = |text: &str| outcome.summary.warnings.iter().any(|warning| warning.contains(text));
    assert!(warned("2 times a particle was further") && warned("50.00 %"), "{:?}", outcome.summary.warnings);
}

/// A gas of two species that drifts: about the centre of mass nothing of the drift is left, in the box all of it.
#[test]
fn velocities_about_the_centre_of_mass() {
    let means = |frame: &str| {
        let analyses = |quantity: &str| format!(r#"{{"quantity":"{quantity}","every":1,"frame":"{frame}","range":8}}"#);
        let histograms = format!("output.histograms=[{},{}]", analyses("velocity"), analyses("speed"));
        let correlations =
            format!(r#"output.autocorrelations=[{{"quantity":"velocity","every":1,"window":2,"frame":"{frame}"}}]"#);
        let scene = crate::support::scene(
            r#"{"title": "t", "space": {"box": [9, 9, 9]}, "time": {"step": 0.01, "steps": 3}, "temperature": 0,
            "particles": [
                {"species": "A", "mass": 1, "placement": {"type": "listed", "positions": [[1, 1, 1]]},
                    "velocities": {"type": "listed", "velocities": [[3, 0.25, -1]]}},
                {"species": "B", "mass": 3, "placement": {"type": "listed", "positions": [[4, 4, 4]]},
                    "velocities": {"type": "listed", "velocities": [[-1, 0.25, 3]]}}]}"#,
        );
        let text = serde_json::to_string(&scene).unwrap();
        let scene = changed(&text, &[&histograms, &correlations]);
        let directory = tempfile::tempdir().unwrap();
        let outcome = run(scene, directory.path());
        [
            number(&outcome, &["velocity_histogram", "mean"]),
            number(&outcome, &["velocity_histogram", "mean_square"]),
            number(&outcome, &["velocity_autocorrelation", "mean_square", "value"]),
            number(&outcome, &["speed_histogram", "mean"]),
        ]
    };
    let close = |found: [f64; 4], expected: [f64; 4]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    };
    let r = 10.0625_f64;
    close(means("box"), [4.5 / 6.0, r, r, r.sqrt()]);
    // The centre of mass moves with (0, 0.25, 2): what is left is (3, 0, -3) and (-1, 0, 1).
    close(means("centre-of-mass"), [0.0, 10.0, 10.0, f64::midpoint(18_f64.sqrt(), 2_f64.sqrt())]);
}

const EVERYTHING: &[&str] = &[
    "time.steps=60",
    "time.equilibration=10",
    r#"output.autocorrelations=[{"quantity":"velocity","every":1,"window":6,"fit":"damped-oscillation"},
        {"quantity":"force","every":2,"window":5,"fit":"stretched-exponential"}]"#,
    r#"output.histograms=[{"quantity":"velocity","every":1,"bins":1024},{"quantity":"speed","every":3},
        {"quantity":"acceleration","every":2,"frame":null}]"#,
];

/// Neither the batches of steps nor the order in which particles are stored changes a bit.
#[test]
fn samples_do_not_depend_on_batches_or_storage() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let scene = fluid(&[&[integrator][..], EVERYTHING].concat());
        let (_, state) = start(&scene);
        let all = |batch: u64, reversed: bool, options: Options| {
            let mut engine = engine(&scene, &state, options);
            if reversed {
                let order: Vec<usize> = (0..state.len()).rev().collect();
                engine.upload_in_order(&state, &order).unwrap();
            }
            engine.advance(60, batch).unwrap();
            engine.finish().unwrap()
        };
        let samples = all(60, false, Options::default());
        assert_eq!(samples.iter().filter(|sample| sample.sampler == 3).count(), 51);
        assert_eq!(samples, all(7, true, Options::default()));
        let lanes = Options { workgroup_size: Some(16), ..Options::default() };
        assert_eq!(samples, all(60, false, lanes));
    }
}

fn problems(changes: &[&str]) -> Vec<String> {
    let text = serde_json::to_string(&fluid(&["time.steps=100", "time.equilibration=20"])).unwrap();
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", &text, &changes) {
        Err(SceneError::Invalid { problems, .. }) => problems.iter().map(ToString::to_string).collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn mistakes_are_named() {
    let found = problems(&[
        r#"output.autocorrelations=[{"quantity":"velocity","every":2,"window":40},
            {"quantity":"velocity","every":2,"window":41},
            {"quantity":"force","every":1,"window":8,"frame":"box"}]"#,
        r#"output.histograms=[{"quantity":"speed","every":1,"axis":"x"},{"quantity":"velocity","every":1,"axis":"z"},
            {"quantity":"velocity","every":1},{"quantity":"acceleration","every":1,"frame":"box"}]"#,
        "space.box=[11,12]",
    ]);
    let expected = [
        "output.autocorrelations[1].window: found 41 samples of 2 steps, 82 steps in all",
        "output.autocorrelations[1].quantity: found \"velocity\" again",
        "output.autocorrelations[2].frame: found for the quantity \"force\"",
        "output.histograms[0].axis: found for the quantity \"speed\"",
        "output.histograms[1].axis: found \"z\"",
        "output.histograms[2].quantity: found \"velocity\" again",
        "output.histograms[3].frame: found for the quantity \"acceleration\"",
    ];
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for expected in expected {
        assert!(found.iter().any(|problem| problem.starts_with(expected)), "{expected}\n{found:#?}");
    }
    let found = problems(&[r#"output.histograms=[{"quantity":"velocty","every":0,"bins":2000,"range":0}]"#]);
    assert_eq!(found.len(), 4, "{found:#?}");
    assert!(found.iter().any(|problem| problem.contains("did you mean `velocity`?")), "{found:#?}");
}

/// Samples are taken at the steps that were asked for, from the end of the equilibration on.
#[test]
fn samples_are_taken_when_they_are_due() {
    let histograms = r#"output.histograms=[{"quantity":"velocity","every":5,"bins":8}]"#;
    let scene = fluid(&["time.steps=20", "time.equilibration=3", histograms]);
    let (_, state) = start(&scene);
    let mut engine = engine(&scene, &state, Options::default());
    engine.advance(20, 20).unwrap();
    let samples = engine.finish().unwrap();
    let steps: Vec<u64> = samples.iter().filter(|sample| sample.sampler == 1).map(|sample| sample.step).collect();
    assert_eq!(steps, [3, 8, 13, 18]);
}
