//! How often particles go round the box: counted on the device, exactly, for scenes that write a trajectory and no others.

use std::fs;
use std::path::Path;

use mesoscope::output::files;
use mesoscope::plan::{Hardware, Options, Storage, Traversal};
use mesoscope::run;
use mesoscope::run::Run;
use mesoscope::scene::{Checked, Scene};
use mesoscope::shaders::{Array, Constant};
use mesoscope::state::State;

use crate::support::{adapter, cells, edited, engine, fluid, gpu, start, water};

const TRAJECTORY: &str = r#"output.trajectory={"every":1000}"#;

/// Positions on the unwrapped axes, in 2⁻³² of the box.
fn unwrapped(positions: &[[u32; 3]], images: &[[i32; 3]]) -> Vec<[i64; 3]> {
    assert_eq!(images.len(), positions.len());
    let particles = positions.iter().zip(images);
    particles
        .map(|(position, image)| std::array::from_fn(|axis| (i64::from(image[axis]) << 32) + i64::from(position[axis])))
        .collect()
}

/// Scenes of every layout, with particles that go round a small box, and ways to store and visit them.
fn scenes() -> Vec<(&'static str, Checked, Vec<Options>)> {
    let small = ["space.box=[3,2.5,2.2]", "temperature=2", TRAJECTORY];
    let flat = ["space.box=[4,3]", "temperature=2", TRAJECTORY];
    let tracers = r#"particles=[
        {"species":"water","count":2048,"placement":{"type":"random"},"velocities":{"type":"geostrophic"}},
        {"species":"dye","count":70,"tracer":true,"placement":{"type":"random"},"velocities":{"type":"geostrophic"}}]"#;
    let jet = [
        r#"interactions.0.surface=[{"type":"wave","periods":[1,2],"amplitude":0.3}]"#,
        "interactions.0.smoothing.length=0.4",
        tracers,
        TRAJECTORY,
    ];
    let plain = || vec![Options::default()];
    let serial = |serial| Options { serial_memory: Some(serial), ..Options::default() };
    let stored =
        |storage, serial| Options { storage: Some(storage), serial_memory: Some(serial), ..Options::default() };
    let chain = [
        "space.box=[12]",
        r#"particles=[{"species":"A","count":12,"chain":{"beads":4}},{"species":"B","count":40}]"#,
        r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":9}},{"type":"langevin","friction":0.1}]"#,
        "temperature=40",
        r#"integrator={"type":"cotter-reich"}"#,
        TRAJECTORY,
    ];
    let listed = r#"interactions.0.bath={"type":"memory","rate":3}"#;
    vec![
        (
            "split",
            fluid(&small),
            vec![serial(true), Options { traversal: Some(Traversal::Rows), workgroup_size: Some(32), ..serial(false) }],
        ),
        ("plane", fluid(&[&flat[..], &[r#"integrator={"type":"groot-warren","lambda":0.65}"#]].concat()), plain()),
        (
            "listed",
            fluid(&[&small[..], &[listed, r#"integrator={"type":"cotter-reich"}"#]].concat()),
            vec![serial(true), serial(false)],
        ),
        ("line", fluid(&chain), plain()),
        ("cells", cells(64, &["time.step=0.05", "temperature=6", TRAJECTORY]), plain()),
        ("water", water(&jet), vec![stored(Storage::Sorted, false), stored(Storage::Bins, true)]),
    ]
}

#[test]
fn images_count_every_crossing_in_every_layout() {
    const STEPS: u64 = 80;
    for (name, scene, mut options) in scenes() {
        options.retain(|options| options.serial_memory != Some(true) || gpu().serial_memory());
        let (_, first) = start(&scene);
        let mut step_by_step = engine(&scene, &first, options[0]);
        // Followed by hand, from one step to the next.
        let mut way = unwrapped(&first.positions, &first.images);
        let mut before = first.clone();
        let mut middle = None;
        for step in 1..=STEPS {
            step_by_step.advance(1, 1).unwrap();
            let state = step_by_step.state().unwrap();
            for (way, (now, before)) in way.iter_mut().zip(state.positions.iter().zip(&before.positions)) {
                for axis in 0..3 {
                    way[axis] += i64::from(now[axis].wrapping_sub(before[axis]).cast_signed());
                }
            }
            assert!(unwrapped(&state.positions, &state.images) == way, "{name} at step {step}");
            if step == STEPS / 2 + 1 {
                middle = Some(state.clone());
            }
            before = state;
        }
        let images = || before.images.iter().zip(&first.images);
        let crossed =
            |sign: i32| images().filter(move |(last, first)| (0..3).any(|axis| sign * (last[axis] - first[axis]) > 0));
        assert!(crossed(1).count() > 3 && crossed(-1).count() > 3, "{name}: nothing goes round the box");
        for options in options {
            // In other batches and storage, and from a state in between.
            let mut other = engine(&scene, &first, options);
            other.advance(STEPS, 50).unwrap();
            assert!(other.state().unwrap() == before, "{name} {options:?}");
            let middle = middle.as_ref().unwrap();
            other.upload(middle).unwrap();
            other.advance(STEPS - middle.step, 7).unwrap();
            assert!(other.state().unwrap() == before, "{name} {options:?}, resumed");
            // What a report shows is less than a step further.
            let reported = other.reported().unwrap();
            let reported = unwrapped(&reported.positions, &reported.images);
            let furthest = reported
                .iter()
                .zip(&way)
                .flat_map(|(reported, way)| [0, 1, 2].map(|axis| (reported[axis] - way[axis]).abs()));
            assert!(furthest.max().unwrap() < 1 << 31, "{name} {options:?}, reported");
        }
        // A state in the middle that does not say cannot be followed.
        let silent = State { images: Vec::new(), ..middle.unwrap() };
        let refused = step_by_step.upload(&silent).unwrap_err();
        assert!(refused.to_string().contains("times round the box"), "{refused}");
    }
}

/// Particles that nothing disturbs go as far in every step, to the unit, however many times round the box that is.
#[test]
fn free_particles_go_straight_on() {
    const STEPS: u64 = 1000;
    let velocities = "[[0.5,-0.31,7],[0,9.7,-9.9],[-9.99,1,0.001]]";
    let particles = format!(
        r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":[[0,0,0],[1,2,3],[4.99,4.99,4.99]]}},
            "velocities":{{"type":"listed","velocities":{velocities}}}}}]"#
    );
    let scene = fluid(&["interactions=[]", "time.step=0.2", "temperature=100", &particles, TRAJECTORY]);
    let (_, first) = start(&scene);
    let mut engine = engine(&scene, &first, Options::default());
    engine.advance(1, 1).unwrap();
    let of = |state: &State| unwrapped(&state.positions, &state.images);
    let second = of(&engine.state().unwrap());
    engine.advance(STEPS - 1, 100).unwrap();
    let last = of(&engine.state().unwrap());
    for (id, ((first, second), last)) in
        unwrapped(&first.positions, &first.images).iter().zip(&second).zip(&last).enumerate()
    {
        for axis in 0..3 {
            assert_eq!(last[axis] - first[axis], STEPS as i64 * (second[axis] - first[axis]), "{id} {axis}");
        }
    }
    assert!(last.iter().any(|way| way[0] >> 32 <= -399), "{last:?}");
}

#[test]
fn only_what_asks_for_images_pays_for_them() {
    for (name, scene, options) in scenes() {
        let without = edited(&scene, |scene| scene.output.trajectory = None);
        for options in options {
            let plan = |scene: &Checked| run::plan(scene, Hardware::default(), options);
            let [with, without] = [plan(&scene), plan(&without)];
            // A report of split steps keeps the momenta of a frame.
            let split = with.has_buffer(Array::ReportedMomenta);
            let same = |index: &usize| with.kernels[*index] == without.kernels[*index];
            let others: Vec<usize> = (0..without.kernels.len()).filter(|index| !same(index)).collect();
            assert!(others.is_empty(), "{name}");
            let constants = with.constants.iter().filter(|own| !without.constants.contains(own));
            let constants: Vec<Constant> = constants.map(|(constant, _)| *constant).collect();
            assert_eq!(constants, if split { vec![Constant::KeepsMomenta] } else { vec![] }, "{name}");
            let extra = with.kernels.len() - without.kernels.len();
            assert!((1..=2).contains(&extra) && !without.paths.are_followed(), "{name}: {extra}");
            assert_eq!(with.bytes() - without.bytes(), if split { 48 } else { 32 } * with.particles, "{name}");
            // Kernels of a scene without one are those of the scene with one.
            assert_eq!(with.advance, without.advance, "{name}");
        }
    }
    // The larger the box, the more seldom.
    let every = |edge: u32| {
        let edge = format!("space.box=[{edge},{edge},{edge}]");
        let scene = fluid(&[edge.as_str(), TRAJECTORY]);
        run::plan(&scene, Hardware::default(), Options::default()).paths.every
    };
    assert_eq!([2, 4, 5, 20].map(every), [1, 1, 2, 9]);
}

/// Bonded particles are whole at the start, though their chains reach over the ends of the box.
#[test]
fn molecules_are_whole() {
    let scene = fluid(&[
        r#"particles=[{"species":"A","count":400,"chain":{"beads":8,"spacing":0.7,"closed":false}},
            {"species":"B","count":160,"chain":{"beads":8,"spacing":0.7,"closed":true}}]"#,
        r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":9}},{"type":"langevin","friction":1}]"#,
        r#"integrator={"type":"cotter-reich"}"#,
        TRAJECTORY,
    ]);
    let (model, state) = start(&scene);
    assert!(state.images.iter().any(|image| *image != [0; 3]), "no chain reaches over an end");
    let way = unwrapped(&state.positions, &state.images);
    for bond in model.particles().bonds.as_ref().unwrap().iter() {
        let [one, other] = bond.ends.map(|end| way[end as usize]);
        let length = |axis: usize| (one[axis] - other[axis]) as f64 / 2_f64.powi(32) * model.units.lengths[axis];
        let squared: f64 = (0..3).map(|axis| length(axis).powi(2)).sum();
        assert!(squared.sqrt() < 0.75, "{:?}: {}", bond.ends, squared.sqrt());
    }
}

fn run(scene: Checked, directory: &Path) {
    Run::replace(scene, directory).execute(&adapter(), &mut |_| {}).unwrap();
}

#[test]
fn a_resumed_trajectory_has_the_bytes_of_a_whole_one() {
    // Cells exchange mass, and the fluid goes round its box between two frames.
    let scenes = [
        fluid(&["space.box=[3,2.5,2.2]", "temperature=2"]),
        cells(64, &["time.step=0.02", r#"interactions.0.form="consistent""#]),
    ];
    for (scene, format) in scenes.iter().flat_map(|scene| ["gsd", "extended-xyz"].map(|format| (scene, format))) {
        let scene = edited(scene, |Scene { time, output, .. }| {
            output.trajectory = serde_json::from_value(serde_json::json!({"every": 25, "format": format})).unwrap();
            time.steps = 200;
            (output.plot.width, output.plot.height) = (320, Some(240));
            (output.snapshot.width, output.snapshot.height) = (Some(64), Some(64));
        });
        let name = if format == "gsd" { files::TRAJECTORY_GSD } else { files::TRAJECTORY_XYZ };
        let root = tempfile::tempdir().unwrap();
        let [whole, parts] = ["whole", "parts"].map(|name| root.path().join(name));
        run(scene.clone(), &whole);
        let bytes = |directory: &Path| fs::read(directory.join(name)).unwrap();
        run(edited(&scene, |scene| scene.time.steps = 85), &parts);
        let checkpoint = fs::read(parts.join(files::CHECKPOINT)).unwrap();
        let resume = |steps| Run::resume(&parts, Some(steps)).unwrap().execute(&adapter(), &mut |_| {}).unwrap();
        resume(200);
        assert!(bytes(&whole) == bytes(&parts), "{format}");
        // Killed after frames that the last checkpoint knows nothing of.
        fs::write(parts.join(files::CHECKPOINT), &checkpoint).unwrap();
        resume(200);
        assert!(bytes(&whole) == bytes(&parts), "{format}, frames dropped");
        // Stopped at a frame.
        fs::write(parts.join(files::CHECKPOINT), &checkpoint).unwrap();
        resume(100);
        resume(200);
        assert!(bytes(&whole) == bytes(&parts), "{format}, in three parts");
    }
}
