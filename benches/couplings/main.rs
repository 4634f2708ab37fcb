//! What couplings and their baths cost: memory on pairs compared with the same fluid without, the list compared with the search in cells,
//! its margins, and many small systems at once.
//!
//! `cargo bench --bench couplings` prints tables in Markdown. A variant and what it is compared with are measured in turns
//! within one run, and ratios are taken round by round. The adapter is the best, or the one that `MESOSCOPE_ADAPTER` names.

#[path = "../common/mod.rs"]
mod common;

use clap::Parser;
use mesoscope::engine::Engine;
use mesoscope::families::Model;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::{self, Scene};
use mesoscope::state::State;

use common::statistics::{grouped, ratios, spread};
use common::timed::Run;
use common::{Failure, Report};

/// Cost of couplings and baths.
#[derive(Debug, Parser)]
struct Settings {
    /// Edges of the boxes of the fluid
    #[arg(long, value_delimiter = ',', default_values_t = [10.0, 20.0])]
    edges: Vec<f64>,
    /// Rounds
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Seconds of each measurement
    #[arg(long, default_value_t = 0.5)]
    seconds: f64,
    /// Passed by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

/// A scene with the options of its plan.
struct Variant {
    name: &'static str,
    changes: Vec<String>,
    options: Options,
}

fn variant(name: &'static str, changes: &[&str]) -> Variant {
    let changes = changes.iter().map(|change| (*change).to_owned()).collect();
    Variant { name, changes, options: Options::default() }
}

fn main() -> Result<(), Failure> {
    mesoscope::gpu::prepare_environment();
    let settings = Settings::parse();
    let mut largest_buffer = 0;
    for &edge in &settings.edges {
        for variant in fluids() {
            largest_buffer = largest_buffer.max(fluid(edge, &variant)?.1.largest_buffer());
        }
    }
    let gpu = common::open(largest_buffer)?;
    let peer = "compared with pairs without memory, searched in cells";
    let report = Report::begin("Couplings and baths: cost of a particle-step", &gpu, peer);
    for &edge in &settings.edges {
        pairs(&gpu, edge, &settings)?;
    }
    small_systems(&gpu, &settings)?;
    report.end();
    Ok(())
}

/// The standard fluid without memory, and with it in lists of several margins.
fn fluids() -> Vec<Variant> {
    let memory = r#"interactions.0.bath={"type":"memory","rate":10}"#;
    let mut all = vec![
        variant("no memory, `cotter-reich`, cells", &[]),
        variant("no memory, `splitting`, cells", &[r#"integrator={"type":"splitting"}"#]),
        Variant {
            options: Options { listed: true, ..Options::default() },
            ..variant("no memory, `cotter-reich`, listed", &[])
        },
        Variant {
            options: Options { listed: true, ..Options::default() },
            ..variant("the same, Gaussian noise", &[r#"noise={"distribution":"gaussian"}"#])
        },
        variant("memory, margin .3", &[memory]),
    ];
    for (name, skin) in [
        ("memory, margin .15", 0.15),
        ("memory, margin .2", 0.2),
        ("memory, margin .4", 0.4),
        ("memory, margin .6", 0.6),
    ] {
        all.push(Variant {
            changes: vec![memory.to_owned(), format!("interactions.0.skin={skin}")],
            ..variant(name, &[])
        });
    }
    all
}

fn fluid(edge: f64, variant: &Variant) -> Result<(Scene, Plan), Failure> {
    let text = format!(
        r#"{{"title": "fluid", "space": {{"box": [{edge}, {edge}, {edge}]}}, "time": {{"step": 0.01, "steps": 1}},
        "temperature": 1, "integrator": {{"type": "cotter-reich"}},
        "particles": [{{"species": "A", "number_density": 3, "placement": {{"type": "lattice"}}}}],
        "interactions": [{{"type": "dpd", "repulsion": 25, "friction": 4.5}}],
        "output": {{"energies": {{"every": 1000000}}}}}}"#
    );
    planned(&text, variant)
}

fn planned(text: &str, variant: &Variant) -> Result<(Scene, Plan), Failure> {
    let scene = scene::parse(variant.name, text, &variant.changes)?;
    let model = Model::new(&scene);
    let hardware = Hardware::default();
    let plan = run::plan(&model, 0, &scene.output, hardware, variant.options);
    Ok((scene, plan))
}

/// An engine of a scene, with the best plan for the adapter.
fn run<'a>(gpu: &'a Gpu, scene: &Scene, options: Options, warm: u64) -> Result<Run<'a>, Failure> {
    let model = Model::new(scene);
    let hardware = Hardware::from(gpu);
    let plan = run::plan(&model, 0, &scene.output, hardware, options);
    let state: State = mesoscope::families::initial_state(scene, &model);
    let mut engine = Engine::new(gpu, plan, &state)?;
    engine.advance(warm, 50)?;
    engine.finish()?;
    Run::new(engine, state.len())
}

fn pairs(gpu: &Gpu, edge: f64, settings: &Settings) -> Result<(), Failure> {
    let variants = fluids();
    let (scene, _) = fluid(edge, &variants[0])?;
    let particles = Model::new(&scene).particle_count() as usize;
    println!("\n### {} particles, density 3, time step 0.01\n", grouped(particles));
    println!("| | million particle-steps/s | time, no memory = 1 | bytes a particle |");
    println!("|:--|--:|--:|--:|");
    let mut plain = run(gpu, &scene, variants[0].options, 300)?;
    for variant in &variants {
        let (scene, plan) = fluid(edge, variant)?;
        let mut other = run(gpu, &scene, variant.options, 300)?;
        let (mut own, mut reference) = (Vec::new(), Vec::new());
        for _ in 0..settings.rounds {
            own.push(1e-6 * other.rate(settings.seconds)?);
            reference.push(1e-6 * plain.rate(settings.seconds)?);
        }
        println!(
            "| {} | {} | {} | {:.0} |",
            variant.name,
            spread(&own, 2),
            spread(&ratios(&reference, &own), 2),
            plan.bytes() as f64 / particles as f64
        );
    }
    Ok(())
}

/// Ten thousand oscillators of three coordinates, each by itself.
fn small_systems(gpu: &Gpu, settings: &Settings) -> Result<(), Failure> {
    println!("\n### Many small systems at once\n");
    println!("| | systems | million system-steps/s |");
    println!("|:--|--:|--:|");
    for count in [1_000, 10_000, 100_000] {
        for (name, bath) in [("white", r#"{"type": "white"}"#), ("memory", r#"{"type": "memory", "rate": 1}"#)] {
            let text = format!(
                r#"{{"title": "oscillators", "space": {{"box": [100, 100, 100]}}, "time": {{"step": 0.1, "steps": 1}},
                "temperature": 1, "particles": [{{"species": "A", "count": {count}}}],
                "interactions": [{{"type": "tether", "stiffness": 1}}, {{"type": "langevin", "friction": 1, "bath": {bath}}}],
                "output": {{"energies": {{"every": 1000000}}}}}}"#
            );
            let (scene, _) = planned(&text, &variant("oscillators", &[]))?;
            let mut run = run(gpu, &scene, Options::default(), 10)?;
            let rates = (0..settings.rounds)
                .map(|_| Ok(1e-6 * run.rate(0.5 * settings.seconds)?))
                .collect::<Result<Vec<f64>, Failure>>()?;
            println!("| oscillators, {name} bath | {} | {} |", grouped(count), spread(&rates, 2));
        }
    }
    for count in [1_000, 10_000] {
        let text = format!(
            r#"{{"title": "dimers", "space": {{"box": [100, 100, 100]}}, "time": {{"step": 0.05, "steps": 1}},
            "temperature": 1, "particles": [{{"species": "A", "count": {}, "chain": {{"beads": 2}}}}],
            "interactions": [{{"type": "bonds", "friction": 1, "potential": {{"type": "harmonic", "stiffness": 10, "length": 1}},
                "bath": {{"type": "memory", "rate": 1}}}}],
            "output": {{"energies": {{"every": 1000000}}}}}}"#,
            2 * count
        );
        let (scene, _) = planned(&text, &variant("dimers", &[]))?;
        let mut run = run(gpu, &scene, Options::default(), 10)?;
        let rates = (0..settings.rounds)
            .map(|_| Ok(0.5e-6 * run.rate(0.5 * settings.seconds)?))
            .collect::<Result<Vec<f64>, Failure>>()?;
        println!("| dimers with memory | {} | {} |", grouped(count), spread(&rates, 2));
    }
    Ok(())
}
