//! What a particle-step of shallow water costs: compared with a plain compiled loop, by stage, and against the time that memory
//! alone would take.
//!
//! `cargo bench --bench hpm` prints tables in Markdown and takes some minutes; `-- --quick` is a look that proves nothing,
//! `-- --alternatives` adds other storages, splines, solvers and a crowd, `-- --sizes 64,256:1048576` names meshes and
//! particles. All that is compared is measured in turns within one run, and ratios are taken round by round, so that a
//! machine that slows down for a while slows both sides. The adapter is the best, or the one that `MESOSCOPE_ADAPTER`
//! names.
//!
//! The loop is compiled for the processors that cargo builds for; `RUSTFLAGS='-C target-cpu=native'` before the command
//! lets it use all of this one. Its transforms are those of rustfft without vector instructions. The kernels of mesoscope are compiled by the driver and do not change.

mod alternatives;
mod bandwidth;
#[path = "../common/mod.rs"]
mod common;
mod compiled_loop;
mod flow;

use std::time::Instant;

use clap::Parser;
use mesoscope::gpu::{AdapterKind, Gpu, GpuError, Requirements};
use mesoscope::plan::{Hardware, Options, Plan};

use common::statistics::{grouped, median, ratios, spread};
use common::timing::{Timing, Turns};
use common::{Failure, Report};
use compiled_loop::CompiledLoop;
use flow::{Flow, Size, Start};

/// Steps after which the energies of mesoscope and the loop are compared, and by how much they may differ.
const CHECKED_STEPS: u64 = 20;
const CHECKED_TOLERANCE: f64 = 1e-4;
/// Bytes of a particle, which a step reads and writes once.
const PARTICLE_BYTES: f64 = 24.0;
/// Bytes that a step moves for each node: its mass and its depth, written and read.
const NODE_BYTES: f64 = 16.0;

/// Cost of shallow water.
#[derive(Debug, Parser)]
struct Settings {
    /// Meshes, each MESH or MESH:PARTICLES with the square of a whole number; 16 particles a cell if left out [default:
    /// 64, 256 and 1024, the last with 4 particles a cell on software adapters and 16 on others with the memory, and not if it is to be quick]
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<Size>,
    /// Compare other storages, splines, solvers and a crowd too
    #[arg(long)]
    alternatives: bool,
    #[command(flatten)]
    timing: Timing,
}

fn main() -> Result<(), Failure> {
    let settings: Settings = common::settings();
    let turns = settings.timing.or(7, 0.5);
    let (gpu, sizes) = open(&settings)?;
    let peer = format!("compiled loop: {}", CompiledLoop::describe());
    let report = Report::begin("Shallow water: cost of a particle-step", &gpu, &peer);
    let flows = sizes.into_iter().map(Flow::new).collect::<Result<Vec<_>, _>>()?;
    let costs = beside_the_loop(&gpu, &flows, turns)?;
    by_stage(&gpu, &flows, turns)?;
    against_the_floor(&gpu, &costs)?;
    if settings.alternatives {
        alternatives::compare(&gpu, &flows, turns.at_most(5).half())?;
    }
    report.end();
    Ok(())
}

/// The adapter with a buffer of this size.
fn with_buffer(largest_buffer: u64) -> Result<Gpu, GpuError> {
    common::open(Requirements { largest_buffer, ..Requirements::default() })
}

/// The adapter with buffers for the largest size, and the sizes.
fn open(settings: &Settings) -> Result<(Gpu, Vec<Size>), Failure> {
    let with_room = |sizes: &[Size]| {
        let (mut needed, mut wished) = (0, 0);
        for &size in sizes {
            needed = needed.max(flow::plan_of(size, &[], Hardware::default(), Options::default())?.largest_buffer());
            wished = wished.max(alternatives::largest_buffer(size)?);
        }
        let wished = if settings.alternatives { wished } else { needed };
        // Alternatives that do not fit are left out.
        match with_buffer(wished.max(needed)) {
            Err(GpuError::TooSmall { .. }) if wished > needed => Ok::<_, Failure>(with_buffer(needed)),
            opened => Ok(opened),
        }
    };
    if !settings.sizes.is_empty() {
        return Ok((with_room(&settings.sizes)??, settings.sizes.clone()));
    }
    let mut sizes = vec![Size::filled(64, 16), Size::filled(256, 16)];
    if !settings.timing.quick {
        let software = with_buffer(0)?.description().kind == AdapterKind::Software;
        sizes.push(Size::filled(1024, if software { 4 } else { 16 }));
    }
    match with_room(&sizes)? {
        Err(GpuError::TooSmall { .. }) if !settings.timing.quick => {
            sizes[2] = Size::filled(1024, 4);
            Ok((with_room(&sizes)??, sizes))
        }
        opened => Ok((opened?, sizes)),
    }
}

