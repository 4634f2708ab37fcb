//! What couplings and their baths cost: memory on pairs compared with the same fluid without, the list compared with the search in cells,
//! its margins, and many small systems at once.
//!
//! `cargo bench --bench couplings` prints tables in Markdown. A variant and what it is compared with are measured in turns
//! within one run, and ratios are taken round by round. The adapter is the best, or the one that `MESOSCOPE_ADAPTER` names.

#[path = "../common/mod.rs"]
mod common;

use clap::Parser;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options};
use mesoscope::scene::{self, Checked};

use common::statistics::{grouped, ratios, spread};
use common::timed::Run;
use common::timing::{Timing, Turns};
use common::{Failure, Report, plan_of};

/// Cost of couplings and baths.
#[derive(Debug, Parser)]
struct Settings {
    /// Edges of the boxes of the fluid
    #[arg(long, value_delimiter = ',', default_values_t = [10.0, 20.0])]
    edges: Vec<f64>,
    #[command(flatten)]
    timing: Timing,
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
    let settings: Settings = common::settings();
    let turns = settings.timing.or(5, 0.5);
    let all = settings.edges.iter().flat_map(|edge| fluids().into_iter().map(|variant| (*edge, variant)));
    let plan =
        |(edge, variant): (f64, Variant)| Ok(plan_of(&fluid(edge, &variant)?, Hardware::default(), variant.options));
    let gpu = common::open_for(all.map(plan))?;
    let peer = "compared with pairs without memory, searched in cells";
    let report = Report::begin("Couplings and baths: cost of a particle-step", &gpu, peer);
    for &edge in &settings.edges {
        pairs(&gpu, edge, turns)?;
    }
    small_systems(&gpu, turns)?;
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
    ];
    for (name, skin) in [
        ("memory, margin .3", 0.3),
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

fn fluid(edge: f64, variant: &Variant) -> Result<Checked, Failure> {
    let text = format!(
        r#"{{"title": "fluid", "space": {{"box": [{edge}, {edge}, {edge}]}}, "time": {{"step": 0.01, "steps": 1}},
        "temperature": 1, "integrator": {{"type": "cotter-reich"}},
        "particles": [{{"species": "A", "number_density": 3, "placement": {{"type": "lattice"}}}}],
        "interactions": [{{"type": "dpd", "repulsion": 25, "friction": 4.5}}],
        "output": {{"energies": {{"every": 1000000}}}}}}"#
    );
    Ok(scene::parse(variant.name, &text, &variant.changes)?)
}

fn pairs(gpu: &Gpu, edge: f64, turns: Turns) -> Result<(), Failure> {
    let variants = fluids();
    let scene = fluid(edge, &variants[0])?;
    let particles = scene.model().particle_count() as usize;
    println!("\n### {} particles, density 3, time step 0.01\n", grouped(particles));
    println!("| | million particle-steps/s | time, no memory = 1 | bytes a particle |");
    println!("|:--|--:|--:|--:|");
    let mut plain = Run::of_scene(gpu, &scene, variants[0].options, 300)?;
    for variant in &variants {
        let scene = fluid(edge, variant)?;
        let bytes = plan_of(&scene, Hardware::default(), variant.options).bytes();
        let mut other = Run::of_scene(gpu, &scene, variant.options, 300)?;
        let rates = turns.rates(&mut [&mut other, &mut plain])?;
        println!(
            "| {} | {} | {} | {:.0} |",
            variant.name,
            millions(&rates[0]),
            spread(&ratios(&rates[1], &rates[0]), 2),
            bytes as f64 / particles as f64
        );
    }
    Ok(())
}

/// Rates in millions.
fn millions(rates: &[f64]) -> String {
    spread(&rates.iter().map(|rate| 1e-6 * rate).collect::<Vec<_>>(), 2)
}

/// Ten thousand oscillators of three coordinates, each by itself.
fn small_systems(gpu: &Gpu, turns: Turns) -> Result<(), Failure> {
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
            let mut run = Run::of_scene(gpu, &scene::parse("oscillators", &text, &[])?, Options::default(), 10)?;
            let rates = turns.half().rates(&mut [&mut run])?;
            println!("| oscillators, {name} bath | {} | {} |", grouped(count), millions(&rates[0]));
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
        let mut run = Run::of_scene(gpu, &scene::parse("dimers", &text, &[])?, Options::default(), 10)?;
        let rates = turns.half().rates(&mut [&mut run])?;
        // A system has two particles.
        let systems: Vec<f64> = rates[0].iter().map(|rate| 0.5 * rate).collect();
        println!("| dimers with memory | {} | {} |", grouped(count), millions(&systems));
    }
    Ok(())
}
