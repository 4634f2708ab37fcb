//! What Voronoi DPD costs: the tessellation by itself, compared with a Delaunay triangulation on one core, and whole steps.
//!
//! `cargo bench --bench voronoi` prints tables in Markdown. What is compared is measured in turns within one run, and ratios
//! are taken round by round. The adapter is the best, or the one that `MESOSCOPE_ADAPTER` names.

#[path = "../common/mod.rs"]
mod common;

use std::time::Instant;

use clap::Parser;
use mesoscope::engine::Engine;
use mesoscope::gpu::Gpu;
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::scene::{self, Checked};
use mesoscope::tessellation::Tessellation;
use spade::{DelaunayTriangulation, Point2, Triangulation};

use common::statistics::{grouped, ratios, spread};
use common::timed::Run;
use common::timing::{Timing, Turns};
use common::{Failure, Report};

/// Changes of a scene, and their name in a table.
type Variant = (&'static str, &'static [&'static str]);

/// Steps that are compared.
const STEPS: [Variant; 4] = [
    ("`gradient`, `splitting`", &[]),
    ("`gradient`, `euler`", &[r#"integrator={"type":"euler"}"#]),
    ("`consistent`, `splitting`", &[r#"interactions.0.form="consistent""#]),
    ("`gradient`, `splitting`, with energy", &["interactions.0.molecular_mass=0.02", "interactions.0.energy={}"]),
];

/// Cost of Voronoi cells.
#[derive(Debug, Parser)]
struct Settings {
    /// Numbers of cells
    #[arg(long, value_delimiter = ',', default_values_t = [5_000, 100_000, 1_000_000])]
    sizes: Vec<usize>,
    #[command(flatten)]
    timing: Timing,
}

fn main() -> Result<(), Failure> {
    let settings: Settings = common::settings();
    let turns = settings.timing.or(5, 1.0);
    let plan = |size: &usize| Ok(plan_of(&cells(*size, &[])?, Hardware::default()));
    let gpu = common::open_for(settings.sizes.iter().map(plan))?;
    let peer = "compared with the crate spade on one core: Delaunay triangulation of the same points by bulk load, without \
        periodic images; and the cells of `mesoscope::tessellation` made from it, with them";
    let report = Report::begin("Voronoi cells: cost of the tessellation", &gpu, peer);
    println!("\nMillion cells/s; random points.\n");
    println!("| cells | device | spade | device / spade | cells from spade | device / cells from spade |");
    println!("|--:|--:|--:|--:|--:|--:|");
    for &size in &settings.sizes {
        compare(&gpu, size, turns)?;
    }
    println!(
        "\nMillion cell-steps/s from a jittered lattice, dt = .002, and the tessellation by itself for comparison.\n"
    );
    println!("| cells | step | rate | tessellation / step |");
    println!("|--:|:--|--:|--:|");
    for &size in &settings.sizes {
        for variant in &STEPS {
            step(&gpu, size, variant, turns)?;
        }
    }
    report.end();
    Ok(())
}

/// Cells of mean area 1, with changes.
fn cells(count: usize, changes: &[&str]) -> Result<Checked, Failure> {
    let edge = (count as f64).sqrt();
    let text = format!(
        r#"{{"title": "cells", "space": {{"box": [{edge}, {edge}]}}, "time": {{"step": 0.002, "steps": 1}}, "temperature": 1,
        "particles": [{{"species": "A", "count": {count}, "mass": 5}}], "interactions": [{{"type": "voronoi"}}],
        "output": {{"energies": {{"every": 1000000}}}}}}"#
    );
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Ok(scene::parse("cells", &text, &changes)?)
}

fn plan_of(scene: &Checked, hardware: Hardware) -> Plan {
    common::plan_of(scene, hardware, Options::default())
}

/// The plan of a scene with nothing in a step but the tessellation.
fn tessellation(scene: &Checked, hardware: Hardware) -> Plan {
    let mut plan = plan_of(scene, hardware);
    let geometry = [
        "bin",
        "scan",
        "scan_blocks",
        "scan_tops",
        "scan_rows",
        "arrange",
        "order_cells",
        "tessellate",
        "tessellate_exactly",
    ];
    plan.advance =
        plan.report.iter().copied().filter(|&kernel| geometry.contains(&plan.kernels[kernel].name)).collect();
    for kernels in
        [&mut plan.prepare, &mut plan.sort, &mut plan.before_report, &mut plan.report, &mut plan.finish_report]
    {
        kernels.clear();
    }
    plan.samplers.clear();
    plan
}

fn compare(gpu: &Gpu, size: usize, turns: Turns) -> Result<(), Failure> {
    let scene = cells(size, &[])?;
    let model = scene.model();
    let state = mesoscope::families::initial_state(&scene);
    let lengths = [model.units.lengths[0], model.units.lengths[1]];
    let points: Vec<Point2<f64>> = state
        .positions
        .iter()
        .map(|fraction| {
            let position = model.units.position(*fraction);
            Point2::new(position[0], position[1])
        })
        .collect();
    let mut device = Run::new(Engine::new(gpu, tessellation(&scene, gpu.into()), &state)?, size)?;
    let (mut own, mut crate_alone, mut crate_cells) = (Vec::new(), Vec::new(), Vec::new());
    let rate = |seconds: f64| 1e-6 * size as f64 / seconds;
    for _ in 0..turns.rounds {
        own.push(1e-6 * device.rate(turns.seconds)?);
        let copy = points.clone();
        let begun = Instant::now();
        let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load(copy)?;
        crate_alone.push(rate(begun.elapsed().as_secs_f64()));
        assert_eq!(triangulation.num_vertices(), size, "no points coincide");
        let begun = Instant::now();
        let reference = Tessellation::of_fractions(lengths, &state.positions);
        crate_cells.push(rate(begun.elapsed().as_secs_f64()));
        assert_eq!(reference.cells.len(), size);
    }
    println!(
        "| {} | {} | {} | {} | {} | {} |",
        grouped(size),
        spread(&own, 2),
        spread(&crate_alone, 2),
        spread(&ratios(&own, &crate_alone), 2),
        spread(&crate_cells, 2),
        spread(&ratios(&own, &crate_cells), 2),
    );
    Ok(())
}

/// A whole step, compared with the tessellation of the same cells.
fn step(gpu: &Gpu, size: usize, (name, changes): &Variant, turns: Turns) -> Result<(), Failure> {
    let lattice = r#"particles.0.placement={"type":"lattice","jitter":0.3}"#;
    let scene = cells(size, &[&[lattice], *changes].concat())?;
    let state = mesoscope::families::initial_state(&scene);
    let mut whole = Run::new(Engine::new(gpu, plan_of(&scene, gpu.into()), &state)?, size)?;
    let mut alone = Run::new(Engine::new(gpu, tessellation(&cells(size, &[lattice])?, gpu.into()), &state)?, size)?;
    let rates = turns.rates(&mut [&mut whole, &mut alone])?;
    let millions: Vec<f64> = rates[0].iter().map(|rate| 1e-6 * rate).collect();
    let shares = ratios(&rates[0], &rates[1]);
    println!("| {} | {name} | {} | {} |", grouped(size), spread(&millions, 3), spread(&shares, 2));
    Ok(())
}