/// What a step of a size costs.
struct Cost {
    size: Size,
    /// Nanoseconds a particle-step, round by round.
    nanoseconds: Vec<f64>,
}

fn beside_the_loop(gpu: &Gpu, flows: &[Flow], turns: Turns) -> Result<Vec<Cost>, Failure> {
    println!(
        "\n### Speed\n\nMedian (least–most) of rounds in which mesoscope and a plain compiled float64 loop on one thread take \
         turns; × is the ratio in a round.\n"
    );
    println!(
        "| mesh | particles | mesoscope, M particle-steps/s | ms a step | loop, M particle-steps/s | ms a step | × loop |"
    );
    println!("|--:|--:|--:|--:|--:|--:|--:|");
    let mut costs = Vec::new();
    let mut checks = Vec::new();
    for flow in flows {
        let particles = flow.size.particles;
        let mut peer = CompiledLoop::new(&flow.model, &flow.water, &flow.state);
        checks.push(check(gpu, flow, &mut peer)?);
        let begun = Instant::now();
        peer.run(2);
        let steps = ((turns.seconds / (0.5 * begun.elapsed().as_secs_f64())) as u64).max(2);
        let mut run = flow.run(gpu, &[], Options::default(), Start::Even)?;
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for _ in 0..turns.rounds {
            ours.push(run.rate(turns.seconds)?);
            let begun = Instant::now();
            peer.run(steps);
            theirs.push((steps * particles as u64) as f64 / begun.elapsed().as_secs_f64());
        }
        let millions = |rates: &[f64]| spread(&rates.iter().map(|rate| 1e-6 * rate).collect::<Vec<_>>(), 1);
        let times = |rates: &[f64]| spread(&rates.iter().map(|&rate| flow.milliseconds(rate)).collect::<Vec<_>>(), 3);
        println!(
            "| {}² | {} | {} | {} | {} | {} | {} |",
            flow.size.mesh,
            grouped(particles),
            millions(&ours),
            times(&ours),
            millions(&theirs),
            times(&theirs),
            spread(&ratios(&ours, &theirs), 2)
        );
        costs.push(Cost { size: flow.size, nanoseconds: ours.iter().map(|rate| 1e9 / rate).collect() });
    }
    println!("\nBoth compute the same: energy after {CHECKED_STEPS} steps.\n");
    println!("| mesh | mesoscope | loop | relative difference | drift of mesoscope | drift of the loop |");
    println!("|--:|--:|--:|--:|--:|--:|");
    for row in checks {
        println!("{row}");
    }
    Ok(costs)
}

/// A row on the energies of mesoscope and the loop from the same state.
fn check(gpu: &Gpu, flow: &Flow, peer: &mut CompiledLoop) -> Result<String, Failure> {
    let ours = flow.observed(gpu, CHECKED_STEPS)?.map(|observables| observables.total_energy());
    let first = peer.energy();
    peer.run(CHECKED_STEPS);
    let theirs = [first, peer.energy()];
    let difference = ours[1] / theirs[1] - 1.0;
    if difference.is_nan() || difference.abs() > CHECKED_TOLERANCE {
        return Err(format!(
            "mesoscope and the loop do not compute the same on {0}²: energies {1} and {2} at first, {3} and {4} after \
             {CHECKED_STEPS} steps",
            flow.size.mesh, ours[0], theirs[0], ours[1], theirs[1]
        )
        .into());
    }
    Ok(format!(
        "| {}² | {:.4} | {:.4} | {difference:.1e} | {:.1e} | {:.1e} |",
        flow.size.mesh,
        ours[1],
        theirs[1],
        ours[1] / ours[0] - 1.0,
        theirs[1] / theirs[0] - 1.0
    ))
}

