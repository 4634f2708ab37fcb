//! Wrong scenes of Voronoi DPD: each mistake with its place, what was found and what is accepted; what is allowed but
//! deserves a warning; and how cells start.

use mesoscope::families::Model;
use mesoscope::families::initial_state;
use mesoscope::scene::{self, Checked};
use mesoscope::state::State;
use mesoscope::tessellation::Tessellation;
use serde_json::{Value, json};

use crate::support::mistakes::Correct;

const CELLS: Correct = Correct(base);

/// A small correct scene.
fn base() -> Value {
    json!({
        "title": "test",
        "space": {"box": [6, 6]},
        "time": {"step": 0.01, "steps": 100},
        "temperature": 1,
        "particles": [{"species": "A", "count": 36, "mass": 5}],
        "interactions": [{"type": "voronoi"}],
    })
}

/// The small scene with these overrides draws this one warning.
#[track_caller]
fn warned(overrides: &[&str], path: &str, expected: &str) {
    let warnings = mesoscope::families::warnings(&CELLS.accepted(overrides));
    let [warning] = &warnings[..] else { panic!("{overrides:?}: {warnings:?}") };
    assert!(warning.path == path && warning.message.contains(expected), "{overrides:?}: {warning}");
}

#[test]
fn the_base_is_right_and_draws_no_warning() {
    let scene = CELLS.accepted(&[]);
    assert!(mesoscope::families::warnings(&scene).is_empty(), "{:?}", mesoscope::families::warnings(&scene));
    assert_eq!(scene.system.integrator_name(), "splitting", "the default of Voronoi DPD");
    assert_eq!(scene.output.snapshot.color, scene::SnapshotColor::Density, "one species");
    let validator = jsonschema::draft202012::new(&scene::schema()).unwrap();
    assert!(validator.is_valid(&base()));
    assert!(validator.is_valid(&serde_json::to_value(&scene).unwrap()));
}

