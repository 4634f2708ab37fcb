//! What features cost: that those which a scene turns off cost nothing, and what they cost where they are on.
//!
//! `cargo bench --bench required` prints a table in Markdown. A scene that never mentions a feature, the same scene with a value that says
//! "off", and with the feature on are measured in turns within one run, and ratios are taken round by round. The same scene once more shows how
//! far two measurements of the same thing lie apart. Beside the time that passes there is the time that processors spend on this program,
//! which says the same on a software adapter, also where other programs are at work, and nothing on a GPU. The adapter is the best, or the one that `MESOSCOPE_ADAPTER` names.

#[path = "../common/mod.rs"]
mod common;

use std::time::Instant;

use clap::Parser;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::scene::{self, Checked};

use common::statistics::{grouped, ratios, spread};
use common::timed::Run;
use common::timing::{Timing, Turns};
use common::{Failure, Report};

/// Cost of features that are off, and on.
#[derive(Debug, Parser)]
struct Settings {
    #[command(flatten)]
    timing: Timing,
}

/// The standard fluid and couplings of the same particles, water, and cells, without what is optional.
const FLUID: &str = r#"{"title": "fluid", "space": {"box": [10, 10, 10]}, "time": {"step": 0.02, "steps": 100000}, "temperature": 1,
    "integrator": {"type": "groot-warren"}, "particles": [{"species": "A", "number_density": 3}],
    "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}], "output": {"energies": {"every": 20}}}"#;
const COUPLED: &str = r#"{"title": "couplings", "space": {"box": [10, 10, 10]}, "time": {"step": 0.01, "steps": 100000},
    "temperature": 1, "integrator": {"type": "cotter-reich"},
    "particles": [{"species": "A", "count": 3000, "chain": {"beads": 3, "spacing": 0.8}}],
    "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}, {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}}],
    "output": {"energies": {"every": 20}}}"#;
const WATER: &str = r#"{"title": "water", "space": {"box": [6.283185307179586, 6.283185307179586]}, "time": {"step": 0.02, "steps": 100000},
    "temperature": 0.0004, "integrator": {"type": "gyro"},
    "particles": [{"species": "water", "count": 16384, "placement": {"type": "lattice"}, "velocities": {"type": "rest"}}],
    "interactions": [{"type": "shallow-water", "mesh": [64, 64], "wave_speed": 6.283185307179586, "rotation": 6.283185307179586,
        "smoothing": {"length": 0.39}}], "output": {"energies": {"every": 20}}}"#;
const CELLS: &str = r#"{"title": "cells", "space": {"box": [50, 50]}, "time": {"step": 0.002, "steps": 100000}, "temperature": 1,
    "particles": [{"species": "A", "count": 2500, "mass": 5, "placement": {"type": "lattice", "jitter": 0.3}}],
    "interactions": [{"type": "voronoi", "molecular_mass": 0.02}], "output": {"energies": {"every": 20}}}"#;

const TRACERS: &str = r#"particles=[{"species":"water","count":16384,"placement":{"type":"lattice"},"velocities":{"type":"rest"}},
    {"species":"loop","count":COUNT,"tracer":true,"velocities":{"type":"rest"},"placement":{"type":"circle","center":[3,3],"radius":1}}]"#;

/// A feature of a scene.
struct Feature {
    name: &'static str,
    scene: &'static str,
    /// What the scene never mentions, is off, and is on with.
    never: &'static str,
    off: String,
    on: String,
}