/// The parts of a step.
const PARTS: [&str; 3] = ["spread", "smooth", "gather and push"];

/// The part to which each kernel of a step belongs, in order.
fn parts_of(plan: &Plan) -> Vec<usize> {
    // The last kernel that spreads sums up what cells add to nodes.
    let spreading = plan.before_report.iter().position(|&kernel| plan.kernels[kernel].name == "gather_nodes");
    let spreading = plan.sort.len() + spreading.map_or(0, |place| place + 1);
    let before_report = plan.sort.len() + plan.before_report.len();
    let part = |place: usize| usize::from(place >= spreading) + usize::from(place >= before_report);
    (0..before_report + plan.advance.len()).map(part).collect()
}

fn by_stage(gpu: &Gpu, flows: &[Flow], turns: Turns) -> Result<(), Failure> {
    println!("\n### Where the time of a step goes");
    for flow in flows {
        let mut run = flow.run(gpu, &[], Options::default(), Start::Even)?;
        let particles = flow.size.particles;
        let (how, stages, step) = run.stages(turns.seconds)?;
        let parts = parts_of(run.engine.plan());
        let sum: f64 = stages.iter().map(|stage| stage.seconds).sum();
        println!("\nMesh {}², {} particles; {how}.\n", flow.size.mesh, grouped(particles));
        println!("| part | µs a step | ns a particle | share |");
        println!("|:--|--:|--:|--:|");
        let row = |name: &str, seconds: f64| {
            let nanoseconds = 1e9 * seconds / particles as f64;
            println!("| {name} | {:.0} | {nanoseconds:.2} | {:.1} % |", 1e6 * seconds, 100.0 * seconds / sum);
        };
        for (part, name) in PARTS.into_iter().enumerate() {
            // Passes of one name together.
            let mut kernels: Vec<(&str, f64, usize)> = Vec::new();
            for (stage, _) in stages.iter().zip(&parts).filter(|(_, own)| **own == part) {
                match kernels.iter_mut().find(|kernel| kernel.0 == stage.name) {
                    Some((_, seconds, passes)) => (*seconds, *passes) = (*seconds + stage.seconds, *passes + 1),
                    None => kernels.push((stage.name, stage.seconds, 1)),
                }
            }
            row(&format!("**{name}**"), kernels.iter().map(|kernel| kernel.1).sum());
            for (name, seconds, passes) in kernels {
                let passes = if passes > 1 { format!(", {passes} passes") } else { String::new() };
                row(&format!("· {name}{passes}"), seconds);
            }
        }
        row("sum", sum);
        row("step of a batch", step);
    }
    Ok(())
}

/// How much of a step memory alone would take.
fn against_the_floor(gpu: &Gpu, costs: &[Cost]) -> Result<(), Failure> {
    let copies = bandwidth::copies(gpu, 5)?;
    let gigabytes: Vec<f64> = copies.iter().map(|speed| 1e-9 * speed).collect();
    println!(
        "\n### Share of the bandwidth floor\n\nA step has to read and write every particle once, {PARTICLE_BYTES} bytes each, \
         and to write and read mass and depth of every node. A copy from buffer to buffer reads and writes {} GB/s here.\n",
        spread(&gigabytes, 1)
    );
    println!("| mesh | particles | bytes a particle-step | floor, ns | mesoscope, ns | share |");
    println!("|--:|--:|--:|--:|--:|--:|");
    for Cost { size, nanoseconds } in costs {
        let bytes = 2.0 * PARTICLE_BYTES + NODE_BYTES * size.nodes() as f64 / size.particles as f64;
        let floor = 1e9 * bytes / median(&copies);
        println!(
            "| {}² | {} | {bytes:.0} | {floor:.2} | {} | {:.0} % |",
            size.mesh,
            grouped(size.particles),
            spread(nanoseconds, 2),
            100.0 * floor / median(nanoseconds)
        );
    }
    Ok(())
}