#[test]
fn colours_follow_the_species_where_there_are_several_and_the_scene_where_it_says_so() {
    let two = r#"particles=[{"species":"A","count":2},{"species":"B","count":2}]"#;
    assert_eq!(CELLS.accepted(&[two]).output.snapshot.color, scene::SnapshotColor::Species);
    let asked = CELLS.accepted(&[two, r#"output={"snapshot":{"color":"speed"}}"#]);
    assert_eq!(asked.output.snapshot.color, scene::SnapshotColor::Speed);
    let asked = CELLS.accepted(&[r#"output={"snapshot":{"color":"species","every":7}}"#]);
    assert_eq!((asked.output.snapshot.color, asked.output.snapshot.every), (scene::SnapshotColor::Species, 7));
}

// ---- What a scene is made of

#[test]
fn cells_are_alone_and_in_a_plane() {
    CELLS.refused(
        &[r#"interactions=[{"type":"voronoi"},{"type":"langevin","friction":1}]"#, "integrator.type=euler"],
        "interactions[0]: found together with another interaction; accepted: `voronoi` as the only interaction of a scene",
    );
    CELLS.refused(
        &["space.box=[6,6,6]"],
        "space.box: found 3 edges; accepted: two edges: Voronoi cells are those of a plane",
    );
    CELLS.refused(
        &["integrator.type=cotter-reich"],
        "integrator.type: found \"cotter-reich\" in a scene of Voronoi DPD; accepted: `splitting`, `euler`",
    );
    CELLS.refused(
        &["integrator.type=splitting", "integrator.relaxation=two-stages"],
        "integrator.relaxation: unknown key; accepted: type",
    );
    CELLS.refused(
        &["integrator.type=gyro"],
        "integrator.type: found \"gyro\" in a scene of Voronoi DPD; accepted: `splitting`, `euler`",
    );
}

#[test]
fn cells_move_freely() {
    CELLS.refused(
        &["particles.0.fixed=true"],
        "particles[0].fixed: found in a scene of Voronoi DPD; accepted: cells that move: one that is held would absorb momentum and energy of \
         the others",
    );
    CELLS.refused(
        &[r#"particles.0.chain={"beads":6}"#],
        "particles[0].chain: found in a scene of Voronoi DPD; accepted: no chains in Voronoi DPD: its cells have no forces but those at their \
         faces",
    );
    CELLS.refused(
        &["particles.0.tracer=true"],
        "particles[0].tracer: found in a scene of Voronoi DPD; accepted: a scene of shallow water only",
    );
    CELLS.refused(
        &[r#"particles=[{"species":"A","count":9},{"species":"B","count":9,"mass":1e-6}]"#],
        "particles[1].mass: found 0.000001; accepted: at least 1e-4, 1e-4 of the heaviest species: masses are counted in \
         units of 2⁻²⁴ of that",
    );
}

#[test]
fn too_many_cells() {
    CELLS.refused(
        &["particles.0.count=300000000"],
        "particles: found 300000000 cells in the scene; accepted: at most 268435456 cells, since faces name their \
         neighbours in 28 bits",
    );
    let found = CELLS.problems(&["particles.0.count=5000000000"]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("particles[0].count: found 5000000000 particles"), "{found:?}");
}

// ---- The fluid

#[test]
fn one_viscosity() {
    CELLS.refused(
        &["interactions.0.viscosity=1", "interactions.0.shear_viscosity=2"],
        "interactions[0]: both `viscosity` and `shear_viscosity` are given; accepted: one of `viscosity`, of the law of \
         friction, and `shear_viscosity`, of the network of cells",
    );
    let viscosity = |scene: &Checked| scene.model().voronoi().unwrap().viscosity;
    assert_eq!(viscosity(&CELLS.accepted(&[])), 1.0);
    assert_eq!(viscosity(&CELLS.accepted(&["interactions.0.viscosity=3"])), 3.0);
    assert_eq!(viscosity(&CELLS.accepted(&["interactions.0.viscosity=0"])), 0.0);
    let wanted = viscosity(&CELLS.accepted(&["interactions.0.shear_viscosity=2.47"]));
    assert!((wanted - 2.0).abs() < 1e-15, "{wanted}");
}

#[test]
fn masses_of_uniform_pressure_need_temperatures() {
    let uniform = "interactions.0.initial_masses=uniform-pressure";
    CELLS.refused(
        &[uniform],
        "interactions[0].initial_masses: found `uniform-pressure` without `energy`; accepted: `uniform-density` in a scene \
         without `energy`: at one temperature it is the same",
    );
    let zero = "interactions[0].initial_masses: found `uniform-pressure` with a temperature of 0, at which there is no \
                pressure; accepted: temperatures above 0 everywhere, or masses `equal` or of `uniform-density`";
    CELLS.refused(&[uniform, "interactions.0.energy={}", "temperature=0"], zero);
    let cold = r#"interactions.0.energy={"initial_temperatures":[{"center":[1,1],"radius":1,"temperature":0}]}"#;
    CELLS.refused(&[uniform, cold], zero);
}

#[test]
fn masses_have_to_fit_the_integers() {
    // All but one of the cells are specks in a corner: the last has the whole box.
    let mut positions: Vec<[f64; 2]> =
        (0..999).map(|index| [1e-5 * f64::from(index), 1e-5 * f64::from(index * index % 7)]).collect();
    positions.push([3.0, 3.0]);
    let listed = json!([{"species": "A", "mass": 5, "placement": {"type": "listed", "positions": positions}}]);
    let found = CELLS.problems(&[&format!("particles={listed}"), "interactions.0.initial_masses=uniform-density"]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].starts_with("interactions[0].initial_masses: found `uniform-density`, with a mass of "),
        "{found:?}"
    );
    assert!(found[0].contains("a more even placement"), "{found:?}");
}

// ---- What is measured

#[test]
fn pictures_of_cells() {
    CELLS.refused(
        &[r#"output={"snapshot":{"color":"temperature"}}"#],
        "output.snapshot.color: found `temperature` in a scene of one temperature; accepted: `density`, `speed` or \
         `species`; or an `energy` in the interaction",
    );
    CELLS.accepted(&[r#"output={"snapshot":{"color":"temperature"}}"#, "interactions.0.energy={}"]);
    CELLS.refused(
        &[r#"output={"snapshot":{"radius":0.5}}"#],
        "output.snapshot.radius: found in a scene of Voronoi DPD; accepted: no `radius` in Voronoi DPD: pictures show cells, not discs",
    );
}

const DIFFUSION: &str = r#"output={"diffusion":{"every":1,"window":9}}"#;

#[test]
fn analyses_of_particles() {
    CELLS.refused(
        &[r#"output={"radial_distribution":{"every":1,"range":2}}"#],
        "output.radial_distribution: found in a scene of Voronoi DPD; accepted: `neighbours`, which counts the neighbours of \
         cells; pairs have no range here",
    );
    CELLS.refused(
        &[r#"output={"snapshot":{"species":["A"]}}"#],
        "output.snapshot.species: found in a scene of Voronoi DPD; accepted: no `species` in Voronoi DPD: its cells fill the box",
    );
    CELLS.refused(
        &[r#"output={"autocorrelations":[{"quantity":"force","every":1,"window":9}]}"#],
        "output.autocorrelations[0].quantity: found \"force\" in a scene of Voronoi DPD; accepted: \"velocity\" in Voronoi DPD, where momentum moves \
         with mass",
    );
    CELLS.refused(
        &[r#"output={"histograms":[{"quantity":"acceleration","every":1}]}"#],
        "output.histograms[0].quantity: found \"acceleration\" in a scene of Voronoi DPD; accepted: \"velocity\" or \"speed\" in Voronoi DPD, where \
         momentum moves with mass",
    );
    // Velocities are those of each cell by its own mass.
    CELLS.accepted(&[DIFFUSION, "interactions.0.form=paper", "interactions.0.initial_masses=uniform-density"]);
}

#[test]
fn a_shear_wave_is_measured_where_there_is_one() {
    let output = r#"output={"shear_wave":{"every":5}}"#;
    CELLS.refused(
        &[output],
        "output.shear_wave: found in a scene without a shear wave; accepted: a scene in which some particles start with \
         velocities of type `shear-wave`",
    );
    let wave = r#"{"type":"shear-wave","amplitude":0.1,"periods":2}"#;
    let other = r#"{"type":"shear-wave","amplitude":0.1}"#;
    CELLS.accepted(&[output, &format!("particles.0.velocities={wave}")]);
    let two = format!(
        r#"particles=[{{"species":"A","count":9,"velocities":{wave}}},{{"species":"A","count":9,"velocities":{other}}}]"#
    );
    CELLS.refused(
        &[output, &two],
        "particles[1].velocities.periods: found 1; accepted: 2 as in particles[0]: one wave is measured",
    );
}

#[test]
fn what_only_cells_have() {
    let dpd = r#"interactions=[{"type":"dpd"}]"#;
    let place = "found in a scene of particles; accepted: a scene of Voronoi DPD only";
    let choice = |name: &str, accepted: &str| format!("found \"{name}\" in a scene of particles; accepted: {accepted}");
    let colours = "\"species\", \"speed\"";
    for (change, path, refusal) in [
        (
            "integrator.type=euler",
            "integrator.type",
            choice("euler", "`splitting`, `groot-warren`, `cotter-reich`").as_str(),
        ),
        (
            r#"particles.0.velocities={"type":"shear-wave","amplitude":1}"#,
            "particles[0].velocities.type",
            &choice("shear-wave", "`thermal`, `rest`, `listed`"),
        ),
        (r#"output={"snapshot":{"color":"density"}}"#, "output.snapshot.color", &choice("density", colours)),
        (r#"output={"snapshot":{"color":"temperature"}}"#, "output.snapshot.color", &choice("temperature", colours)),
        (r#"output={"neighbours":{"every":1}}"#, "output.neighbours", place),
        (r#"output={"shear_wave":{"every":1}}"#, "output.shear_wave", place),
    ] {
        CELLS.refused(&[dpd, change], &format!("{path}: {refusal}"));
    }
}

#[test]
fn all_mistakes_are_told_at_once() {
    let found = CELLS.problems(&[
        "integrator.type=groot-warren",
        "particles.0.fixed=true",
        "interactions.0.viscosity=-1",
        "interactions.0.exchange_limit=0.9",
        "interactions.0.friction_solver.iterations=0",
        r#"output={"neighbours":{"every":0},"shear_wave":{"every":1}}"#,
    ]);
    let paths: Vec<&str> = found.iter().map(|problem| problem.split(": ").next().unwrap()).collect();
    for path in [
        "integrator.type",
        "particles[0].fixed",
        "interactions[0].viscosity",
        "interactions[0].exchange_limit",
        "interactions[0].friction_solver.iterations",
        "output.neighbours.every",
        "output.shear_wave",
    ] {
        assert!(paths.contains(&path), "{path} in {found:?}");
    }
    assert_eq!(found.len(), 7, "{found:?}");
}

#[test]
fn jitter_is_not_for_chains() {
    let chains =
        r#"particles=[{"species":"A","count":6,"chain":{"beads":3},"placement":{"type":"lattice","jitter":0.1}}]"#;
    let bonds = r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":1}}]"#;
    CELLS.refused(
        &[chains, bonds],
        "particles[0].placement.jitter: found 0.1; accepted: no `jitter` for chains, which would stretch their bonds",
    );
}

// ---- What is allowed but deserves a warning

#[test]
fn time_steps_that_are_too_long() {
    warned(
        &["time.step=0.1", "interactions.0.molecular_mass=0.05"],
        "time.step",
        "sound of speed 4.472 passes 0.45 of a cell",
    );
    warned(&["time.step=0.4", "interactions.0.viscosity=0"], "time.step", "a step of 2.00e-1, is advisable");
    warned(
        &["integrator.type=euler"],
        "time.step",
        "`euler` runs hot by about 3 % at this step; 6.3e-3 would be hot by 2 %",
    );
    warned(&["time.step=0.15", "interactions.0.viscosity=2"], "time.step", "friction of a step, dt η/M, is 0.060");
    assert!(CELLS.warnings(&["integrator.type=euler", "time.step=0.0005"]).is_empty());
    // PHYSICS: measured right with the implicit solver.
    assert!(CELLS.warnings(&["time.step=0.16"]).is_empty());
}

#[test]
fn fluids_that_the_model_does_not_describe_well() {
    let dense = r#"particles=[{"species":"A","count":36,"mass":50}]"#;
    let paper = "interactions.0.form=paper";
    warned(&[paper, dense], "interactions[0].form", "√(ρkT)/η = 7.07 and M/m = 50");
    assert!(CELLS.warnings(&[paper]).is_empty());
    assert!(CELLS.warnings(&[dense]).is_empty());
    warned(
        &["interactions.0.energy={}"],
        "interactions[0].molecular_mass",
        "a cell holds 5 molecules, and its temperature varies by 45 %",
    );
    warned(
        &[r#"interactions.0.energy={"conductivity":200}"#, "interactions.0.molecular_mass=0.1"],
        "time.step",
        "the random heat through a face is 0.04 of the energy of a cell in one step",
    );
    warned(&["temperature=0"], "temperature", "no pressure at any time");
    warned(
        &["temperature=0", "interactions.0.energy={}", "interactions.0.molecular_mass=0.1"],
        "temperature",
        "no pressure until friction has heated them",
    );
    warned(
        &[r#"particles.0.velocities={"type":"shear-wave","amplitude":0.6}"#],
        "particles[0].velocities.amplitude",
        "0.60 times as fast as sound",
    );
}

// ---- How cells start

fn start(overrides: &[&str]) -> (Model, State) {
    let scene = CELLS.accepted(overrides);
    (scene.model().clone(), initial_state(&scene))
}

const LARGE: [&str; 2] = ["space.box=[40,80]", "particles.0.count=3200"];

#[test]
fn equal_cells_have_the_mass_of_their_species() {
    let (model, state) =
        start(&[r#"particles=[{"species":"A","count":3,"mass":5},{"species":"B","count":2,"mass":2}]"#]);
    let unit = model.voronoi().unwrap().mass_unit;
    let masses: Vec<f64> = state.masses.iter().map(|mass| f64::from(*mass) * unit).collect();
    assert_eq!(masses, [5.0, 5.0, 5.0, 2.0, 2.0]);
    assert!(state.energies.is_empty());
    assert_eq!(state.total_momentum(), [0; 3]);
}

#[test]
fn masses_of_uniform_density_follow_the_volumes() {
    let (model, state) = start(&[&LARGE[..], &["interactions.0.initial_masses=uniform-density"]].concat());
    let unit = model.voronoi().unwrap().mass_unit;
    let cells = Tessellation::of_fractions([40.0, 80.0], &state.positions).cells;
    // To half a unit, and one for the sum.
    for (mass, cell) in state.masses.iter().zip(&cells) {
        assert!((f64::from(*mass) * unit - 5.0 * cell.volume).abs() <= 1.5 * unit, "{mass} {}", cell.volume);
    }
    let total: u64 = state.masses.iter().map(|mass| u64::from(*mass)).sum();
    assert_eq!(total as f64 * unit, 3200.0 * 5.0, "to the last unit");
    assert_eq!(state.total_momentum(), [0; 3]);
    // Each at the temperature by its own mass: Σ P²/2M is chi-squared with 2 · 3199 degrees of freedom.
    let squares = |momentum: &[i32; 3]| model.units.momentum(*momentum).iter().map(|part| part * part).sum::<f64>();
    let parts = state.momenta.iter().zip(&state.masses).map(|(p, mass)| squares(p) / (2.0 * f64::from(*mass) * unit));
    let temperature = parts.sum::<f64>() / 3199.0;
    assert!((temperature - 1.0).abs() < 4.0 / 3199_f64.sqrt(), "{temperature}");
    // Momenta of heavy and light cells: with one width for all, Σ P²/2M of the lighter half would be 1.5 times that.
    let light: Vec<usize> = (0..state.len()).filter(|id| cells[*id].volume < 0.5).collect();
    let sum: f64 =
        light.iter().map(|&id| squares(&state.momenta[id]) / (2.0 * f64::from(state.masses[id]) * unit)).sum();
    let temperature = sum / light.len() as f64;
    assert!((temperature - 1.0).abs() < 4.0 / (light.len() as f64).sqrt(), "{temperature} of {}", light.len());
}

#[test]
fn a_shear_wave_comes_on_top_of_thermal_velocities() {
    let wave = r#"particles.0.velocities={"type":"shear-wave","amplitude":0.3,"periods":2}"#;
    let (model, state) = start(&[&LARGE[..], &[wave]].concat());
    assert_eq!(state.total_momentum(), [0; 3], "to the last bit");
    let unit = model.units.momentum;
    let project = |axis: usize| {
        let each = state.momenta.iter().zip(&state.positions).map(|(momentum, position)| {
            let phase = 2.0 * std::f64::consts::TAU * f64::from(position[1]) / 4_294_967_296.0;
            f64::from(momentum[axis]) * unit * phase.sin()
        });
        2.0 * each.sum::<f64>() / (3200.0 * 5.0)
    };
    // The thermal part of it has a variance of 2kT/Nm.
    let deviation = (2.0_f64 / (3200.0 * 5.0)).sqrt();
    // Σ sin² over random places is a half to 1/√(8N), which the amplitude shows.
    let error = 4.0 * deviation.hypot(0.3 * (0.5 / 3200.0_f64).sqrt());
    assert!((project(0) - 0.3).abs() < error, "{}", project(0));
    assert!(project(1).abs() < 4.0 * deviation, "{}", project(1));
}

#[test]
fn energies_are_kinetic_and_internal_together() {
    let energy = r#"interactions.0.energy={"initial_temperatures":[{"center":[0,0],"radius":10,"temperature":3}]}"#;
    let molecules = "interactions.0.molecular_mass=0.05";
    let masses = "interactions.0.initial_masses=uniform-pressure";
    let (model, state) = start(&[&LARGE[..], &[energy, molecules, masses]].concat());
    let cells = model.voronoi().unwrap();
    let tessellation = Tessellation::of_fractions([40.0, 80.0], &state.positions).cells;
    let mut hot = 0;
    let mut pressures = Vec::new();
    for id in 0..state.len() {
        let [x, y, _] = model.units.displacement(state.positions[id], [0; 3]);
        let temperature = if x.hypot(y) < 10.0 { 3.0 } else { 1.0 };
        hot += usize::from(temperature > 1.0);
        let mass = f64::from(state.masses[id]) * cells.mass_unit;
        let squares: f64 = model.units.momentum(state.momenta[id]).iter().map(|part| part * part).sum();
        let internal = f64::from(state.energies[id]) * cells.energy_unit - squares / (2.0 * mass);
        assert!((internal - mass / 0.05 * temperature).abs() <= 0.5001 * cells.energy_unit, "{id}: {internal}");
        pressures.push(internal / tessellation[id].volume);
    }
    // A disc of π 10² of the box of 3200 holds so many places, its other quarters at the other corners; to four deviations.
    assert!((hot as f64 - 314.2).abs() < 4.0 * 314.2_f64.sqrt(), "{hot}");
    let mean = pressures.iter().sum::<f64>() / pressures.len() as f64;
    assert!(pressures.iter().all(|pressure| (pressure / mean - 1.0).abs() < 1e-5), "one pressure");
    assert_eq!(state.total_momentum(), [0; 3]);
}

#[test]
fn a_jittered_lattice_stays_near_its_sites() {
    let jitter = |jitter: &str| {
        let placement = format!(r#"particles.0.placement={{"type":"lattice"{jitter}}}"#);
        start(&["space.box=[20,20]", "particles.0.count=400", &placement])
    };
    let (model, plain) = jitter("");
    let (_, shifted) = jitter(r#","jitter":0.3"#);
    let (_, zero) = jitter(r#","jitter":0"#);
    assert_eq!(zero.positions, plain.positions);
    let shifts: Vec<f64> = (0..400)
        .flat_map(|id| model.units.displacement(shifted.positions[id], plain.positions[id])[..2].to_vec())
        .collect();
    let largest = shifts.iter().fold(0.0_f64, |most, shift| most.max(shift.abs()));
    assert!(largest <= 0.3 + 1e-8 && largest > 0.29, "{largest}");
    // Uniform: a variance of a third of the square of the largest, 0.03, to 4 · 0.03 √(0.8/800).
    let variance = shifts.iter().map(|shift| shift * shift).sum::<f64>() / 800.0;
    assert!((variance - 0.03).abs() < 0.0038, "{variance}");
    // What the defaults leave out is left out of the resolved scene too, so that older scenes keep their bytes.
    let written = serde_json::to_string(&CELLS.accepted(&[r#"particles.0.placement={"type":"lattice"}"#])).unwrap();
    assert!(!written.contains("jitter"), "{written}");
}