fn features() -> Vec<Feature> {
    let feature = |name, scene, never, off: &str, on: &str| {
        let (off, on) = (off.to_owned(), on.to_owned());
        Feature { name, scene, never, off, on }
    };
    let tracers = |count: &str| TRACERS.replace("COUNT", count);
    let push = |force: &str| {
        format!(
            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},
                {{"type":"body-force","profile":"opposed","axis":"y","force":[{force},0,0]}}]"#
        )
    };
    let angles = |stiffness: &str| {
        format!(
            r#"interactions=[{{"type":"dpd","repulsion":25,"friction":4.5}},
                {{"type":"bonds","potential":{{"type":"harmonic","stiffness":4}}}},{{"type":"angles","stiffness":{stiffness}}}]"#
        )
    };
    vec![
        feature("the same scene again", FLUID, "", "", ""),
        feature(
            "repulsion",
            FLUID,
            r#"interactions=[{"type":"dpd","friction":4.5}]"#,
            "interactions.0.repulsion=0",
            "interactions.0.repulsion=25",
        ),
        feature(
            "friction and noise of pairs",
            FLUID,
            r#"interactions=[{"type":"dpd","repulsion":25}]"#,
            "interactions.0.friction=0",
            "interactions.0.friction=4.5",
        ),
        feature(
            "coefficients of pairs of species",
            FLUID,
            "",
            "interactions.0.pairs=[]",
            r#"interactions.0.pairs=[{"between":["A","A"],"repulsion":26}]"#,
        ),
        feature(
            "density-dependent repulsion",
            FLUID,
            "",
            "interactions.0.many_body=null",
            r#"interactions.0.many_body={"repulsion":5,"cutoff":0.75}"#,
        ),
        feature(
            "two stages of friction",
            FLUID,
            r#"integrator={"type":"splitting"}"#,
            r#"integrator={"type":"splitting","relaxation":"mean-field"}"#,
            r#"integrator={"type":"splitting","relaxation":"two-stages"}"#,
        ),
        feature("two walls", FLUID, "", "space.walls={}", r#"space.walls={"z":{"reflection":"bounce-back"}}"#),
        feature("shear", FLUID, "", "space.shear=null", r#"space.shear={"rate":0.2,"flow":"x","gradient":"y"}"#),
        feature("body force", FLUID, "", &push("0"), &push("0.05")),
        feature("stress, every 20", FLUID, "", "output.stress=null", r#"output.stress={"every":20}"#),
        feature(
            "profiles, every 20",
            FLUID,
            "",
            "output.profiles=null",
            r#"output.profiles={"axis":"z","bins":20,"every":20}"#,
        ),
        feature(
            "viscosity, every 5",
            FLUID,
            "",
            "output.viscosity=null",
            r#"output.viscosity={"every":5,"window":200}"#,
        ),
        feature(
            "radial distribution, every 20",
            FLUID,
            "",
            "output.radial_distribution=null",
            r#"output.radial_distribution={"every":20,"range":2}"#,
        ),
        feature(
            "diffusion, every 5",
            FLUID,
            "",
            "output.diffusion=null",
            r#"output.diffusion={"every":5,"window":200}"#,
        ),
        feature(
            "histogram, every 5",
            FLUID,
            "",
            "output.histograms=[]",
            r#"output.histograms=[{"quantity":"velocity","every":5,"range":6}]"#,
        ),
        feature("trajectory", FLUID, "", "output.trajectory=null", r#"output.trajectory={"every":50}"#),
        feature(
            "memory of pairs",
            COUPLED,
            "",
            r#"interactions.0.bath={"type":"white"}"#,
            r#"interactions.0.bath={"type":"memory","rate":10}"#,
        ),
        feature("friction of bonds", COUPLED, "", "interactions.1.friction=0", "interactions.1.friction=2"),
        feature("angles", COUPLED, "", &angles("0"), &angles("2")),
        feature(
            "bonds that spare repulsion",
            COUPLED,
            "",
            "interactions.1.exclude_repulsion=false",
            "interactions.1.exclude_repulsion=true",
        ),
        feature(
            "sizes of chains, every 5",
            COUPLED,
            "",
            "output.chain_sizes=null",
            r#"output.chain_sizes={"every":5}"#,
        ),
        feature(
            "bath on the mesh",
            WATER,
            "",
            "interactions.0.bath=null",
            r#"interactions.0.bath={"type":"memory","epsilon":1}"#,
        ),
        feature(
            "smoothing",
            WATER,
            r#"interactions=[{"type":"shallow-water","mesh":[64,64],"wave_speed":6.283185307179586}]"#,
            "interactions.0.smoothing.length=0",
            "interactions.0.smoothing.length=0.39",
        ),
        feature("tracers, 4096", WATER, "", &tracers("0"), &tracers("4096")),
        feature("energy of cells", CELLS, "", "interactions.0.energy=null", "interactions.0.energy={}"),
    ]
}

/// A scene with changes, of which some may be empty.
fn scene_of(feature: &Feature, change: &str) -> Result<Checked, Failure> {
    let changes = [feature.never, change].into_iter().filter(|change| !change.is_empty()).map(str::to_owned);
    Ok(scene::parse(feature.name, feature.scene, &changes.collect::<Vec<_>>())?)
}

/// Chains are placed at random: some particles have more neighbours at first than lists have room for in a fluid.
fn options_of(scene: &Checked) -> Options {
    Options { list_growth: u32::from(scene.model().particles().bonds.is_some()), ..Options::default() }
}

fn plan_of(scene: &Checked, hardware: Hardware) -> Plan {
    common::plan_of(scene, hardware, options_of(scene))
}

fn main() -> Result<(), Failure> {
    let turns = common::settings::<Settings>().timing.or(11, 0.4);
    let plan = |feature: Feature| Ok(plan_of(&scene_of(&feature, &feature.on)?, Hardware::default()));
    let gpu = common::open_for(features().into_iter().map(plan))?;
    let peer = "compared with the scene that never mentions the feature";
    let report = Report::begin("What a scene requires: time and memory of features, off and on", &gpu, peer);
    println!(
        "\n| feature | particles | off: time | processors | on: time | processors | bytes a particle, never mentioned | off | on |"
    );
    println!("|:--|--:|--:|--:|--:|--:|--:|--:|--:|");
    for feature in features() {
        compare(&gpu, &feature, turns)?;
    }
    report.end();
    Ok(())
}

/// Times of steps, reports included, as parts of those of the scene that never mentions the feature.
fn compare(gpu: &Gpu, feature: &Feature, turns: Turns) -> Result<(), Failure> {
    let scenes = ["", &feature.off, &feature.on].map(|change| scene_of(feature, change));
    let [never, off, on] = scenes;
    let scenes = [never?, off?, on?];
    let mut runs = Vec::new();
    for scene in &scenes {
        runs.push(Run::of_scene(gpu, scene, options_of(scene), 200)?);
    }
    let mut rates: [Vec<f64>; 3] = [const { Vec::new() }; 3];
    let mut processors: [Vec<f64>; 3] = [const { Vec::new() }; 3];
    for round in 0..turns.rounds {
        // There and back, so that what drifts does not add up.
        let order = if round % 2 == 0 { [0, 1, 2] } else { [2, 1, 0] };
        for place in order {
            let (begun, before) = (Instant::now(), processor_seconds());
            let rate = runs[place].rate(turns.seconds)?;
            let steps = rate * begun.elapsed().as_secs_f64();
            rates[place].push(rate);
            processors[place].extend(before.zip(processor_seconds()).map(|(before, after)| (after - before) / steps));
        }
    }
    let [never, off, on] = &rates;
    let [never_spent, off_spent, on_spent] = &processors;
    let bytes = scenes.each_ref().map(|scene| {
        let particles = scene.model().particle_count();
        format!("{:.0}", plan_of(scene, gpu.into()).bytes() as f64 / particles as f64)
    });
    let [never_bytes, off_bytes, on_bytes] = bytes;
    println!(
        "| {} | {} | {} | {} | {} | {} | {never_bytes} | {off_bytes} | {on_bytes} |",
        feature.name,
        grouped(scenes[0].model().particle_count() as usize),
        spread(&ratios(never, off), 2),
        spread(&ratios(off_spent, never_spent), 2),
        spread(&ratios(never, on), 2),
        spread(&ratios(on_spent, never_spent), 2),
    );
    Ok(())
}

/// Seconds that all processors together have spent on this program, where the system tells; it counts in hundredths.
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, in parentheses, may hold spaces; user and system are the 14th and 15th of all fields.
    let after_name = text.rsplit_once(')')?.1;
    let ticks = after_name.split_whitespace().skip(11).take(2).map(|field| field.parse::<f64>().ok());
    Some(ticks.sum::<Option<f64>>()? / 100.0)
}
